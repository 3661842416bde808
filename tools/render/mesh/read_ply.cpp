#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include <gonio/mapping/base/error.h>

#include "tools/cli/number.h"
#include "tools/render/mesh/read_mesh.h"
#include "tools/render/mesh/triangulate.h"
#include "tools/render/mesh/words.h"

namespace gonio {
namespace {

struct Type {
  const char *name, *other_name;
  std::size_t size;
  double (*value)(const char* bytes);  // of little-endian bytes
};

template <class T>
double value_of(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

constexpr Type types[] = {
    {"char", "int8", 1, value_of<std::int8_t>},    {"uchar", "uint8", 1, value_of<std::uint8_t>},
    {"short", "int16", 2, value_of<std::int16_t>}, {"ushort", "uint16", 2, value_of<std::uint16_t>},
    {"int", "int32", 4, value_of<std::int32_t>},   {"uint", "uint32", 4, value_of<std::uint32_t>},
    {"float", "float32", 4, value_of<float>},      {"double", "float64", 8, value_of<double>},
};

struct Property {
  std::string name;
  const Type* type;
  const Type* count_type;  // of a list, else null
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& where) : rest_(bytes), where_(where) {}

  TriangleMesh read() {
    header();
    for (const Element& element : elements_) {
      // Every value takes a byte, so that no count keeps anyone busy whose values are not there.
      if (element.properties.empty()) continue;
      if (element.count > rest_.size() / element.properties.size())
        fail("element " + element.name,
             std::to_string(element.count) + " of them and " + std::to_string(rest_.size()) + " bytes",
             "as many as the file holds");
      if (element.name == "vertex") {
        vertices(element);
      } else if (element.name == "face") {
        faces(element);
      } else {
        for (std::size_t k = 0; k < element.count; ++k) next(element, k);
      }
    }
    if (std::string_view rest = rest_; !next_word(rest).empty())
      fail("content", std::to_string(rest_.size()) + " bytes more", "the end after what the header counts");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& field, const std::string& found, const std::string& expected) const {
    throw Error(where_ + ": " + field + ": found " + found + ", expected " + expected);
  }

  void header() {
    bool format = false;
    next_line(rest_);  // "ply"
    for (;;) {
      if (rest_.find('\n') == rest_.npos) fail("header", "the end of the file", "a line end_header");
      const std::string_view line = next_line(rest_);
      std::string_view words = line;
      const std::string_view keyword = next_word(words);
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        format = set_format(words);
      } else if (keyword == "element") {
        add_element(words);
      } else if (keyword == "property" && !elements_.empty()) {
        add_property(words);
      } else {
        fail("header", quoted(line), "format, comment, element, property or end_header");
      }
      if (!next_word(words).empty()) fail("header", quoted(line), "a line that ends before");
    }
    if (!format) fail("header", "no format", "a line format");
    for (const char* name : {"vertex", "face"})
      if (std::none_of(elements_.begin(), elements_.end(), [&](const Element& e) { return e.name == name; }))
        fail("header", std::string("no element ") + name, "one");
  }

  bool set_format(std::string_view& words) {
    const std::string_view name = next_word(words), version = next_word(words);
    binary_ = name != "ascii";
    swapped_ = name == "binary_big_endian";
    if ((binary_ && !swapped_ && name != "binary_little_endian") || version != "1.0")
      fail("format", quoted(name) + " " + quoted(version), "ascii, binary_little_endian or binary_big_endian, and 1.0");
    return true;
  }

  void add_element(std::string_view& words) {
    const std::string_view name = next_word(words), text = next_word(words);
    const auto count = to_number<std::size_t>(text);
    if (!count) fail("element " + quoted(name), quoted(text), "a number of elements");
    for (const Element& other : elements_)
      if (other.name == name) fail("element " + quoted(name), "it twice", "each once");
    elements_.push_back({std::string(name), *count, {}});
  }

  const Type* type_of(std::string_view name) const {
    for (const Type& type : types)
      if (name == type.name || name == type.other_name) return &type;
    fail("property", "the type " + quoted(name), "char, uchar, short, ushort, int, uint, float or double");
  }

  void add_property(std::string_view& words) {
    std::string_view first = next_word(words);
    const Type* count_type = nullptr;
    if (first == "list") {
      count_type = type_of(next_word(words));
      first = next_word(words);
    }
    const Type* type = type_of(first);
    const std::string_view name = next_word(words);
    if (name.empty()) fail("property", "no name", "one");
    std::vector<Property>& all = elements_.back().properties;
    for (const Property& other : all)
      if (other.name == name) fail("property " + quoted(name), "it twice", "each once");
    all.push_back({std::string(name), type, count_type});
  }

