#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gonio/fitting/fit/brdf_function.h>
#include <gonio/fitting/model/model.h>

namespace gonio {

/// Directions further from the normal than this (radians; 75 degrees) are left out of fits and
/// counted apart in errors: goniometers measure worst there.
inline constexpr double default_grazing_cutoff = 75 * pi<double> / 180;

/// What is compared: C(f_r cos_o) of the model with that of the table.
enum class Compression {
  none,       ///< C(x) = x: the peak decides everything
  cube_root,  ///< C(x) = (x + 1e-4)^(1/3), close to how brightness is seen (Bieron and Peers 2020)
  log         ///< C(x) = log(1 + 1000 x), after Loew et al. 2012, eq. 17: tails count like peaks
};

struct FitOptions {
  /// Cube root: plain residuals give up the tails, logarithmic ones the peak.
  Compression compression = Compression::cube_root;

  /// Pairs with either direction beyond this angle from the normal (radians) are left out.
  double grazing_cutoff = default_grazing_cutoff;

  /// Weigh every pair by the solid angles it stands for, so that the cost is an integral whatever
  /// the sampling; off, every sample counts the same, which stresses the peak that is sampled
  /// densely.
  bool solid_angle_weights = true;

  /// Width of a Huber loss in units of the compressed residual; 0 is least squares. Off by default,
  /// since cells that a reader repaired do not count; 0.05 with cube_root suits noisy tables.
  double robust_width = 0;

  /// Shape parameters per channel (true) or one for the three (false). Colours are always per
  /// channel. Shared: measured lobes seldom differ between channels, and the model stays one lobe
  /// to sample.
  bool separate_channels = false;

  int starts = 4;           ///< local optimisations per number of lobes, besides the one from one lobe less
  std::uint32_t seed = 1;   ///< of the random starts; the same seed gives the same fit
  int max_iterations = 80;  ///< of each local optimisation; most need 10 to 40

  /// Samples of theta_h in [0, 90] degrees (spaced as the square), theta_d in [0, 90] and phi_d in
  /// [0, 180]; half of them have both directions inside the cut-off. 90, 10: a MERL table is
  /// read at centres of its cells, where nothing is interpolated, and a lobe of alpha = 0.005 is
  /// resolved.
  int theta_h = 90, theta_d = 10, phi_d = 6;
};

enum class Termination { converged, iteration_limit, failed };

const char* to_string(Termination termination) noexcept;

/// How much one parameter differs between the starts that ended within 1 % of the best cost.
struct ParameterSpread {
  std::string name;  ///< lobe number, lobe, parameter and channel: "1.ggx.alpha", "0.lambert.albedo.r"
  double value, min, max;
};

struct FitSummary {
  Termination termination = Termination::failed;
  int iterations = 0;         ///< of the best start
  double initial_cost = 0;    ///< of the best start
  double cost = 0;            ///< half the weighted mean square of the compressed residuals (robust: its loss)
  std::vector<double> costs;  ///< of every start, in their order
  int agreeing_starts = 0;    ///< how many ended within 1 % of the best cost
  std::vector<ParameterSpread> parameters;
  int samples = 0;  ///< pairs of directions that were compared
};

struct Fit {
  LobeModel model;
  FitSummary summary;
};

/// Fits the lobes of `form` to f, where f is not NaN. The parameters that `form` holds do not matter, only which lobes
/// it has and which Fresnel term.
///
/// All prefixes are fitted: the diffuse lobes with one specular lobe, with two, and so on; entry k
/// of the result has k + 1 specular lobes (one entry without specular lobes if there are none).
/// Each starts from the one before and from a scan over widths, so that its cost is never higher.
/// The amplitudes are linear and are solved for inside the scan; then all parameters are refined
/// together by Ceres' trust region with bounds and derivatives from the lobes themselves. Never
/// prints. Deterministic.
/// @throws Error if `form` has no lobe, an option is out of its range, or f is 0 or not finite
/// at every pair of directions that is looked at.
std::vector<Fit> fit_stages(const BrdfFunction& f, const LobeModel& form, const FitOptions& options = {});

/// The last of fit_stages().
Fit fit(const BrdfFunction& f, const LobeModel& form, const FitOptions& options = {});

}  // namespace gonio
