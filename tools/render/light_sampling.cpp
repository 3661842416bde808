#include <gonio/tools/render/light_sampling.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace gonio {

LightSampling::LightSampling(const Scene& scene, const World& world) : scene_(scene), first_of_object_(scene.objects.size(), 0) {
  std::vector<double> powers;
  const auto add = [&](const Source& source, float power) {
    if (!(power > 0)) return false;
    sources_.push_back(source);
    powers.push_back(static_cast<double>(power));
    return true;
  };
  if (scene.environment) {
    // The flux through a disk as wide as the scene.
    const float power = scene.environment->power() * pi<float> * world.radius() * world.radius();
    has_environment_ = add({Source::Kind::environment, 0, 0, 0}, power);
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const Object& object = scene.objects[k];
    first_of_object_[k] = sources_.size();
    if (!(luminance(object.emission) > 0)) continue;
    for (std::size_t t = 0; t < object.mesh.triangles.size(); ++t) {
      const auto& v = object.mesh.triangles[t];
      const glm::vec3 a = object.mesh.positions[v[0]];
      const float area = 0.5f * glm::length(glm::cross(object.mesh.positions[v[1]] - a, object.mesh.positions[v[2]] - a));
      // One entry for every triangle, so that a hit finds its own.
      sources_.push_back({Source::Kind::triangle, k, t, area});
      powers.push_back(static_cast<double>(area * pi<float> * luminance(object.emission)));
    }
  }
  for (std::size_t k = 0; k < scene.lights.size(); ++k)
    add({Source::Kind::goniometric, k, 0, 0}, static_cast<float>(scene.lights[k].emission->flux()) * luminance(scene.lights[k].scale));

  double sum = 0;
  for (const double p : powers) sum += p;
  double before = 0;
  cumulative_.push_back(0);
  for (const double p : powers) cumulative_.push_back(static_cast<float>((before += p) / sum));
}

std::optional<LightSampling::Sample> LightSampling::sample(const glm::vec3& point, float pick, glm::vec2 u) const noexcept {
  if (sources_.empty()) return std::nullopt;
  auto k = static_cast<std::size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), pick) - cumulative_.begin());
  k = std::min(std::max<std::size_t>(k, 1), sources_.size()) - 1;
  const float chosen = probability(k);
  if (!(chosen > 0)) return std::nullopt;
  const Source& source = sources_[k];
  if (source.kind == Source::Kind::environment) {
    const auto s = scene_.environment->sample(u);
    if (!s) return std::nullopt;
    return Sample{s->direction, std::numeric_limits<float>::infinity(), scene_.environment->radiance(s->direction), chosen * s->pdf, false};
  }
  if (source.kind == Source::Kind::goniometric) {
    const GoniometricLight& light = scene_.lights[source.object];
    const glm::vec3 to = light.position - point;
    const float distance = glm::length(to);
    if (!(distance > 0)) return std::nullopt;
    const glm::vec3 direction = to / distance;
    const float candela = light.emission->intensity(light.to_light * -direction);
    return Sample{direction, distance, light.scale * (candela / (distance * distance)), chosen, true};
  }
  const Object& object = scene_.objects[source.object];
  const auto& v = object.mesh.triangles[source.triangle];
  const glm::vec3 a = object.mesh.positions[v[0]], ab = object.mesh.positions[v[1]] - a, ac = object.mesh.positions[v[2]] - a;
  const float root = std::sqrt(u.x);  // uniform on the triangle
  const glm::vec3 to = a + root * (1 - u.y) * ab + root * u.y * ac - point, normal = glm::normalize(glm::cross(ab, ac));
  const float distance = glm::length(to);
  if (!(distance > 0)) return std::nullopt;
  const glm::vec3 direction = to / distance;
  const float cosine = -glm::dot(direction, normal);
  if (!(cosine > 0)) return std::nullopt;  // its dark side
  return Sample{direction, distance, object.emission, chosen * distance * distance / (cosine * source.area), false};
}

float LightSampling::pdf_environment(const glm::vec3& direction) const noexcept {
  return has_environment_ ? probability(0) * scene_.environment->pdf(direction) : 0;
}

float LightSampling::pdf_triangle(const Hit& hit, const glm::vec3& direction) const noexcept {
  const std::size_t k = first_of_object_[hit.object] + hit.triangle;
  const float cosine = -glm::dot(direction, hit.normal);
  return cosine > 0 ? probability(k) * hit.distance * hit.distance / (cosine * sources_[k].area) : 0;
}

}  // namespace gonio
