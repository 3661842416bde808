#pragma once

#include <gonio/fitting/brdf_function.h>
#include <gonio/fitting/lobe_sampler.h>

#include <array>
#include <vector>

/// How a LobeSampler finds its weights and shapes; not installed.
namespace gonio::detail {

/// The parts of a mixture at one incident angle.
struct Proposal {
  std::vector<double> weight;                        ///< cosine first; sum 1
  std::vector<std::array<double, max_shape>> shape;  ///< of the specular lobes
};

/// One direction of a quadrature over wo, for a fixed wi.
struct QuadraturePoint {
  Angles<double> angles;  ///< cos_o may be below 0: mixtures lose draws there
  double solid_angle;     ///< sr
  double target;          ///< L(f_r) cos_o over its integral; 0 below the horizon
};

/// Points in half-vector coordinates, dense where a narrow lobe lies; empty if f is 0 there.
std::vector<QuadraturePoint> quadrature(const BrdfFunction& f, double theta_i);

/// Weights by albedo (luminance) with the shapes of the model.
Proposal albedo_proposal(const LobeModel& model, double theta_i, double cosine_share);

/// Improves a proposal by minimising the relative variance of a draw.
Proposal refine_proposal(const std::vector<QuadraturePoint>& points,
                         const std::vector<LobeKind>& kinds, const Proposal& start, bool shapes,
                         double cosine_share);

/// Relative variance of one draw: integral of target^2 / pdf, less 1.
double relative_variance(const std::vector<QuadraturePoint>& points,
                         const std::vector<LobeKind>& kinds, const Proposal& proposal);

}  // namespace gonio::detail
