#include "tools/render/trace/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace gonio {
namespace {

/// Duff et al., "Building an Orthonormal Basis, Revisited", Journal of Computer Graphics Techniques
/// 6(1), 2017.
glm::mat3 frame_of(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

float power_heuristic(float chosen, float other) {
  const float ratio = other / chosen;
  return 1 / (1 + ratio * ratio);
}

}  // namespace

const char* to_string(Strategy strategy) noexcept {
  static constexpr const char* names[] = {"mis", "bsdf", "light"};
  return names[static_cast<std::size_t>(strategy)];
}

PathTracer::PathTracer(const Scene& scene, Strategy strategy, int max_bounces, std::shared_ptr<const World> world)
    : scene_(scene),
      world_(world ? std::move(world) : std::make_shared<const World>(scene)),
      lights_(scene, *world_),
      strategy_(strategy),
      max_bounces_(max_bounces) {
  const Camera& c = scene.camera;
  const glm::vec3 ahead = glm::normalize(c.target - c.position), right = glm::normalize(glm::cross(ahead, c.up)),
                  up = glm::cross(right, ahead);
  const float pixel = 2 * std::tan(0.5f * c.vertical_fov) / static_cast<float>(c.height);
  right_ = pixel * right;
  down_ = -pixel * up;
  corner_ = ahead - 0.5f * static_cast<float>(c.width) * right_ - 0.5f * static_cast<float>(c.height) * down_;
}

glm::vec3 PathTracer::camera_direction(float x, float y) const noexcept {
  return glm::normalize(corner_ + x * right_ + y * down_);
}

std::optional<std::size_t> PathTracer::first_object(float x, float y) const noexcept {
  const auto hit = world_->intersect(scene_.camera.position, camera_direction(x, y));
  if (!hit) return std::nullopt;
  return hit->object;
}

PathResult PathTracer::trace(float x, float y, PathSequence& random) const noexcept {
  PathResult result;
  glm::vec3 origin = scene_.camera.position, direction = camera_direction(x, y), throughput(1);
  float pdf = 0;  // of the direction, where the light it meets could have been drawn as well

  const auto weight = [&](float light_pdf) {
    if (strategy_ == Strategy::light) return 0.0f;
    return strategy_ == Strategy::mis ? power_heuristic(pdf, light_pdf) : 1.0f;
  };
  for (int bounce = 0;; ++bounce) {
    const std::optional<Hit> hit = world_->intersect(origin, direction);
    if (!hit) {
      if (scene_.environment)
        result.radiance += throughput * scene_.environment->radiance(direction) *
                           (bounce == 0 ? 1.0f : weight(lights_.pdf_environment(direction)));
      return result;
    }
    const Object& object = scene_.objects[hit->object];
    const bool outside = glm::dot(direction, hit->normal) < 0;
    if (outside && luminance(object.emission) > 0)
      result.radiance +=
          throughput * object.emission * (bounce == 0 ? 1.0f : weight(lights_.pdf_triangle(*hit, direction)));
    const Material& material = scene_.materials[object.material];
    // Those of the side that is seen; the path goes on from just off it.
    const float flip = outside ? 1.0f : -1.0f;
    const glm::vec3 normal = flip * hit->normal, shading_normal = flip * hit->shading_normal;
    origin = hit->position + hit->step * normal;
    if (bounce == 0) result.normal = shading_normal;
    if (bounce > max_bounces_ || (!outside && !material.two_sided)) return result;

    const glm::mat3 frame = frame_of(shading_normal);
    const glm::vec3 wi = -direction * frame;
    // Always the same number of decisions a surface, so that one does not take another's dimension.
    const glm::vec2 choice = random.next(), light_u = random.next(), u = random.next();
    if (!(wi.z > 0)) return result;  // seen from behind the shading normal
    result.radiance += throughput * direct_light(origin, normal, *material.bsdf, frame, wi, choice.x, light_u);

    const auto s = material.bsdf->sample(wi, u);
    if (!s) return result;
    if (bounce == 0) result.albedo = s->weight;
    direction = glm::normalize(frame * s->wo);
    // Below the triangle, though above the shading normal's horizon.
    if (!(glm::dot(direction, normal) > 0)) return result;
    throughput *= s->weight;
    pdf = s->pdf;
    if (bounce >= 3) {
      const float survive = std::min(0.95f, std::max(throughput.r, std::max(throughput.g, throughput.b)));
      if (!(choice.y < survive)) return result;
      throughput /= survive;
    }
  }
}

glm::vec3 PathTracer::direct_light(const glm::vec3& from, const glm::vec3& normal, const Scatter& bsdf,
                                   const glm::mat3& frame, const glm::vec3& wi, float pick,
                                   glm::vec2 u) const noexcept {
  const auto light = lights_.sample(from, pick, u);
  if (!light || !(light->pdf > 0)) return glm::vec3(0);
  if (strategy_ == Strategy::bsdf && !light->delta) return glm::vec3(0);
  const glm::vec3 wo = light->direction * frame;
  if (!(wo.z > 0) || !(glm::dot(light->direction, normal) > 0)) return glm::vec3(0);
  const glm::vec3 value = bsdf.eval(wi, wo) * wo.z * light->radiance / light->pdf;
  if (!(luminance(value) > 0)) return glm::vec3(0);
  // A little short of it: a lamp may lie on a ceiling.
  if (world_->occluded(from, light->direction, light->distance * (1 - 1e-4f))) return glm::vec3(0);
  const bool alone = light->delta || strategy_ == Strategy::light;
  return alone ? value : value * power_heuristic(light->pdf, bsdf.pdf(wi, wo));
}

}  // namespace gonio
