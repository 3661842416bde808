#pragma once

#include <string>
#include <string_view>

#include "tools/render/mesh/mesh.h"

namespace gonio {

/// The polygons of an OBJ file (Wavefront, appendix B1), triangulated; materials, names, texture coordinates,
/// points, lines and curves are left out. Normals are as stored, and none unless every face has them.
/// @throws Error naming the line for what is not of the format, or an index that stands for nothing.
TriangleMesh read_obj(std::string_view text, const std::string& where);

/// The faces of a PLY file (version 1.0; ASCII or binary of either order), triangulated; other elements and
/// properties are left out. Normals are as stored.
/// @throws Error for what is not of the format, is not there to its end, or is more than its header says,
/// and for an index that stands for nothing.
TriangleMesh read_ply(std::string_view bytes, const std::string& where);

}  // namespace gonio
