#include "tools/render/scene/read_scene.h"

#include <cmath>
#include <map>
#include <sstream>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/exr/light_exr.h>

#include "tools/cli/input.h"
#include "tools/render/scene/json_fields.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

constexpr float degree = pi<float> / 180;
constexpr double smallest = 1e-9;  // length, and factor of lengths: the cube of such a length is a float still

std::string number(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

class SceneReader {
 public:
  SceneReader(const nlohmann::json& json, const std::string& where, fs::path folder, const CellPolicies& policies)
      : fields_(json, where + ":", {"camera", "environment", "materials", "objects", "lights"}),
        folder_(std::move(folder)),
        policies_(policies) {}

  Scene read() {
    if (fields_.has("camera")) camera();
    if (fields_.has("environment")) environment();
    materials();
    objects();
    if (fields_.has("lights")) lights();
    return std::move(scene_);
  }

 private:
  fs::path file(JsonFields& fields) {
    scene_.files.push_back(folder_ / fields.text("file"));
    return scene_.files.back();
  }

  void camera() {
    JsonFields f = fields_.object("camera", {"position", "target", "up", "vertical_fov", "resolution"});
    Camera& c = scene_.camera;
    c.position = f.triple("position");
    c.target = f.triple("target");
    if (f.has("up")) c.up = f.triple("up");
    if (f.has("vertical_fov")) c.vertical_fov = degree * static_cast<float>(f.number("vertical_fov", 0.01, 179));
    if (f.has("resolution")) {
      const nlohmann::json& r = f.at("resolution");
      const auto side = [](const nlohmann::json& n) {
        return n.is_number_integer() && n.get<double>() >= 1 && n.get<double>() <= 16384;
      };
      if (!r.is_array() || r.size() != 2 || !side(r[0]) || !side(r[1]))
        f.fail("resolution", shown(r), "two whole numbers from 1 to 16384");
      c.width = r[0].get<int>(), c.height = r[1].get<int>();
    }
    if (!(glm::length(glm::cross(c.target - c.position, c.up)) >
          1e-6f * glm::length(c.target - c.position) * glm::length(c.up)))
      f.fail("target", "a view along up, or of no length", "another target, or another up");
  }

  void environment() {
    JsonFields f = fields_.object("environment", {"file", "sky", "constant", "scale", "turn"});
    RgbImage image;
    std::string name = fields_.where("environment");
    const int kinds = f.has("file") + f.has("sky") + f.has("constant");
    if (kinds != 1) f.fail("file", kinds == 0 ? "none" : "another as well", "one of file, sky and constant");
    if (f.has("file")) {
      const fs::path path = file(f);
      image = load_rgb(path);
      name = path.string();
    } else if (f.has("sky")) {
      JsonFields sky = f.object("sky", {"sun", "radius", "radiance"});
      const glm::vec3 sun = sky.triple("sun");
      if (!(glm::length(sun) > 0)) sky.fail("sun", "no direction", "a vector towards the sun");
      const double radius = sky.has("radius") ? sky.number("radius", 0.5, 45) : 2.5;
      const double radiance = sky.has("radiance") ? sky.number("radiance", 0, max_radiance) : 300;
      image = make_sky(glm::normalize(sun), degree * static_cast<float>(radius), static_cast<float>(radiance));
    } else {
      image = {4, 2, std::vector<glm::vec3>(8, f.triple_or_number("constant", 0, max_radiance))};
    }
    const glm::vec3 scale = f.has("scale") ? f.triple_or_number("scale", 0, max_radiance) : glm::vec3(1);
    for (glm::vec3& p : image.pixels) p *= scale;
    const float turn = f.has("turn") ? degree * static_cast<float>(f.number("turn", -360, 360)) : 0;
    scene_.environment = std::make_shared<const Environment>(std::move(image), name, turn);
  }

  void materials() {
    const nlohmann::json& all = fields_.at("materials");
    if (!all.is_object()) fields_.fail("materials", shown(all), "an object");
    for (const auto& [name, value] : all.items()) {
      JsonFields f(value, fields_.where("materials." + name), {"file", "albedo", "sampling", "two_sided"});
      Material m;
      m.name = name;
      if (f.has("albedo") == f.has("file")) f.fail("file", f.has("file") ? "albedo as well" : "none", "file or albedo");
      if (f.has("albedo")) {
        if (f.has("sampling")) f.fail("sampling", "one", "none: a Lambertian is sampled by its cosine");
        m.bsdf = make_scatter(LambertSampler(f.triple_or_number("albedo", 0, 1)));
      } else {
        load(m, f);
      }
      if (f.has("two_sided")) m.two_sided = f.boolean("two_sided");
      index_[name] = scene_.materials.size();
      scene_.materials.push_back(std::move(m));
    }
  }

  void load(Material& m, JsonFields& f) {
    const fs::path path = file(f);
    if (is_exr(path)) {
      if (f.has("sampling")) f.fail("sampling", "one", "none: a stack file is sampled by its stack");
      m.bsdf = make_scatter(load_bsdf(path));
      m.stack = true;
      return;
    }
    const bool model = is_model_file(path);
    if (model) {
      m.model = load_model(path);
      m.sampling = m.model->specular_count() > 0 ? SamplingMethod::lobes1 : SamplingMethod::automatic;
    }
    m.table = std::make_shared<const BrdfTable>(load_input(path, policies_));
    if (f.has("sampling")) {
      const std::string name = f.text("sampling");
      const auto method = parse_sampling_method(name);
      if (!method) f.fail("sampling", "'" + name + "'", one_of(sampling_method_names(), name));
      m.sampling = *method;
      if (!MethodBuilder(m.table, m.model).available(m.sampling))
        f.fail("sampling", name, "a method for a " + m.table->info().format + " file");
    }
  }

  static glm::mat4 placement(JsonFields& f, bool scaled) {
    glm::mat4 m(1.0f);
    if (f.has("translate") && scaled) m = glm::translate(m, f.triple("translate"));
    if (f.has("rotate")) {
      const glm::vec3 angles = f.triple("rotate", -360, 360) * degree;
      m = glm::rotate(m, angles.z, glm::vec3(0, 0, 1));
      m = glm::rotate(m, angles.y, glm::vec3(0, 1, 0));
      m = glm::rotate(m, angles.x, glm::vec3(1, 0, 0));
    }
    if (f.has("scale") && scaled) {
      const glm::vec3 scale = f.triple_or_number("scale");
      for (int c = 0; c < 3; ++c)
        if (std::abs(scale[c]) < static_cast<float>(smallest))
          f.fail("scale", shown(f.at("scale")), "sizes from " + number(smallest));
      m = glm::scale(m, scale);
    }
    return m;
  }

  void objects() {
    const nlohmann::json& all = fields_.at("objects");
    if (!all.is_array() || all.empty()) fields_.fail("objects", shown(all), "an array of objects");
    glm::vec3 low(json_limit), high(-json_limit);
    for (std::size_t k = 0; k < all.size(); ++k) {
      JsonFields f(all[k], fields_.where("objects[" + std::to_string(k) + "]"),
                   {"shape", "file", "material", "scale", "rotate", "translate", "emission"});
      Object object;
      if (f.has("shape") == f.has("file")) f.fail("shape", f.has("shape") ? "file as well" : "none", "shape or file");
      TriangleMesh mesh = f.has("shape") ? make_shape(f.text("shape"), f.where("shape")) : load_mesh(file(f));
      transform(mesh, placement(f, true));
      for (const glm::vec3& p : mesh.positions) {
        for (int c = 0; c < 3; ++c)
          if (!(std::abs(static_cast<double>(p[c])) <= json_limit))
            f.fail(f.has("shape") ? "shape" : "file",
                   "a placed vertex with a coordinate of " + number(static_cast<double>(p[c])),
                   number(-json_limit) + " to " + number(json_limit));
        low = glm::min(low, p), high = glm::max(high, p);
      }
      object.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
      const std::string material = f.text("material");
      const auto found = index_.find(material);
      if (found == index_.end()) {
        std::vector<std::string> names;
        for (const Material& m : scene_.materials) names.push_back(m.name);
        f.fail("material", "'" + material + "'",
               names.empty() ? "a material, of which the scene has none" : one_of(names, material));
      }
      object.material = found->second;
      if (f.has("emission")) object.emission = f.triple_or_number("emission", 0, max_radiance);
      scene_.objects.push_back(std::move(object));
    }
    const double radius = static_cast<double>(glm::length(high - low)) / 2;
    if (!(radius >= smallest))
      fields_.fail("objects", "a scene of radius " + number(radius), "at least " + number(smallest));
  }

  void lights() {
    const nlohmann::json& all = fields_.at("lights");
    if (!all.is_array()) fields_.fail("lights", shown(all), "an array of objects");
    for (std::size_t k = 0; k < all.size(); ++k) {
      JsonFields f(all[k], fields_.where("lights[" + std::to_string(k) + "]"), {"file", "position", "rotate", "scale"});
      GoniometricLight light;
      Problems deviations;
      light.emission = std::make_shared<const EmissionSampler<float>>(load_any_light(file(f), {}, deviations).diagram);
      light.position = f.triple("position");
      light.to_light = glm::transpose(glm::mat3(placement(f, false)));
      light.scale = f.has("scale") ? f.triple_or_number("scale", 0, max_radiance) : glm::vec3(1);
      scene_.lights.push_back(std::move(light));
    }
  }

  JsonFields fields_;
  fs::path folder_;
  const CellPolicies& policies_;
  std::map<std::string, std::size_t> index_;
  Scene scene_;
};

}  // namespace

Scene make_scene(const nlohmann::json& json, const std::string& where, const fs::path& folder,
                 const CellPolicies& policies) {
  return SceneReader(json, where, folder, policies).read();
}

Scene read_scene(const fs::path& path, const CellPolicies& policies) {
  const nlohmann::json json = parse_json(read_bytes(path), path.string());
  if (json.is_object() && json.value("format", nlohmann::json()) == "gonio scene")
    throw Error(path.string() +
                ": found a manifest of gonio convert --scene (docs/guide/scene.md), expected a scene of gonio render "
                "(docs/guide/render.md)");
  Scene scene = make_scene(json, path.string(), path.parent_path(), policies);
  scene.files.push_back(path);
  return scene;
}

}  // namespace gonio
