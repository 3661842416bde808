#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

#include "tools/render/mesh/mesh.h"

namespace gonio {
namespace {

TriangleMesh tiles(int first, int step, int side) {
  TriangleMesh mesh;
  for (int row = 0; row < side; ++row)
    for (int column = (first + row) % step; column < side; column += step) {
      const auto at = static_cast<std::uint32_t>(mesh.positions.size());
      const float width = 2 / static_cast<float>(side), x = -1 + width * static_cast<float>(column),
                  y = -1 + width * static_cast<float>(row);
      for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
        mesh.positions.emplace_back(x + width * corner.x, y + width * corner.y, 0);
      mesh.triangles.push_back({at, at + 1, at + 2});
      mesh.triangles.push_back({at, at + 2, at + 3});
    }
  return mesh;
}

/// Means of the triangles' normals, weighted by area.
void smooth(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  for (const auto& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t[0]];
    const glm::vec3 n = glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
    for (const std::uint32_t v : t) mesh.normals[v] += n;
  }
  for (glm::vec3& n : mesh.normals) n = glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0, 0, 1);
}

/// A closed surface that turns round z: point(k, phi) for k = 0 (top) ... rows (bottom). A row where
/// all points are one is allowed.
template <class Point>
TriangleMesh revolve(std::uint32_t rows, std::uint32_t columns, const Point& point) {
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k <= rows; ++k)
    for (std::uint32_t j = 0; j < columns; ++j)
      mesh.positions.push_back(point(k, 2 * pi<float> * static_cast<float>(j) / static_cast<float>(columns)));
  for (std::uint32_t k = 0; k < rows; ++k)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t next = (j + 1) % columns, a = k * columns + j, b = k * columns + next, c = a + columns,
                          d = b + columns;
      for (const std::array<std::uint32_t, 3>& t : {std::array<std::uint32_t, 3>{a, c, d}, {a, d, b}}) {
        const glm::vec3 p = mesh.positions[t[0]];
        if (glm::length(glm::cross(mesh.positions[t[1]] - p, mesh.positions[t[2]] - p)) > 0)
          mesh.triangles.push_back(t);
      }
    }
  return mesh;
}

glm::vec3 on_sphere(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TriangleMesh sphere() {
  constexpr std::uint32_t rows = 128;
  TriangleMesh mesh = revolve(rows, 2 * rows, [](std::uint32_t k, float phi) {
    return on_sphere(k == rows ? pi<float> : pi<float> * static_cast<float>(k) / rows, phi);
  });
  mesh.normals = mesh.positions;
  return mesh;
}

/// 1 at 0, 0 from 1 on, smooth.
float bump(float x) {
  const float t = std::clamp(1 - std::abs(x), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// The foot, from the ball down to the ground: radius and height.
constexpr float foot[][2] = {{0.335f, 0.375f}, {0.300f, 0.32f},  {0.295f, 0.27f},  {0.320f, 0.21f},
                             {0.390f, 0.155f}, {0.490f, 0.125f}, {0.575f, 0.115f}, {0.625f, 0.100f},
                             {0.650f, 0.065f}, {0.650f, 0.03f},  {0.640f, 0.00f},  {0.60f, -0.01f}};

TriangleMesh preview() {
  constexpr float radius = 0.75f, height = 1.05f, ball_end = 2.68f;  // [rad] from the top
  constexpr std::uint32_t ball_rows = 240, rows_a_piece = 12, pieces = std::size(foot) - 3, columns = 480;
  const glm::vec3 dent = on_sphere(1.12f, -2.05f);
  TriangleMesh mesh = revolve(ball_rows + pieces * rows_a_piece, columns, [&](std::uint32_t k, float phi) {
    if (k <= ball_rows) {
      const float theta = ball_end * static_cast<float>(k) / ball_rows;
      const glm::vec3 w = on_sphere(theta, phi);
      const float away = std::acos(std::clamp(glm::dot(w, dent), -1.0f, 1.0f));
      const float r = radius - 0.20f * bump(away / 0.62f) - 0.045f * bump((theta - 2.02f) / 0.10f);
      return glm::vec3(0, 0, height) + r * w;
    }
    // Catmull-Rom through the points of the foot.
    const std::uint32_t at = k - ball_rows, i = std::min((at - 1) / rows_a_piece, pieces - 1);
    const float t = static_cast<float>(at - i * rows_a_piece) / rows_a_piece;
    const auto value = [&](int c) {
      const float p0 = foot[i][c], p1 = foot[i + 1][c], p2 = foot[i + 2][c], p3 = foot[i + 3][c];
      return 0.5f * (2 * p1 + (p2 - p0) * t + (2 * p0 - 5 * p1 + 4 * p2 - p3) * t * t +
                     (3 * p1 - p0 - 3 * p2 + p3) * t * t * t);
    };
    return glm::vec3(value(0) * std::cos(phi), value(0) * std::sin(phi), std::max(value(1), 0.0f));
  });
  smooth(mesh);
  return mesh;
}

}  // namespace

TriangleMesh make_shape(const std::string& name, const std::string& where) {
  if (name == "square") return tiles(0, 1, 1);
  if (name == "even_tiles") return tiles(0, 2, 24);
  if (name == "odd_tiles") return tiles(1, 2, 24);
  if (name == "sphere") return sphere();
  if (name == "preview") return preview();
  throw Error(where + ": found '" + name + "', expected " +
              one_of({"square", "sphere", "even_tiles", "odd_tiles", "preview"}, name));
}

}  // namespace gonio
