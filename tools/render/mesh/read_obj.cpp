#include <array>
#include <set>
#include <vector>

#include <gonio/mapping/base/error.h>

#include "tools/render/mesh/read_mesh.h"
#include "tools/render/mesh/triangulate.h"
#include "tools/render/mesh/words.h"

namespace gonio {
namespace {

/// What else the format has (Wavefront, appendix B1): materials, names, texture coordinates, lines, points, curves.
const std::set<std::string_view>& other_keywords() {
  static const std::set<std::string_view> all = {
      "g",      "s",      "o",     "mg",       "p",        "l",    "vp",         "usemtl",    "mtllib",
      "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod",  "shadow_obj", "trace_obj", "ctech",
      "stech",  "cstype", "deg",   "bmat",     "step",     "curv", "curv2",      "surf",      "parm",
      "trim",   "hole",   "scrv",  "sp",       "end",      "con",  "call",       "csh"};
  return all;
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  TriangleMesh read() {
    while (!text_.empty()) statement(next_statement());
    return mesh();
  }

 private:
  struct Corner {
    std::array<std::size_t, 3> index;  // from 1, of position, texture coordinate and normal; 0: none
  };
  struct Face {
    std::size_t line;
    std::vector<Corner> corners;
  };

  [[noreturn]] void fail(std::size_t line, const std::string& found, const std::string& expected) const {
    throw Error(where_ + ": line " + std::to_string(line) + ": found " + found + ", expected " + expected);
  }

  /// A line, with those that it goes on in after a '\'.
  std::string next_statement() {
    std::string all;
    do {
      if (!all.empty()) all.back() = ' ';
      all += next_line(text_);
      ++line_;
    } while (!all.empty() && all.back() == '\\' && !text_.empty());
    return all;
  }

  void statement(std::string_view rest) {
    rest = rest.substr(0, rest.find('#'));
    const std::string_view keyword = next_word(rest);
    if (keyword == "v") {
      positions_.push_back(vector(rest));
    } else if (keyword == "vn") {
      normals_.push_back(vector(rest));
    } else if (keyword == "vt") {
      ++texture_count_;
    } else if (keyword == "f" || keyword == "fo") {
      face(rest);
    } else if (!keyword.empty() && other_keywords().count(keyword) == 0) {
      fail(line_, quoted(keyword), "a statement of an OBJ file, or a PLY file");
    }
  }

  /// Three numbers; what may follow is a weight or a colour.
  glm::vec3 vector(std::string_view rest) const {
    glm::dvec3 v;
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = next_word(rest);
      const auto value = to_number<double>(word);
      if (!value) fail(line_, word.empty() ? "the end of the line" : quoted(word), "three numbers");
      v[c] = *value;
    }
    return glm::vec3(v);
  }

  void face(std::string_view rest) {
    Face face{line_, {}};
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
      face.corners.push_back(corner(word));
    if (face.corners.size() < 3)
      fail(line_, "a face of " + std::to_string(face.corners.size()) + " corners", "at least three");
    faces_.push_back(std::move(face));
  }

  /// "position", "position/texture", "position//normal" or "position/texture/normal"; negative ones count back from
  /// here.
  Corner corner(std::string_view word) const {
    const std::array<std::size_t, 3> count = {positions_.size(), texture_count_, normals_.size()};
    Corner corner{};
    std::string_view rest = word;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t slash = rest.find('/');
      const std::string_view part = rest.substr(0, slash);
      const auto number = to_number<long>(part);
      const long value = number.value_or(0);
      const bool left_out = part.empty() && k == 1;
      if (!left_out && (value == 0 || value < -static_cast<long>(count[k])))
        fail(line_, quoted(word), "a corner of indices from 1, or negative ones that count back");
      corner.index[k] = static_cast<std::size_t>(value < 0 ? static_cast<long>(count[k]) + 1 + value : value);
      if (slash == rest.npos) return corner;
      rest.remove_prefix(slash + 1);
    }
    fail(line_, quoted(word), "a corner of at most three indices");
  }

  /// Now that all points and normals are known. Each corner becomes a vertex of its own.
  TriangleMesh mesh() const {
    bool normals = true;
    const std::array<std::size_t, 3> count = {positions_.size(), texture_count_, normals_.size()};
    const std::array<const char*, 3> name = {"point", "texture coordinate", "normal"};
    for (const Face& face : faces_)
      for (const Corner& corner : face.corners) {
        normals = normals && corner.index[2] != 0;
        for (std::size_t k = 0; k < 3; ++k)
          if (corner.index[k] > count[k])
            fail(face.line, name[k] + (" " + std::to_string(corner.index[k])),
                 "at most " + std::to_string(count[k]) + ", which the file has");
      }
    TriangleMesh mesh;
    for (const Face& face : faces_) {
      std::vector<std::uint32_t> polygon;
      for (const Corner& corner : face.corners) {
        polygon.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(positions_[corner.index[0] - 1]);
        if (normals) mesh.normals.push_back(normals_[corner.index[2] - 1]);
      }
      if (!add_polygon(mesh, std::move(polygon)))
        fail(face.line, "a face of " + std::to_string(face.corners.size()) + " corners that is not convex",
             "at most " + std::to_string(max_corners) + " corners");
    }
    return mesh;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t line_ = 0;
  std::vector<glm::vec3> positions_, normals_;
  std::size_t texture_count_ = 0;
  std::vector<Face> faces_;
};

}  // namespace

TriangleMesh read_obj(std::string_view text, const std::string& where) { return ObjReader(text, where).read(); }

}  // namespace gonio
