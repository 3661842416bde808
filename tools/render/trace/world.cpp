#include "tools/render/trace/world.h"

#if GONIO_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

RTCRay make_ray(const glm::vec3& o, const glm::vec3& d, float distance) {
  RTCRay ray{};
  ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
  ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
  ray.tnear = 0, ray.tfar = distance;
  ray.mask = ~0u;
  return ray;
}

// Embree 4 has defaults where Embree 3 has a context.
#if GONIO_EMBREE == 4
void find_hit(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
void find_occluder(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
#else
void find_hit(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}
void find_occluder(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace

float step_off(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) noexcept {
  const glm::vec3 size = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  return 4e-6f * std::max(size.x, std::max(size.y, size.z));
}

struct World::Embree {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = device ? rtcNewScene(device) : nullptr;
  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

World::World(const Scene& scene) : scene_(scene), embree_(std::make_unique<Embree>()) {
  if (!embree_->device) throw Error("Embree: cannot be started");
  // Robust: rays through edges that triangles share do not pass between them.
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  for (const Object& object : scene.objects) {
    const TriangleMesh& mesh = *object.mesh;
    const RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                              mesh.positions.size());
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (positions && triangles) {
      std::memcpy(positions, mesh.positions.data(), sizeof(glm::vec3) * mesh.positions.size());
      std::memcpy(triangles, mesh.triangles.data(), sizeof(mesh.triangles[0]) * mesh.triangles.size());
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(embree_->scene, geometry);
    }
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(embree_->scene);
  if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE)
    throw Error("Embree: found no memory for the scene, expected enough");
  RTCBounds b;
  rtcGetSceneBounds(embree_->scene, &b);
  radius_ = 0.5f * glm::length(glm::vec3(b.upper_x - b.lower_x, b.upper_y - b.lower_y, b.upper_z - b.lower_z));
}

World::~World() = default;

std::optional<Hit> World::intersect(const glm::vec3& origin, const glm::vec3& direction) const noexcept {
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  find_hit(embree_->scene, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const TriangleMesh& mesh = *scene_.objects[query.hit.geomID].mesh;
  const auto& t = mesh.triangles[query.hit.primID];
  const glm::vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]], ab = b - a, ac = c - a;
  const float u = query.hit.u, v = query.hit.v;
  Hit hit;
  hit.object = query.hit.geomID;
  hit.triangle = query.hit.primID;
  hit.distance = query.ray.tfar;
  hit.position = a + u * ab + v * ac;  // more accurate than along the ray
  hit.step = step_off(a, b, c);
  hit.normal = glm::vec3(
      glm::normalize(glm::cross(glm::dvec3(ab), glm::dvec3(ac))));  // a float's square of an area underflows early
  hit.shading_normal = hit.normal;
  if (!mesh.normals.empty()) {
    const glm::vec3 n = (1 - u - v) * mesh.normals[t[0]] + u * mesh.normals[t[1]] + v * mesh.normals[t[2]];
    if (glm::dot(n, hit.normal) > 0) hit.shading_normal = glm::normalize(n);
  }
  return hit;
}

bool World::occluded(const glm::vec3& origin, const glm::vec3& direction, float distance) const noexcept {
  RTCRay ray = make_ray(origin, direction, distance);
  find_occluder(embree_->scene, ray);
  return ray.tfar < 0;
}

}  // namespace gonio
