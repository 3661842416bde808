#pragma once

#include <gonio/brdf/build/stack/bsdf_options.h>
#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/progress.h>

namespace gonio {

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
/// Of the options, chart, interpolation, variance, budget (of floats, once there are seven diagrams) and sizes count.
/// A table that reflects nothing at an angle gets a cosine lobe there.
/// @throws Error for sizes out of range.
StackGrid build_stack(const BrdfTable& table, const BsdfOptions& options = {}, const Progress& progress = {});

}  // namespace gonio
