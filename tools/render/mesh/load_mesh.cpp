#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

#include "tools/render/mesh/mesh.h"
#include "tools/render/mesh/read_mesh.h"
#include "tools/render/mesh/words.h"

namespace gonio {

TriangleMesh read_mesh(std::string_view bytes, const std::string& where) {
  // Every vertex takes a byte and more: so its index has 32 bits.
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(where + ": found " + std::to_string(bytes.size()) + " bytes, expected at most 4 GiB");
  if (begins_as_utf16(bytes)) throw Error(where + ": found UTF-16, expected PLY or OBJ in ASCII");
  std::string_view rest = bytes;
  const bool ply = !bytes.empty() && next_line(rest) == "ply";
  TriangleMesh mesh = ply ? read_ply(bytes, where) : read_obj(bytes, where);
  if (mesh.triangles.empty()) throw Error(where + ": found no triangle, expected a mesh");
  for (glm::vec3& n : mesh.normals)
    if (const float length = glm::length(n); length > 0) n /= length;
  return mesh;
}

TriangleMesh load_mesh(const std::filesystem::path& path) { return read_mesh(read_bytes(path), path.string()); }

void transform(TriangleMesh& mesh, const glm::mat4& matrix) {
  const glm::mat3 linear(matrix), to_normal = glm::transpose(glm::inverse(linear));
  for (glm::vec3& p : mesh.positions) p = glm::vec3(matrix * glm::vec4(p, 1.0f));
  for (glm::vec3& n : mesh.normals) n = glm::normalize(to_normal * n);
  if (glm::determinant(linear) < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace gonio
