#include "tools/render/mesh/mesh.h"

#include <algorithm>
#include <random>
#include <sstream>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

/// By the divergence theorem; positive if triangles turn counter-clockwise seen from outside.
float volume(const TriangleMesh& mesh) {
  float sum = 0;
  for (const auto& t : mesh.triangles)
    sum += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6;
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
  for (std::size_t k = 0; k < sphere.normals.size(); ++k)
    EXPECT_GT(glm::dot(sphere.normals[k], sphere.positions[k]), 0);
}

TEST(Mesh, ComesFromFilesAlone) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(load_mesh(folder / "none.ply"), Error);
  EXPECT_THROW(load_mesh(folder.path()), Error);
  ASSERT_EQ(mkfifo((folder / "pipe.ply").c_str(), 0600), 0);
  EXPECT_THROW(load_mesh(folder / "pipe.ply"), Error);
}

TEST(Mesh, SmallUnitsAreKept) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "small.obj", "v 0 0 0\nv 1e-6 0 0\nv 1e-6 1e-6 0\nv 0 1e-6 0\nf 1 2 3\nf 1 3 4\n");
  EXPECT_NEAR(area(load_mesh(folder / "small.obj")), 1e-12f, 1e-17f);
}

std::string error_of(const std::string& bytes) {
  try {
    read_mesh(bytes, "m");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

// Two faces of a box's corner, with what a reader has to pass over.
constexpr const char* ply_header =
    "comment a test\nelement vertex 5\nproperty uchar red\nproperty float x\nproperty double y\nproperty short "
    "z\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty list uchar int marks\nelement material 1\nproperty int id\nelement face 2\nproperty "
    "list uchar int vertex_indices\n"
    "property float quality\nend_header\n";

const std::string ascii_ply = std::string("ply\nformat ascii 1.0\n") + ply_header +
                              "1 0 0 0 0 0 2 0\n1 1 0 0 0 0 2 1 7\n1 1 1 0 0 0 2 2 7 8\n1 0 1 0 0 0 2 0\n1 0 1 2 0 0 2 "
                              "0\n12\n4 0 1 2 3 5\n3 0 3 4 5\n";

std::string binary_ply(bool big) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + ply_header;
  const auto add = [&](auto value) {
    std::string stored;
    test::append(stored, value);
    if (big) std::reverse(stored.begin(), stored.end());
    bytes += stored;
  };
  const glm::vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 2}};
  for (std::uint8_t k = 0; k < 5; ++k) {
    add(std::uint8_t(1)), add(points[k].x), add(double(points[k].y)), add(std::int16_t(points[k].z)), add(0.0f),
        add(0.0f), add(2.0f);
    const std::uint8_t marks = k < 3 ? k : 0;
    add(marks);
    for (std::uint8_t j = 0; j < marks; ++j) add(std::int32_t(7 + j));
  }
  add(std::int32_t(12));
  for (const std::vector<std::int32_t>& face :
       {std::vector<std::int32_t>{0, 1, 2, 3}, std::vector<std::int32_t>{0, 3, 4}}) {
    add(std::uint8_t(face.size()));
    for (const std::int32_t v : face) add(v);
    add(5.0f);
  }
  return bytes;
}

TEST(Mesh, PlyInEveryEncoding) {
  const std::string crlf = [] {
    std::string text;
    for (const char c : ascii_ply) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return text;
  }();
  for (const std::string& bytes : {ascii_ply, crlf, binary_ply(false), binary_ply(true)}) {
    const TriangleMesh mesh = read_mesh(bytes, "m");
    ASSERT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.triangles[2], (std::array<std::uint32_t, 3>{0, 3, 4}));
    EXPECT_FLOAT_EQ(area(mesh), 2);
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], glm::vec3(0, 1, 2));
    ASSERT_EQ(mesh.normals.size(), 5u);
    EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1));
  }
}

// Cut anywhere, a PLY is refused: it neither hangs nor ends the program nor loses faces.
TEST(Mesh, APlyThatIsCutOffIsRefused) {
  for (const std::string& bytes : {ascii_ply, binary_ply(false), binary_ply(true)})
    for (std::size_t size = 0; size + 2 < bytes.size(); ++size)
      EXPECT_NE(error_of(bytes.substr(0, size)), "none") << size;
  EXPECT_NE(error_of(binary_ply(false) + "1"), "none");
  EXPECT_NE(error_of(ascii_ply + "3 0 1 2 5\n"), "none");
  EXPECT_EQ(error_of(ascii_ply + "\n\n"), "none");
}

