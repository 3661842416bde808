#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gonio/brdf/proof/measure.h>

namespace gonio::proof {

/// One thing that every correct sampler does, checked.
struct Check {
  std::string name;  ///< see check_invariants()
  double value;      ///< what was found
  double bound;      ///< what it is compared with
  bool passed;
  std::string message;  ///< value, bound and the worst case in words, one line
};
using Checks = std::vector<Check>;

struct InvariantOptions {
  std::uint64_t draws = 1000000;  ///< of the statistical tests
  int points = 4000;              ///< draws and directions that are looked at one by one
  std::uint32_t seed = 1;
  /// Probability that a correct sampler fails one of the statistical tests of `runs` calls of
  /// check_invariants(); shared out among them by Sidak's formula.
  double significance = 0.01;
  int runs = 1;

  bool one_to_one = true;  ///< invert() is the only pre-image; false for a mixture
  bool turns = true;       ///< draws turn with wi; false for samplers that do not look at wi
  bool symmetric = true;   ///< pdf and map are mirrored at the plane of incidence
  bool continuous = true;  ///< the density has no jumps, at theta_i neither; the map of the square has no tears
                           ///< or folds (see Coherence)

  double mass_bound = 1e-3;  ///< of |integral of the pdf + share of empty draws - 1|
  /// Of the returned pdf against pdf(): relative, and in units of the largest density met, besides what
  /// rounding of (u, v) and wo makes of them. (Next to the horizon v and r have few digits left.)
  double pdf_bound = 2e-3, pdf_floor = 1e-4;
  double weight_bound = 1e-4;      ///< relative, of the weight against f_r cos theta_o / pdf
  double round_trip_bound = 1e-4;  ///< of (u, v), absolute, besides rounding of wo
  double direction_bound = 5e-4;   ///< of directions, absolute, besides rounding of (u, v)
  /// Next to the sides of the square (scan_edges()): of the returned pdf over pdf(), or its inverse, and of the largest
  /// weight over the largest one in the interior.
  double edge_pdf_bound = 1.1, edge_weight_bound = 2;
  /// Of the largest weight of any direction (scan_directions()), over the mean one. Infinite: not looked at.
  double direction_weight_bound = std::numeric_limits<double>::infinity();
  /// Weights and round trips are judged where the density is at least this share of the largest one
  /// met; elsewhere floats have no digits left.
  double density_floor = 1e-6;

  std::string plot;  ///< path of an SVG that is written if the chi-square test fails; none if empty
};

/// Checks a sampler at one incident angle, theta_i [rad] in [0, pi/2]. Deterministic for a seed.
/// Named checks, in this order; those for which the subject has no function are left out:
///
/// - `domain`: draws are finite unit vectors above the horizon with pdf > 0 and finite, for u and v
///   at 0, next to 1 and anywhere. Number of draws that are not; 0.
/// - `mass`: the pdf by quadrature, no draw involved, and the share of empty draws make 1.
/// - `where_zero`: number of draws where the pdf is 0, in cells over which it is by quadrature; 0.
/// - `chi_square`: p of the draws against the pdf, in cells adapted to its peaks.
/// - `moments`: two-sided p of the t-test of the draws' mean x, y and z against their quadrature, the
///   least of the three. (With so many draws Student's distribution is the normal one.)
/// - `albedo`: the same of the mean weight (each channel) against the quadrature of f_r cos theta_o.
/// - `pdf`: the returned pdf against pdf(), in units of the pdf bounds.
/// - `weight`: the weight against f_r cos theta_o / pdf, relative.
/// - `edge_domain`, `edge_pdf`, `edge_weight`: draws next to the sides of the square, at all distances from them: the
/// number of draws that are none, the pdf and the weight; see scan_edges() and the bounds above. Weights where there is
/// f_r alone.
/// - `directions`: the largest weight f_r cos theta_o / pdf of any direction, whether a draw falls there or not.
/// - `support`: share of the albedo at directions with f_r > 0 and pdf = 0; 0.
/// - `round_trip_square`: |invert(sample(u, v)) - (u, v)|, the largest component.
/// - `round_trip_direction`: |sample(invert(w)) - w|, the largest component.
/// - `mirror`: pdf of a direction and its mirror image, in units of the pdf bound.
/// - `rotation`: pdf and draws when both directions turn about the normal, in units of the pdf bound and
///   of the bound of directions. Not at normal incidence, which has no azimuth.
/// - `jumps`: share of places where the density jumps: across theta_i, across the seam (phi = 0 and
///   +-pi), and along r and phi, over a few degrees each. A jump is a change by over 1 % that stays an
///   eighth of what it is over the whole stretch when the stretch is halved sixteen times about it. At
///   most 0.02: a density may be steep enough in a few places.
/// - `jumps_of_map`: share of (u, v) whose direction jumps across theta_i, in the same sense; 0.
/// - `tears`: number of tears and folds of the map on 64 x 64 cells (see Coherence).
Checks check_invariants(const Subject& subject, double theta_i, const InvariantOptions& options = {});

/// Whether all of them passed, and the messages of those that did not, a line each.
bool all_passed(const Checks& checks);
std::string failures(const Checks& checks);

}  // namespace gonio::proof
