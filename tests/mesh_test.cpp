#include <gonio/tools/render/mesh.h>

#include <gonio/mapping/error.h>
#include <gonio/mapping/hemisphere.h>
#include <gonio/tests/table_files.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace gonio {
namespace {

/// By the divergence theorem; positive if triangles turn counter-clockwise seen from outside.
float volume(const TriangleMesh& mesh) {
  float sum = 0;
  for (const auto& t : mesh.triangles) sum += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6;
  return sum;
}

float area(const TriangleMesh& mesh) {
  float sum = 0;
  for (const auto& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t[0]];
    sum += glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a)) / 2;
  }
  return sum;
}

TEST(Mesh, ShapesHaveTheirSizeAndFaceOutside) {
  EXPECT_NEAR(volume(make_shape("sphere", "")), 4 * pi<float> / 3, 2e-3f);
  EXPECT_NEAR(area(make_shape("square", "")), 4, 1e-5f);
  EXPECT_NEAR(area(make_shape("even_tiles", "")), 2, 1e-4f);
  EXPECT_NEAR(area(make_shape("odd_tiles", "")), 2, 1e-4f);
  const TriangleMesh preview = make_shape("preview", "");
  EXPECT_GT(volume(preview), 1.5f);
  EXPECT_LT(volume(preview), 2.0f);
  float low = 1, high = 0;
  for (const glm::vec3& p : preview.positions) low = std::min(low, p.z), high = std::max(high, p.z);
  EXPECT_NEAR(low, 0, 1e-6f);
  EXPECT_NEAR(high, 1.8f, 1e-3f);
  for (const glm::vec3& n : preview.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5f);
  EXPECT_THROW(make_shape("cube", "here"), Error);
}

TEST(Mesh, AMirrorKeepsTheOutsideOutside) {
  TriangleMesh sphere = make_shape("sphere", "");
  const float before = volume(sphere);
  transform(sphere, glm::scale(glm::mat4(1.0f), glm::vec3(-2, 1, 1)));
  EXPECT_NEAR(volume(sphere), 2 * before, 1e-2f);
  for (std::size_t k = 0; k < sphere.normals.size(); ++k) EXPECT_GT(glm::dot(sphere.normals[k], sphere.positions[k]), 0);
}

TEST(Mesh, SmallUnitsAreKept) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "small.obj", "v 0 0 0\nv 1e-6 0 0\nv 1e-6 1e-6 0\nv 0 1e-6 0\nf 1 2 3\nf 1 3 4\n");
  EXPECT_NEAR(area(load_mesh(folder / "small.obj")), 1e-12f, 1e-17f);
}

TEST(Mesh, FilesWithIndicesOutOfRangeAreRefused) {
  const test::TemporaryFolder folder;
  const auto ply = [](const char* face) {
    return std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n") + face + "\n";
  };
  test::write_file(folder / "good.ply", ply("3 0 1 2"));
  EXPECT_EQ(load_mesh(folder / "good.ply").triangles.size(), 1u);
  for (const char* face : {"3 0 1 -1", "3 0 1 3", "3 0 1 1000000000", "4 0 1 2 -1"}) {
    test::write_file(folder / "bad.ply", ply(face));
    EXPECT_THROW(load_mesh(folder / "bad.ply"), Error) << face;
  }
}

}  // namespace
}  // namespace gonio