  double number(const Type& type, const Element& element, std::size_t k) {
    const auto here = [&] { return element.name + " " + std::to_string(k); };
    const auto fail_at_end = [&] { fail(here(), "the end of the file", std::to_string(element.count) + " of them"); };
    if (binary_) {
      if (rest_.size() < type.size) fail_at_end();
      char bytes[8];
      std::copy_n(rest_.begin(), type.size, bytes);
      if (swapped_) std::reverse(bytes, bytes + type.size);
      rest_.remove_prefix(type.size);
      return type.value(bytes);
    }
    const std::string_view word = next_word(rest_);
    if (word.empty()) fail_at_end();
    const auto value = to_number<double>(word);
    if (!value) fail(here(), quoted(word), "a number");
    return *value;
  }

  /// A number that has to be a whole one, from 0 to below `limit`.
  std::size_t whole(double value, std::size_t limit, const Element& element, std::size_t k,
                    const std::string& what) const {
    if (!(value >= 0 && value < static_cast<double>(limit) && value == std::floor(value)))
      fail(element.name + " " + std::to_string(k), what + " " + gonio::number(value, 10),
           "a whole number from 0 to below " + std::to_string(limit));
    return static_cast<std::size_t>(value);
  }

  /// The values of the k-th of these elements, to row_.
  void next(const Element& element, std::size_t k) {
    row_.resize(element.properties.size());
    for (std::size_t p = 0; p < row_.size(); ++p) {
      const Property& property = element.properties[p];
      row_[p].clear();
      std::size_t count = 1;
      if (property.count_type)
        count = whole(number(*property.count_type, element, k), rest_.size() + 1, element, k, "a list of length");
      for (std::size_t j = 0; j < count; ++j) row_[p].push_back(number(*property.type, element, k));
    }
  }

  /// The index of a property; none if there is none of that name.
  static std::optional<std::size_t> find(const Element& element, const char* name) {
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (element.properties[p].name == name) return p;
    return std::nullopt;
  }

  /// The properties of these names, single numbers, or none if any of them is missing.
  std::optional<std::array<std::size_t, 3>> find_three(const Element& element,
                                                       const std::array<const char*, 3>& names) const {
    std::array<std::size_t, 3> all{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto found = find(element, names[c]);
      if (!found) return std::nullopt;
      if (element.properties[*found].count_type)
        fail("element " + element.name, std::string("a list ") + names[c], "one number");
      all[c] = *found;
    }
    return all;
  }

  glm::vec3 vector(const std::array<std::size_t, 3>& p) const {
    return glm::vec3(glm::dvec3(row_[p[0]][0], row_[p[1]][0], row_[p[2]][0]));
  }

  void vertices(const Element& element) {
    const auto position = find_three(element, {"x", "y", "z"}), normal = find_three(element, {"nx", "ny", "nz"});
    if (!position) fail("element vertex", "no x, y and z", "all three");
    for (std::size_t k = 0; k < element.count; ++k) {
      next(element, k);
      mesh_.positions.push_back(vector(*position));
      if (normal) mesh_.normals.push_back(vector(*normal));
    }
  }

  void faces(const Element& element) {
    auto corners = find(element, "vertex_indices");
    if (!corners) corners = find(element, "vertex_index");
    if (!corners || !element.properties[*corners].count_type) fail("element face", "no list vertex_indices", "one");
    for (std::size_t k = 0; k < element.count; ++k) {
      next(element, k);
      std::vector<std::uint32_t> polygon;
      for (const double value : row_[*corners])
        polygon.push_back(static_cast<std::uint32_t>(whole(value, mesh_.positions.size(), element, k, "a vertex")));
      const std::string here = "face " + std::to_string(k), size = std::to_string(polygon.size()) + " corners";
      if (polygon.size() < 3) fail(here, size, "at least three");
      if (!add_polygon(mesh_, std::move(polygon)))
        fail(here, size + ", not convex", "at most " + std::to_string(max_corners));
    }
  }

  std::string_view rest_;
  const std::string& where_;
  bool binary_ = false, swapped_ = false;
  std::vector<Element> elements_;
  std::vector<std::vector<double>> row_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& where) { return PlyReader(bytes, where).read(); }

}  // namespace gonio
