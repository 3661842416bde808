#pragma once

#include <cstdint>
#include <vector>

#include "tools/render/mesh/mesh.h"

namespace gonio {

/// Corners of a polygon that is not convex, at most: the time grows with the square of them, or faster.
inline constexpr std::size_t max_corners = 4096;

/// Adds a polygon to mesh.triangles as corners.size() - 2 triangles with the same turn: a fan if it is convex,
/// else by cutting ears. One that crosses itself is covered somehow.
/// @param corners at least 3, indices into mesh.positions
/// @return false, and adds none, if it is not convex and has more than max_corners.
bool add_polygon(TriangleMesh& mesh, std::vector<std::uint32_t> corners);

}  // namespace gonio
