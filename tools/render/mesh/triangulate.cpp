#include "tools/render/mesh/triangulate.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace gonio {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon as seen along an axis, the one that it faces most, from where it turns counter-clockwise.
std::vector<glm::dvec2> flatten(const TriangleMesh& mesh, const std::vector<std::uint32_t>& corners) {
  const auto at = [&](std::size_t k) { return glm::dvec3(mesh.positions[corners[k]]); };
  glm::dvec3 normal(0);
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
  const glm::dvec3 size = glm::abs(normal);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = normal[z] < 0 ? (z + 2) % 3 : (z + 1) % 3, y = 3 - z - x;
  std::vector<glm::dvec2> points;
  for (std::size_t k = 0; k < corners.size(); ++k) points.push_back({at(k)[x], at(k)[y]});
  return points;
}

/// Whether the triangle of these three neighbours has nothing of the polygon's boundary inside.
bool is_ear(const std::vector<glm::dvec2>& points, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  if (!(cross(a, b, c) >= 0)) return false;
  for (const glm::dvec2& p : points)
    if (p != a && p != b && p != c && cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
  return true;
}

}  // namespace

bool add_polygon(TriangleMesh& mesh, std::vector<std::uint32_t> corners) {
  std::vector<glm::dvec2> points = flatten(mesh, corners);
  const auto next = [&](std::size_t k) { return (k + 1) % corners.size(); };
  const auto previous = [&](std::size_t k) { return (k + corners.size() - 1) % corners.size(); };
  bool convex = true;
  for (std::size_t k = 0; k < corners.size(); ++k)
    convex = convex && cross(points[previous(k)], points[k], points[next(k)]) >= 0;
  if (!convex && corners.size() > max_corners) return false;
  std::size_t k = 0, tried = convex ? corners.size() : 0;
  while (corners.size() > 3 && tried < corners.size()) {
    k = next(k);
    ++tried;
    if (!is_ear(points, points[previous(k)], points[k], points[next(k)])) continue;
    mesh.triangles.push_back({corners[previous(k)], corners[k], corners[next(k)]});
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(k));
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(k));
    k = previous(k);
    tried = 0;
  }
  for (std::size_t j = 1; j + 1 < corners.size(); ++j)
    mesh.triangles.push_back({corners[0], corners[j], corners[j + 1]});
  return true;
}

}  // namespace gonio
