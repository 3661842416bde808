#pragma once

#include <vector>

#include <Eigen/Core>

#include <gonio/fitting/fit/brdf_function.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/fitting/sampling/sheared_ggx.h>

/// How a LobeSampler finds its weights and shapes; not installed.
namespace gonio::detail {

/// A number for each part of the mixture: the cosine, then the lobes. Does not allocate.
using PerPart = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, 1 + LobeSampler::max_lobes, 1>;

/// The mixture at one incident angle.
struct Proposal {
  PerPart weight;                         ///< sum 1
  std::vector<ShearedGgx<double>> shape;  ///< of the lobes
};

/// The integrand at one incident angle, at half vectors that are dense about the normal, where
/// narrow lobes lie.
struct Quadrature {
  struct Point {
    glm::dvec3 wo;       ///< above the horizon
    double solid_angle;  ///< sr of wo, both mirror halves
    double target;       ///< L(f_r) cos_o over its integral
  };
  glm::dvec3 wi;
  std::vector<Point> points;  ///< empty if f is 0 everywhere
};

Quadrature quadrature(const BrdfFunction& f, double theta_i);

/// Weights by albedo (luminance) with the shapes of the model; a lobe that is not GGX gets the GGX
/// of about its width, whose longer tail makes it the safe choice.
Proposal albedo_proposal(const LobeModel& model, double theta_i, double cosine_share);

/// Relative variance of one draw: integral of target^2 / pdf, less 1.
double relative_variance(const Quadrature& quadrature, const Proposal& proposal);

/// Improves a proposal by minimising the relative variance of a draw; never makes it worse.
Proposal refine_proposal(const Quadrature& quadrature, const Proposal& start, bool shapes, double cosine_share);

/// The proposals for ascending incident angles, weights and shapes refined. The best of several
/// starts is found in the middle of the range; its neighbours start from it and so on outwards, so
/// that shapes vary smoothly and can be interpolated. @param start the albedo proposals of the same
/// angles
std::vector<Proposal> refine_all(const std::vector<Quadrature>& quadratures, std::vector<Proposal> start, bool shapes,
                                 double cosine_share);

}  // namespace gonio::detail
