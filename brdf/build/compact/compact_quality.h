#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/stack/bsdf_options.h>

namespace gonio {

/// How well the densities of a stack sample a table, and how far the stack with its colour is from it.
struct CompactQuality {
  double worst_relvar = 0;  ///< largest relative variance of f_table cos / pdf at the angles up to 80 degrees
  double mean_relvar = 0;   ///< mean over these angles, weighted by the incidence
  /// Integral of |f - f_table| cos theta_i cos theta_o over both hemispheres and the RGB channels, over that of
  /// f_table cos theta_i cos theta_o; up to 80 degrees.
  double eval_error = 0;
  /// Largest difference of the directional albedos of a channel, over the largest channel's albedo, up to 80 degrees.
  double albedo_error = 0;
};

/// The share of an angle's bin over the mean share, but at least 0.02: what was never seen may still come.
double incidence_weight(const Incidence& incidence, double theta_i);

/// One draw of a map.
struct CompactDraw {
  SquarePoint<float> at;
  glm::vec3 wo;      ///< in the frame of the diagrams
  float pdf;         ///< [1/sr]; 0 if there is no direction
  glm::vec3 weight;  ///< f_table cos theta_o / pdf
};

/// Draws of a map at many incident angles, with the table's weights: what any colour is measured against.
class CompactDraws {
 public:
  /// Uses all cores. Deterministic.
  CompactDraws(const BrdfTable& table, const DirectionMap& map, const Incidence& incidence = {});

  CompactQuality quality(const Colour& colour) const;

  /// The same for any f: its weight f cos theta_o / pdf for a draw at theta_i [rad]. A draw for which it is NaN has no
  /// part in the errors. Called from several threads.
  CompactQuality quality(const std::function<glm::vec3(float theta_i, const CompactDraw&)>& weight) const;

  /// Up to `count` angles with the largest relative variance above `limit`, none next to another [rad].
  std::vector<double> worst_angles(double limit, std::size_t count) const;

 private:
  struct Angle {
    double theta_i, incidence, relvar;
    std::vector<CompactDraw> draws;
  };
  std::vector<Angle> angles_;
};

}  // namespace gonio
