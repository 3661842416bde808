#include <gonio/tools/render/mesh.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include <gonio/mapping/error.h>

namespace gonio {
namespace {

glm::vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& path) {
  Assimp::Importer importer;
  // Validated, since the other steps trust indices. Points and lines are sorted out into meshes of their own.
  // Vertices are not joined: Assimp would join those that are nearer than 1e-5, whatever the unit.
  const aiScene* scene = importer.ReadFile(
      path.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
  if (!scene) throw Error(path.string() + ": cannot be read as a mesh: " + importer.GetErrorString());
  TriangleMesh result;
  bool normals = true;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) normals = normals && scene->mMeshes[m]->HasNormals();
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (!(mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) continue;
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      result.positions.push_back(to_vec3(mesh.mVertices[v]));
      if (normals) {
        const glm::vec3 n = to_vec3(mesh.mNormals[v]);
        const float length = glm::length(n);
        result.normals.push_back(length > 0 ? n / length : n);
      }
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned* index = mesh.mFaces[f].mIndices;
      result.triangles.push_back({first + index[0], first + index[1], first + index[2]});
    }
  }
  if (result.triangles.empty()) throw Error(path.string() + ": found no triangle, expected a mesh");
  return result;
}

void transform(TriangleMesh& mesh, const glm::mat4& matrix) {
  const glm::mat3 linear(matrix), to_normal = glm::transpose(glm::inverse(linear));
  for (glm::vec3& p : mesh.positions) p = glm::vec3(matrix * glm::vec4(p, 1.0f));
  for (glm::vec3& n : mesh.normals) n = glm::normalize(to_normal * n);
  if (glm::determinant(linear) < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace gonio
