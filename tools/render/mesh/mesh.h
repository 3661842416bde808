#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace gonio {

/// Triangles, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit, one per position; empty: flat
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads an OBJ or PLY file, told apart by content; all its meshes together. Polygons are triangulated;
/// points, lines, materials and texture coordinates are left out.
/// @throws Error if it cannot be read, is damaged, or holds no triangle.
TriangleMesh load_mesh(const std::filesystem::path& path);

/// The same from the bytes of a file. @param where name for messages
TriangleMesh read_mesh(std::string_view bytes, const std::string& where);

/// A shape that needs no file:
/// "square": [-1, 1]^2 at z = 0, facing +z; "sphere": radius 1 about the origin;
/// "even_tiles", "odd_tiles": the two halves of a board of 24 x 24 tiles on that square;
/// "preview": an object to judge materials by, 1.8 high, that stands on z = 0: a ball with a dent
/// and a groove on a foot.
/// @throws Error for another name, saying `where`.
TriangleMesh make_shape(const std::string& name, const std::string& where);

/// Positions and normals moved by `matrix`; a mirroring one keeps the outside outside.
void transform(TriangleMesh& mesh, const glm::mat4& matrix);

}  // namespace gonio
