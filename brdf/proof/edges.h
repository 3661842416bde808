#pragma once

#include <cstdint>
#include <string>

#include <gonio/brdf/proof/measure.h>

namespace gonio::proof {

struct EdgeOptions {
  int along = 64;      ///< places along each side of the square, at each distance from it
  int interior = 128;  ///< the interior, at least 2^-10 from the sides, is looked at by one draw in each of interior x
                       ///< interior cells
  std::uint32_t seed = 1;
  Domain domain = Domain::hemisphere;  ///< what directions fill: of luminaires the sphere
};

/// What a sampler does next to the sides of the unit square.
struct EdgeScan {
  std::uint64_t draws = 0;  ///< next to a side
  std::uint64_t empty = 0;  ///< of these, without a direction
  /// Of these, with a direction that is not a unit vector above the horizon, or a pdf or weight that is negative,
  /// zero (the pdf) or not finite.
  std::uint64_t bad = 0;
  double largest_weight = 0;  ///< the largest luminance weight next to a side, over the largest in the interior
  double pdf_factor = 1;  ///< the largest quotient, >= 1, of the pdf that came with a draw and pdf() of its direction
  std::string where_bad, where_weight, where_pdf;  ///< (u, v) of the worst case
};

/// Draws at all distances from the four sides and corners: u or v is 0, the least denormal, the least normal number,
/// 2^-k down to 2^-148 or 1 - 2^-k up to 1 - 2^-24; the other number is one of these, or anywhere. Some 12,000 draws
/// and as many pdfs, besides 16,000 draws in the interior: 4 to 10 ms for a stack.
/// @param theta_i [rad] in [0, pi/2].
EdgeScan scan_edges(const Subject& subject, double theta_i, const EdgeOptions& options = {});

/// The weights that a density gives to directions, whether a draw falls there or not: what light sampling with
/// multiple importance sampling meets.
struct DirectionScan {
  double largest_weight = 0;  ///< the largest L(f_r) cos theta_o / pdf, over its mean by the density: over L(albedo)
  double without_pdf = 0;     ///< share of the albedo at directions with f_r > 0 and pdf = 0
  std::string where;          ///< the direction with the largest weight
};

/// Looks at side x side directions, even in the disk of the hemisphere, and at as many rings from there down to
/// cos theta_o = 2^-23. @param side >= 8. @pre subject.f_r is there.
DirectionScan scan_directions(const Subject& subject, double theta_i, int side = 256);

}  // namespace gonio::proof
