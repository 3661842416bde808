#pragma once

#include <optional>
#include <vector>

#include "tools/render/scene/scene.h"
#include "tools/render/trace/world.h"

namespace gonio {

/// Draws a light and a direction to it, for a point that is lit: the environment, objects that emit,
/// and goniometric lights. Half of the draws are in proportion to power; half are as many for each, so
/// that a weak one that is near is not left out. Thread safety: immutable.
class LightSampling {
 public:
  LightSampling(const Scene& scene, const World& world);

  struct Sample {
    glm::vec3 direction;  ///< unit
    float distance;       ///< to just off its surface; infinite for the environment
    glm::vec3 radiance;   ///< of a goniometric light: irradiance over the cosine
    float pdf;            ///< per solid angle, with the choice of the light; of a goniometric light: of the choice
    bool delta;           ///< a light that no ray can hit by chance
  };
  /// @param pick in [0, 1), chooses the light @param u in [0, 1)^2
  std::optional<Sample> sample(const glm::vec3& point, float pick, glm::vec2 u) const noexcept;

  /// The pdf with which sample() draws a direction that leaves the scene, or one that hits an emitting
  /// triangle.
  float pdf_environment(const glm::vec3& direction) const noexcept;
  float pdf_triangle(const Hit& hit, const glm::vec3& direction) const noexcept;

 private:
  struct Source {
    enum class Kind { environment, triangle, goniometric } kind;
    std::size_t object, triangle;  // of a goniometric light: its index, in `object`
    double area, power;
  };
  float probability(std::size_t source) const noexcept {
    return static_cast<float>(cumulative_[source + 1] - cumulative_[source]);
  }

  const Scene& scene_;
  std::vector<Source> sources_;
  std::vector<double> cumulative_;            // of sources 0 ... n
  std::vector<std::size_t> first_of_object_;  // the source of an emitting object's triangle 0
  bool has_environment_ = false;              // it is source 0
};

}  // namespace gonio