TEST(Mesh, PlyErrorsSayWhatIsWrong) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = ascii_ply;
    return error_of(text.replace(text.find(from), from.size(), to));
  };
  const std::pair<std::string, std::string> cases[] = {
      {error_of("ply\nformat asc"), "m: header: found the end of the file, expected a line end_header"},
      {with("ascii 1.0", "ascii 2.0"),
       "m: format: found 'ascii' '2.0', expected ascii, binary_little_endian or binary_big_endian, and 1.0"},
      {with("format ascii 1.0\n", ""), "m: header: found no format, expected a line format"},
      {with("comment", "remark"),
       "m: header: found 'remark a test', expected format, comment, element, property or end_header"},
      {with("element vertex 5", "element vertex -5"), "m: element 'vertex': found '-5', expected a number of elements"},
      {with("element vertex 5", "element vertex 99999999999999999999"),
       "m: element 'vertex': found '99999999999999999999', expected a number of elements"},
      {with("element vertex 5", "element vertex 9999999999999"),
       "m: element vertex: found 9999999999999 of them and " +
           std::to_string(ascii_ply.size() - ascii_ply.find("1 0 0 0 0 0 2 0")) +
           " bytes, expected as many as the file holds"},
      {with("element face 2", "element face 3"), "m: face 2: found the end of the file, expected 3 of them"},
      {with("element face 2", "element face 1"),
       "m: content: found 11 bytes more, expected the end after what the header counts"},
      {with("element material 1\nproperty int id\n", "element material 9999999999999999999\n"),
       "m: face 0: found the end of the file, expected 2 of them"},
      {with("element face", "element mesh"), "m: header: found no element face, expected one"},
      {with("element material", "element vertex"), "m: element 'vertex': found it twice, expected each once"},
      {with("property float x", "property float y"), "m: property 'y': found it twice, expected each once"},
      {with("property float x", "property float w"), "m: element vertex: found no x, y and z, expected all three"},
      {with("property float x", "property quad x"), "m: property: found the type 'quad', expected char,"},
      {with("list uchar int vertex_indices", "int vertex_indices"),
       "m: element face: found no list vertex_indices, expected one"},
      {with("4 0 1 2 3", "4 0 1 2 5"), "m: face 0: found a vertex 5, expected a whole number from 0 to below 5"},
      {with("4 0 1 2 3", "4 0 1 2 -1"), "m: face 0: found a vertex -1, expected"},
      {with("4 0 1 2 3", "4 0 1 2 nan"), "m: face 0: found a vertex nan"},
      {with("4 0 1 2 3", "4 0 1 2 1.5"), "m: face 0: found a vertex 1.5"},
      {with("4 0 1 2 3", "2 0 1"), "m: face 0: found 2 corners, expected at least three"},
      {with("4 0 1 2 3", "1e9 0 1 2 3"),
       "m: face 0: found a list of length 1000000000, expected a whole number from 0 to below"},
      {with("4 0 1 2 3", "4 0 1 2 x"), "m: face 0: found 'x', expected a number"},
  };
  for (const auto& [found, expected] : cases) EXPECT_EQ(found.find(expected), 0u) << found << "\n" << expected;
}

