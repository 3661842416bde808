#pragma once

#include <glm/vec3.hpp>

namespace gonio {

/// Rec. 709 luminance of a linear RGB triple.
inline float luminance(const glm::vec3& rgb) noexcept { return 0.2126f * rgb.r + 0.7152f * rgb.g + 0.0722f * rgb.b; }

}  // namespace gonio
