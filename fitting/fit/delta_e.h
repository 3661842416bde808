#pragma once

#include <glm/vec3.hpp>

namespace gonio {

/// CIE 1976 L*a*b* of a linear Rec. 709 colour, against the white (1, 1, 1) = D65.
glm::dvec3 lab_from_rgb(const glm::dvec3& rgb) noexcept;

/// Colour difference CIEDE2000 (CIE 142:2001; formulas and test data in Sharma, Wu and Dalal 2005)
/// with k_L = k_C = k_H = 1. 1 is about what can just be seen.
double delta_e_2000(const glm::dvec3& lab1, const glm::dvec3& lab2) noexcept;

}  // namespace gonio
