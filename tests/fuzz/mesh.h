#pragma once

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <gonio/mapping/base/error.h>

#include "tools/render/mesh/mesh.h"

namespace gonio::fuzz {

/// Bytes to a mesh of either format: what loads has triangles, of vertices that there are.
inline void mesh(const std::uint8_t* data, std::size_t size) {
  try {
    const TriangleMesh mesh = read_mesh({reinterpret_cast<const char*>(data), size}, "fuzz");
    if (mesh.triangles.empty() || !(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size())) std::abort();
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle)
        if (v >= mesh.positions.size()) std::abort();
  } catch (const Error&) {
  }
}

}  // namespace gonio::fuzz
