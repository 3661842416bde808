#pragma once

#include <functional>

#include <gonio/brdf/table/table.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// What a stack is built for, and its size: what ends its growth, whichever comes first.
struct StackOptions {
  int incident = 192;              ///< at most this many incident angles, >= 2
  int meridians = 40;              ///< at most this many in a diagram, >= 2
  int parallels = 40;              ///< at most this many in a diagram, >= 2
  std::size_t bytes = 480 * 1024;  ///< at most this much memory, once there are seven diagrams
  double tolerance = 0.003;        ///< relative variance that is good enough, at and between all angles
  Chart chart = Chart::outgoing;
  Interpolation interpolation = Interpolation::displacement;  ///< `blend`: all diagrams get the same lines
};

/// Called now and then with the share of the work that is done, in [0, 1]; from one thread at a time.
using Progress = std::function<void(double)>;

/// Share of a cosine lobe in every diagram: keeps pdf > 0 wherever the table may be > 0, also where
/// a neighbouring incident angle or a line that lies between two cells saw nothing. Its price is a
/// relative variance of at most this share.
inline constexpr double cosine_share = 1e-3;

/// The transfer density g(wo) = L(f_r(wi, wo)) cos theta_o with L the Rec. 709
/// luminance, as the mean over both signs of phi [1/sr].
double transfer_density(const BrdfTable& table, double theta_i, const Vec3<double>& wo);

/// The density that a diagram tabulates: g per 2 r dr dphi of the disk, so in the half-vector chart times
/// the Jacobian of HalfVectorChart.
double disk_density(const BrdfTable& table, Chart chart, double theta_i, Polar<double> at);

/// Builds the diagrams of a table: each fitted to its incident angle (fit_diagram()), the angles
/// placed where the interpolation between their neighbours fails (displacement, or blend), measured by
/// the relative variance at three angles between them. Stacks for `blend` have the lines that serve all
/// incident angles best (LineFit). If the bytes do not suffice for the tolerance, it is relaxed as long as that
/// lowers the mean error. Deterministic. Uses all cores; the result does not depend on their number.
///
/// A table that reflects nothing at an angle gets a cosine lobe there.
/// @throws Error for sizes out of range.
StackGrid build_stack(const BrdfTable& table, const StackOptions& options = {},
                      const Progress& progress = {});

}  // namespace gonio
