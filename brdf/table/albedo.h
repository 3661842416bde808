#pragma once

#include <glm/vec3.hpp>

#include <gonio/brdf/table/table.h>

namespace gonio {

/// Directional albedo: the integral of f_r(wi, wo) cos(theta_o) over the hemisphere of wo, per
/// channel, for wi at polar angle `theta_i` [rad] in [0, pi/2) and azimuth 0. Above 1 the table
/// creates energy.
///
/// Midpoint rule over half vectors, 4 * resolution^2 lookups, nodes crowded around the mirror
/// direction. With the default a Lambertian comes within 0.1 % up to 85 degrees; the measured
/// materials tried, a near-mirror among them, within 0.1 % of the same rule at 512.
glm::vec3 directional_albedo(const BrdfTable& table, float theta_i, int resolution = 128) noexcept;

}  // namespace gonio
