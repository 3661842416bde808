#include "tools/render/scene/read_scene.h"

namespace gonio {

nlohmann::json default_scene(const std::filesystem::path& material) {
  nlohmann::json scene = nlohmann::json::parse(R"({
    "camera": {"position": [1.0, -6.2, 2.9], "target": [0, 0, 0.86], "vertical_fov": 20, "resolution": [512, 512]},
    "environment": {"sky": {"sun": [-0.75, -0.45, 0.62], "radius": 2.5, "radiance": 520}, "scale": [1.35, 1.28, 1.2]},
    "materials": {
      "light tiles": {"albedo": [0.66, 0.64, 0.61]},
      "dark tiles": {"albedo": [0.24, 0.24, 0.25]},
      "ground": {"albedo": [0.50, 0.49, 0.48]}
    },
    "objects": [
      {"shape": "preview", "material": "subject"},
      {"shape": "even_tiles", "material": "light tiles", "scale": 6},
      {"shape": "odd_tiles", "material": "dark tiles", "scale": 6},
      {"shape": "square", "material": "ground", "scale": 400, "translate": [0, 0, -0.002]}
    ]
  })");
  scene["materials"]["subject"]["file"] = material.string();
  return scene;
}

}  // namespace gonio
