#pragma once

#include <memory>
#include <optional>

#include "tools/render/scene/scene.h"

namespace gonio {

/// Where a ray meets a surface.
struct Hit {
  glm::vec3 position, normal;  ///< normal: of the triangle, to the outside, unit
  glm::vec3 shading_normal;    ///< interpolated, unit, on the side of `normal`
  std::size_t object, triangle;
  float distance;
  float step;  ///< along the normal, to a point from where rays do not meet the triangle again
};

/// That step for a triangle: some tens of units in the last place of its coordinates, so that it follows
/// the unit of length.
float step_off(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) noexcept;

/// The scene's triangles in Embree. Thread safety: immutable; concurrent use is safe.
class World {
 public:
  /// Keeps a reference to the scene. @throws Error if Embree fails.
  explicit World(const Scene& scene);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// @param direction unit
  std::optional<Hit> intersect(const glm::vec3& origin, const glm::vec3& direction) const noexcept;
  bool occluded(const glm::vec3& origin, const glm::vec3& direction, float distance) const noexcept;

  float radius() const noexcept { return radius_; }  ///< of a sphere round all triangles

 private:
  struct Embree;
  const Scene& scene_;
  std::unique_ptr<Embree> embree_;
  float radius_;
};

}  // namespace gonio
