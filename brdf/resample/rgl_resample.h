#pragma once

#include <functional>
#include <string>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/mapping/base/progress.h>

namespace gonio {

/// f_r(wi, wo) per RGB channel [1/sr] for two directions above the horizon; called from several
/// threads.
using Reflectance = std::function<glm::vec3(const glm::vec3& wi, const glm::vec3& wo)>;

/// Limits of resample_as_rgl().
struct RglSize {
  int side = 64;              ///< nodes along a side of `luminance` and the colours, >= 2
  int vndf = 128;             ///< nodes along a side of `vndf`, >= 4: some of them reflect
  std::size_t incident = 96;  ///< at most this many incident angles, >= 24
  double tolerance = 0.002;   ///< of the interpolation between them: relative L1 of f_r cos(theta_o),
                              ///< times cos(theta_i)
};

/// Any isotropic BRDF in the parametrisation of the RGL format (Dupuy and Jakob 2018), so that its
/// readers evaluate and importance-sample it.
///
/// - `ndf`: from the retro-reflection (extract_ndf()), with a hundredth of a Lambertian's so that it
///   never vanishes; normalised, integral of D cos = 1. `sigma`: its projected area, 1 at 0.
/// - `vndf`: readers take it for the density that warps the unit square of luminance and colours
///   to microfacet normals, nothing more. Here it is the cube root of the density of
///   the normals that reflect like the material, 0 where they reflect below the horizon: it puts the
///   nodes where linear interpolation of a peak and its tails needs them (in proportion to the
///   density of visible normals, as in the paper, the tails go without, with errors three to five
///   times as large). Each slice integrates to 1.
/// - `luminance`: what is missing to f_r cos(theta_o); each slice integrates to 1. Both together
///   are the readers' pdf, of which less than 0.002 falls below the horizon.
/// - colours: f_r cos(theta_o) 4 sigma / D (jacobian is true), fitted so that means over cells keep.
/// - theta_i: every four degrees, to 89, and between where linear interpolation misses.
///
/// docs/guide/renderers.md has the errors. Deterministic; uses all cores.
/// @throws Error for sizes out of range
RglFile resample_as_rgl(const Reflectance& f_r, std::string description, const RglSize& size = {},
                        const Progress& progress = {});

}  // namespace gonio
