#pragma once

#include "tools/render/scene/scene.h"
#include "tools/render/trace/light_sampling.h"
#include "tools/render/trace/sobol.h"
#include "tools/render/trace/world.h"

namespace gonio {

/// How direct light is estimated.
enum class Strategy {
  mis,   ///< lights and material are both drawn from, combined by the power heuristic
  bsdf,  ///< directions of the material alone (goniometric lights, which nothing hits, are drawn)
  light  ///< lights alone
};

inline constexpr Strategy strategies[] = {Strategy::mis, Strategy::bsdf, Strategy::light};
const char* to_string(Strategy strategy) noexcept;

/// What one path brings to its pixel.
struct PathResult {
  glm::vec3 radiance{0};
  glm::vec3 albedo{0};  ///< weight of the first draw of the first surface: its mean is the directional albedo
  glm::vec3 normal{0};  ///< of the first surface, in the world
};

/// A unidirectional path tracer: radiance along a camera ray, unbiased. Combination by the power
/// heuristic with exponent 2 (Veach and Guibas 1995); Russian roulette from the fourth surface on, by
/// the largest channel of the throughput. Thread safety: immutable.
class PathTracer {
 public:
  /// Keeps references. All materials must have their samplers.
  /// @param max_bounces surfaces after the first one
  /// @param world of a scene with the same objects; null: made here @throws Error if Embree fails.
  PathTracer(const Scene& scene, Strategy strategy, int max_bounces, std::shared_ptr<const World> world = nullptr);

  /// @param x,y pixels from the upper left corner, fractions within them
  PathResult trace(float x, float y, PathSequence& random) const noexcept;

  /// The object that a camera ray meets first.
  std::optional<std::size_t> first_object(float x, float y) const noexcept;

 private:
  glm::vec3 camera_direction(float x, float y) const noexcept;
  glm::vec3 direct_light(const glm::vec3& from, const glm::vec3& normal, const Scatter& bsdf, const glm::mat3& frame,
                         const glm::vec3& wi, float pick, glm::vec2 u) const noexcept;

  const Scene& scene_;
  std::shared_ptr<const World> world_;
  LightSampling lights_;
  Strategy strategy_;
  int max_bounces_;
  glm::vec3 corner_, right_, down_;  // directions of pixel coordinates: corner + x right + y down
};

}  // namespace gonio
