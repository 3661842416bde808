#include "tools/render/trace/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

namespace {

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& v = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[v[0]]);
  return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[v[1]]) - a, glm::dvec3(mesh.positions[v[2]]) - a));
}

}  // namespace

LightSampling::LightSampling(const Scene& scene, const World& world)
    : scene_(scene), first_of_object_(scene.objects.size(), 0) {
  struct Light {
    std::size_t first, end;  // its sources
    double power;
  };
  std::vector<Light> lights;
  const auto add = [&](const std::vector<Source>& sources) {
    double power = 0;
    for (const Source& s : sources) power += s.power;
    if (!(power > 0)) return;
    lights.push_back({sources_.size(), sources_.size() + sources.size(), power});
    sources_.insert(sources_.end(), sources.begin(), sources.end());
  };
  if (scene.environment) {
    // The flux through a disk as wide as the scene.
    const double radius = static_cast<double>(world.radius());
    add({{Source::Kind::environment, 0, 0, 0,
          static_cast<double>(scene.environment->power()) * pi<double> * radius * radius}});
    has_environment_ = !sources_.empty();
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const Object& object = scene.objects[k];
    first_of_object_[k] = sources_.size();
    const double exitance = pi<double> * static_cast<double>(luminance(object.emission));
    if (!(exitance > 0)) continue;
    std::vector<Source> triangles;  // all of them, so that a hit finds its own
    for (std::size_t t = 0; t < object.mesh->triangles.size(); ++t) {
      const double area = area_of(*object.mesh, t);
      triangles.push_back({Source::Kind::triangle, k, t, area, area * exitance});
    }
    add(triangles);
  }
  for (std::size_t k = 0; k < scene.lights.size(); ++k)
    add({{Source::Kind::goniometric, k, 0, 0,
          scene.lights[k].emission->flux() * static_cast<double>(luminance(scene.lights[k].scale))}});

  double sum = 0, before = 0;
  for (const Light& light : lights) sum += light.power;
  cumulative_.push_back(0);
  for (const Light& light : lights)
    for (std::size_t k = light.first; k < light.end; ++k)
      cumulative_.push_back(before +=
                            sources_[k].power * (0.5 / sum + 0.5 / (static_cast<double>(lights.size()) * light.power)));
}

std::optional<LightSampling::Sample> LightSampling::sample(const glm::vec3& point, float pick,
                                                           glm::vec2 u) const noexcept {
  if (sources_.empty()) return std::nullopt;
  auto k = static_cast<std::size_t>(
      std::upper_bound(cumulative_.begin(), cumulative_.end(), static_cast<double>(pick)) - cumulative_.begin());
  k = std::min(std::max<std::size_t>(k, 1), sources_.size()) - 1;
  const float chosen = probability(k);
  if (!(chosen > 0)) return std::nullopt;
  const Source& source = sources_[k];
  if (source.kind == Source::Kind::environment) {
    const auto s = scene_.environment->sample(u);
    if (!s) return std::nullopt;
    return Sample{s->direction, std::numeric_limits<float>::infinity(), scene_.environment->radiance(s->direction),
                  chosen * s->pdf, false};
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
  const auto& v = object.mesh->triangles[source.triangle];
  const glm::vec3 a = object.mesh->positions[v[0]], b = object.mesh->positions[v[1]], c = object.mesh->positions[v[2]];
  const glm::vec3 normal(glm::normalize(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a))));
  const float root = std::sqrt(u.x);  // uniform on the triangle
  const glm::vec3 to = a + root * (1 - u.y) * (b - a) + root * u.y * (c - a) + step_off(a, b, c) * normal - point;
  const float distance = glm::length(to);
  if (!(distance > 0)) return std::nullopt;
  const glm::vec3 direction = to / distance;
  const float cosine = -glm::dot(direction, normal);
  if (!(cosine > 0)) return std::nullopt;  // its dark side
  return Sample{direction, distance, object.emission,
                chosen * distance * distance / (cosine * static_cast<float>(source.area)), false};
}

float LightSampling::pdf_environment(const glm::vec3& direction) const noexcept {
  return has_environment_ ? probability(0) * scene_.environment->pdf(direction) : 0;
}

float LightSampling::pdf_triangle(const Hit& hit, const glm::vec3& direction) const noexcept {
  const std::size_t k = first_of_object_[hit.object] + hit.triangle;
  const float cosine = -glm::dot(direction, hit.normal);
  return cosine > 0 ? probability(k) * hit.distance * hit.distance / (cosine * static_cast<float>(sources_[k].area))
                    : 0;
}

}  // namespace gonio