TEST(Mesh, ObjStatements) {
  const std::string points =
      "# a square\r\nmtllib /dev/zero\no one\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5\nv +0 1e0 0\nvt 0 0\nvn 0 0 3\ng "
      "two\ns 1\n";
  for (const char* faces : {"f 1 2 3 4", "f 1 2 3\nf 1 3 4", "f -4 -3 -2 -1", "f 1/1 2/1 3/1 4/1",
                            "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/-1/-1 4/1/1", "f 1 2 \\\n3 4\n",
                            "l 1 2\np 1\nf 1 2 3 4 # all of it", "f 1 2 3 4\r\nusemtl none\r\n", "\tf\t1 2 3 4"}) {
    const TriangleMesh mesh = read_mesh(points + faces, "m");
    EXPECT_EQ(mesh.triangles.size(), 2u) << faces;
    EXPECT_FLOAT_EQ(area(mesh), 1) << faces;
  }
  EXPECT_EQ(read_mesh(points + "f 1//1 2//1 3//1", "m").normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  EXPECT_TRUE(read_mesh(points + "f 1//1 2//1 3//1\nf 1 3 4", "m").normals.empty());
  EXPECT_FLOAT_EQ(area(read_mesh("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "m")), 0.5f);  // faces first
  const std::pair<std::string, std::string> cases[] = {
      {"f 1 2 5", "m: line 12: found point 5, expected at most 4, which the file has"},
      {"f 1/2 2/1 3/1", "m: line 12: found texture coordinate 2, expected at most 1, which the file has"},
      {"f 1//1 2//1 3//2", "m: line 12: found normal 2, expected at most 1, which the file has"},
      {"f 0 1 2", "m: line 12: found '0', expected a corner of indices from 1"},
      {"f 1 2 -5", "m: line 12: found '-5', expected a corner of indices from 1"},
      {"f 1 2 -9223372036854775808", "m: line 12: found '-9223372036854775808', expected a corner"},
      {"f 1 2 99999999999999999999", "m: line 12: found '99999999999999999999', expected a corner"},
      {"f 1 2 3.0", "m: line 12: found '3.0', expected a corner"},
      {"f 1 2 3/", "none"},
      {"f 1 2 3//", "m: line 12: found '3//', expected a corner"},
      {"f 1/1/1/1 2 3", "m: line 12: found '1/1/1/1', expected a corner of at most three indices"},
      {"f 1 2", "m: line 12: found a face of 2 corners, expected at least three"},
      {"v 1 2", "m: line 12: found the end of the line, expected three numbers"},
      {"v 1 2 x", "m: line 12: found 'x', expected three numbers"},
      {"face 1 2 3", "m: line 12: found 'face', expected a statement of an OBJ file, or a PLY file"},
      {"", "m: found no triangle, expected a mesh"},
  };
  for (const auto& [statement, expected] : cases)
    EXPECT_EQ(error_of(points + statement).find(expected), 0u) << error_of(points + statement) << "\n" << expected;
  EXPECT_EQ(error_of("solid stl\n").find("m: line 1: found 'solid'"), 0u);
  EXPECT_NE(error_of(""), "none");
}

/// A polygon as an OBJ, scaled, turned and tilted.
TriangleMesh polygon(const std::vector<glm::vec2>& points, float scale) {
  std::ostringstream text;
  text.precision(9);
  for (const glm::vec2& p : points)
    text << "v " << scale * (0.3f * p.x - 0.8f * p.y) << ' ' << scale * (0.9f * p.x + 0.1f * p.y) << ' '
         << scale * (p.x - p.y) << '\n';
  text << 'f';
  for (std::size_t k = 1; k <= points.size(); ++k) text << ' ' << k;
  return read_mesh(text.str(), "m");
}

/// Twice the sum of the triangles' areas as vectors: of the polygon, whatever the triangles.
glm::dvec3 vector_area(const TriangleMesh& mesh) {
  glm::dvec3 sum(0);
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[t[0]];
    sum += glm::cross(glm::dvec3(mesh.positions[t[1]]) - a, glm::dvec3(mesh.positions[t[2]]) - a);
  }
  return sum;
}

// Triangles that overlapped or lay outside would have more area than the polygon.
TEST(Mesh, PolygonsAreCoveredOnce) {
  std::vector<std::vector<glm::vec2>> polygons = {
      {{0, 0}, {2, 0}, {2, 2}, {1, 0.5f}, {0, 2}},                                                // a notch
      {{0, 0}, {1, 0.5f}, {2, 0}, {1, 2}},                                                        // an arrow head
      {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1.5f}, {0.5f, 1.5f}},  // inwards
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {2, 0.5f}, {1, 1}, {0, 1}},                        // corners on a line
  };
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> radius(0.1f, 1);
  for (const int size : {5, 20, 200, 2000}) {
    polygons.emplace_back();
    for (int k = 0; k < size; ++k) {
      const float phi = 2 * pi<float> * static_cast<float>(k) / static_cast<float>(size);
      polygons.back().push_back(radius(engine) * glm::vec2(std::cos(phi), std::sin(phi)));
    }
  }
  for (const std::vector<glm::vec2>& points : polygons)
    for (const bool reversed : {false, true})
      for (const float scale : {1e-6f, 1.0f, 1e6f}) {
        std::vector<glm::vec2> order = points;
        if (reversed) std::reverse(order.begin(), order.end());
        const TriangleMesh mesh = polygon(order, scale);
        EXPECT_EQ(mesh.triangles.size(), points.size() - 2);
        const double expected = glm::length(vector_area(mesh)) / 2;
        EXPECT_GT(expected, 0.1 * static_cast<double>(scale) * static_cast<double>(scale));
        EXPECT_NEAR(static_cast<double>(area(mesh)), expected, 1e-4 * expected) << points.size() << " " << scale;
      }
}

TEST(Mesh, PolygonsThatCrossThemselvesKeepTheirTriangles) {
  EXPECT_EQ(polygon({{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 3}}, 1).triangles.size(), 3u);
  EXPECT_EQ(polygon(std::vector<glm::vec2>(7, glm::vec2(1)), 1).triangles.size(), 5u);
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> anywhere;
  std::vector<glm::vec2> points;
  for (int k = 0; k < 300; ++k) points.emplace_back(anywhere(engine), anywhere(engine));
  EXPECT_EQ(polygon(points, 1).triangles.size(), 298u);
}

TEST(Mesh, CornersOfAPolygonHaveALimitUnlessItIsConvex) {
  std::vector<glm::vec2> circle;
  for (int k = 0; k < 10000; ++k) {
    const float phi = 2 * pi<float> * static_cast<float>(k) / 10000;
    circle.emplace_back(1000 * std::cos(phi), 1000 * std::sin(phi));
  }
  circle.resize(5000);
  circle[100] = glm::vec2(0);
  EXPECT_THROW(polygon(circle, 1), Error);
  circle.resize(4096);
  EXPECT_EQ(polygon(circle, 1).triangles.size(), 4094u);
}

}  // namespace
}  // namespace gonio
