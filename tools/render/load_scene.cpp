#include "tools/render/load_scene.h"

#include <tuple>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <gonio/mapping/base/error.h>

#include "tools/cli/options.h"
#include "tools/render/scene/read_scene.h"

namespace gonio {

Scene SceneChoice::load() const {
  if (scene.empty() == material.empty())
    throw Error(std::string("SCENE: found ") + (scene.empty() ? "none" : "one and --material") +
                ", expected SCENE.json or --material FILE");
  Scene result =
      scene.empty() ? make_scene(default_scene(material), "default scene", {}, policies) : read_scene(scene, policies);
  if (!size.empty()) {
    std::tie(result.camera.width, result.camera.height) = parse_grid("--size", size);
    if (result.camera.width > 16384 || result.camera.height > 16384)
      throw Error("--size: found " + size + ", expected at most 16384x16384");
  }
  return result;
}

void add_scene_choice(CLI::App& verb, SceneChoice& choice) {
  verb.add_option("SCENE", choice.scene, "Scene file (JSON; docs/guide/render.md)");
  verb.add_option("--material", choice.material, "Table, stack file or model to show on the default scene");
  verb.add_option("--size", choice.size, "Pixels, as 512x512, instead of the scene's");
  add_cell_policies(verb, choice.policies);
}

void add_render_options(CLI::App& verb, RenderOptions& options) {
  verb.add_option("--bounces", options.max_bounces, "Surfaces after the first one, at most")->capture_default_str();
  verb.add_option("--seed", options.seed, "Seed; the same one gives the same picture")->capture_default_str();
  verb.add_option("--threads", options.threads, "Threads, at most one for each core; 0: as many")
      ->capture_default_str();
}

void check_render_options(const RenderOptions& options) {
  if (options.max_bounces < 0)
    throw Error("--bounces: found " + std::to_string(options.max_bounces) + ", expected a number from 0");
  if (options.threads < 0)
    throw Error("--threads: found " + std::to_string(options.threads) + ", expected a number from 0");
}

}  // namespace gonio
