#include "tools/convert/scene_manifest.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <set>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using nlohmann::json;

/// Reads members with messages that say where they are.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void fail(const std::string& field, const std::string& found, const std::string& expected) const {
    throw Error(file_ + ": " + field + ": found " + found + ", expected " + expected);
  }

  /// An object with no other members than these.
  void check_members(const json& value, const std::string& field, std::initializer_list<const char*> known) const {
    if (!value.is_object()) fail(field, value.type_name(), "an object");
    for (const auto& [key, ignored] : value.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(field, "an unknown member '" + key + "'", one_of({known.begin(), known.end()}, key));
  }

  const json& member(const json& object, const std::string& field, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end()) fail(field, "none", "a member '" + std::string(name) + "'");
    return *found;
  }

  std::string text(const json& object, const std::string& field, const char* name) const {
    const json& value = member(object, field, name);
    if (!value.is_string() || value.get_ref<const std::string&>().empty())
      fail(field + "." + name, shown(value), "a text");
    return value;
  }

  double non_negative(const json& value, const std::string& field) const {
    if (!value.is_number() || !(value.get<double>() >= 0) || std::isinf(value.get<double>()))
      fail(field, shown(value), "a finite number >= 0");
    return value;
  }

 private:
  std::string file_;
};

/// It becomes the name of a file: on any system, and in the folder it is meant for.
bool is_file_name(const std::string& name) {
  const char* const allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  return name.find_first_not_of(allowed) == std::string::npos && name.front() != '.';
}

std::vector<double> read_incidence(const Reader& reader, const json& material, const std::string& field) {
  const auto found = material.find("incidence");
  if (found == material.end()) return {};
  const std::string here = field + ".incidence";
  if (!found->is_array() || found->empty()) reader.fail(here, shown(*found), "an array of at least one number");
  std::vector<double> shares;
  double sum = 0;
  for (const json& value : *found) {
    shares.push_back(reader.non_negative(value, here + "[" + std::to_string(shares.size()) + "]"));
    sum += shares.back();
  }
  if (!(sum > 0) || std::isinf(sum)) reader.fail(here, "a sum of " + std::to_string(sum), "a finite one above 0");
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace

std::vector<SceneMaterial> load_scene(const std::filesystem::path& path) {
  const Reader reader(path.string());
  const json root = parse_json(read_bytes(path), path.string());
  if (root.is_object() && root.contains("objects") && !root.contains("format"))
    throw Error(path.string() +
                ": found a scene of gonio render (docs/guide/render.md), expected a manifest of gonio convert --scene "
                "(docs/guide/scene.md)");
  reader.check_members(root, "the file", {"format", "version", "materials"});
  if (reader.text(root, "the file", "format") != "gonio scene")
    reader.fail("format", shown(root["format"]), "\"gonio scene\"");
  if (const json& version = reader.member(root, "the file", "version"); version != 1)
    reader.fail("version", shown(version), "1");
  const json& list = reader.member(root, "the file", "materials");
  if (!list.is_array() || list.empty()) reader.fail("materials", list.type_name(), "an array of at least one material");

  std::vector<SceneMaterial> scene;
  std::set<std::string> names;
  double sum = 0;
  for (const json& entry : list) {
    const std::string field = "materials[" + std::to_string(scene.size()) + "]";
    reader.check_members(entry, field, {"name", "file", "share", "incidence"});
    SceneMaterial material;
    material.name = reader.text(entry, field, "name");
    if (!is_file_name(material.name))
      reader.fail(field + ".name", "'" + material.name + "'", "letters, digits, '_', '-' and '.' (not as the first)");
    if (!names.insert(material.name).second)
      reader.fail(field + ".name", "'" + material.name + "' again", "every name once");
    material.file = path.parent_path() / reader.text(entry, field, "file");
    material.share = reader.non_negative(reader.member(entry, field, "share"), field + ".share");
    material.incidence = read_incidence(reader, entry, field);
    sum += material.share;
    scene.push_back(std::move(material));
  }
  if (!(sum > 0) || std::isinf(sum))
    reader.fail("materials: share", "a sum of " + std::to_string(sum), "a finite one above 0");
  for (SceneMaterial& material : scene) material.share /= sum;
  return scene;
}

}  // namespace gonio
