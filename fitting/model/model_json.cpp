#include <algorithm>
#include <sstream>

#include <gonio/fitting/model/model_json.h>
#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

using nlohmann::json;
using nlohmann::ordered_json;

namespace detail {
namespace {

ordered_json parameter_json(const Parameter& parameter, const glm::dvec3& value) {
  ordered_json j;
  if (value.r == value.g && value.r == value.b) {
    j["value"] = value.r;
  } else {
    j["value"] = {value.r, value.g, value.b};
  }
  j["unit"] = parameter.unit;
  return j;
}

}  // namespace

ordered_json model_json(const LobeModel& model) {
  ordered_json j;
  j["format"] = "gonio model";
  j["version"] = 1;
  j["name"] = model.name;
  j["conventions"] = {
      {"f_r", "1/sr, sum of the lobes, without the cosine; reciprocal"},
      {"values", "one number for all channels, or [red, green, blue], linear Rec. 709"},
      {"diffuse", "albedo x lobe"},
      {"schlick", "(F0 + (F90 - F0) (1 - wi.h)^5) x lobe"},
      {"conductor", "exact Fresnel reflectance of eta + i k x lobe"},
      {"alpha", "width of the slope distribution, not its square root (perceptual roughness)"},
  };
  j["description"] = describe(model);
  j["lobes"] = ordered_json::array();
  for (const Lobe& lobe : model.lobes) {
    const LobeInfo& info = lobe_info(lobe.kind);
    ordered_json entry;
    entry["lobe"] = info.id;
    entry["source"] = info.source;
    if (lobe.specular()) entry["fresnel"] = lobe.fresnel == Fresnel::schlick ? "schlick" : "conductor";
    ordered_json parameters;
    for (size_t i = 0; i < info.shape.size(); ++i) {
      parameters[info.shape[i].name] = parameter_json(info.shape[i], lobe.shape[i]);
    }
    const std::vector<Parameter>& colors = color_parameters(lobe.kind, lobe.fresnel);
    for (size_t i = 0; i < colors.size(); ++i) {
      parameters[colors[i].name] = parameter_json(colors[i], lobe.color[i]);
    }
    entry["parameters"] = parameters;
    j["lobes"].push_back(entry);
  }
  ordered_json snippets = ordered_json::object();
  if (const std::string pbrt = pbrt_snippet(model); !pbrt.empty()) snippets["pbrt-v4"] = pbrt;
  if (const std::string mitsuba = mitsuba_snippet(model); !mitsuba.empty()) snippets["mitsuba3"] = mitsuba;
  if (!snippets.empty()) j["snippets"] = snippets;
  return j;
}

}  // namespace detail

std::string to_json(const LobeModel& model) { return detail::model_json(model).dump(2) + "\n"; }

namespace {

// Reads members with messages that say where they are.
class Reader {
 public:
  explicit Reader(std::string where) : where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& message) const { throw Error(where_ + ": " + message); }

  const json& member(const json& object, const std::string& path, const char* name) const {
    if (!object.is_object() || !object.contains(name)) fail(path + " has no member '" + name + "'");
    return object[name];
  }

  std::string text(const json& object, const std::string& path, const char* name) const {
    const json& value = member(object, path, name);
    if (!value.is_string()) fail(path + "." + name + " is " + value.type_name() + "; expected a string");
    return value;
  }

  glm::dvec3 parameter(const json& parameters, const std::string& path, const Parameter& parameter) const {
    const std::string here = path + "." + parameter.name;
    const json& value = member(member(parameters, path, parameter.name), here, "value");
    glm::dvec3 result;
    if (value.is_number()) {
      result = glm::dvec3(value.get<double>());
    } else if (value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() &&
               value[2].is_number()) {
      result = {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    } else {
      fail(here + ".value is " + shown(value) + "; expected a number or [red, green, blue]");
    }
    for (int c = 0; c < 3; ++c) {
      if (!(result[c] >= parameter.min && result[c] <= parameter.max)) {
        std::ostringstream message;
        message << here << ".value is " << result[c] << "; expected " << parameter.min << " to " << parameter.max;
        fail(message.str());
      }
    }
    return result;
  }

 private:
  std::string where_;
};

}  // namespace

LobeModel model_from_json(std::string_view text, const std::string& where) {
  const Reader reader(where);
  const json root = parse_json(text, where);
  if (reader.text(root, "the file", "format") != "gonio model") {
    reader.fail("format is " + shown(root["format"]) + "; expected \"gonio model\"");
  }
  if (root.contains("version") && root["version"] != 1)
    reader.fail("version is " + root["version"].dump() + "; expected 1");
  LobeModel model;
  model.name = reader.text(root, "the file", "name");
  const json& lobes = reader.member(root, "the file", "lobes");
  if (!lobes.is_array() || lobes.empty()) reader.fail("lobes is not an array of at least one lobe");
  for (size_t l = 0; l < lobes.size(); ++l) {
    const std::string path = "lobes[" + std::to_string(l) + "]";
    const std::string id = reader.text(lobes[l], path, "lobe");
    Lobe lobe;
    std::vector<std::string> known;
    for (LobeKind kind : lobe_kinds()) {
      if (id == lobe_info(kind).id) lobe.kind = kind;
      known.push_back(lobe_info(kind).id);
    }
    if (std::find(known.begin(), known.end(), id) == known.end())
      reader.fail(path + ".lobe is '" + id + "'; expected " + one_of(known, id));
    if (lobe.specular()) {
      const std::string fresnel = reader.text(lobes[l], path, "fresnel");
      if (fresnel != "schlick" && fresnel != "conductor") {
        reader.fail(path + ".fresnel is '" + fresnel + "'; expected schlick or conductor");
      }
      if (fresnel == "conductor") lobe.fresnel = Fresnel::conductor;
    }
    const json& parameters = reader.member(lobes[l], path, "parameters");
    const std::vector<Parameter>& shape = lobe_info(lobe.kind).shape;
    for (size_t i = 0; i < shape.size(); ++i) {
      lobe.shape[i] = reader.parameter(parameters, path + ".parameters", shape[i]);
    }
    const std::vector<Parameter>& colors = color_parameters(lobe.kind, lobe.fresnel);
    for (size_t i = 0; i < colors.size(); ++i) {
      lobe.color[i] = reader.parameter(parameters, path + ".parameters", colors[i]);
    }
    model.lobes.push_back(lobe);
  }
  return model;
}

LobeModel load_model(const std::filesystem::path& path) { return model_from_json(read_bytes(path), path.string()); }

}  // namespace gonio
