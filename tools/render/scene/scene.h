#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/table/table.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/light/emission.h>

#include "tools/render/image/environment.h"
#include "tools/render/material/sampling_methods.h"
#include "tools/render/material/scatter.h"
#include "tools/render/mesh/mesh.h"

namespace gonio {

/// World space is right-handed; z is up unless the camera says otherwise.

struct Camera {
  glm::vec3 position{0, -5, 1}, target{0, 0, 1}, up{0, 0, 1};
  float vertical_fov = 0.5f;  ///< [rad]
  int width = 512, height = 512;
};

struct Material {
  std::string name;
  std::shared_ptr<const Scatter> bsdf;                  ///< of a measured table: null until build_materials()
  bool two_sided = true;                                ///< the back looks like the front; else it is black
  std::shared_ptr<const BrdfTable> table;               ///< null for materials that have none
  std::optional<LobeModel> model;                       ///< that the table was made of
  bool stack = false;                                   ///< of a stack file, whose diagrams `bsdf` draws by
  SamplingMethod sampling = SamplingMethod::automatic;  ///< of the table
};

struct Object {
  std::shared_ptr<const TriangleMesh> mesh;  ///< in the world
  std::size_t material = 0;
  glm::vec3 emission{0};  ///< radiance of the outside
};

/// A luminaire, far enough to be a point.
struct GoniometricLight {
  glm::vec3 position;
  glm::mat3 to_light;  ///< rotation from the world to the luminaire's frame
  glm::vec3 scale;     ///< radiant intensity [W/sr] for a luminous intensity of 1 cd
  std::shared_ptr<const EmissionSampler<float>> emission;
};

struct Scene {
  Camera camera;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::shared_ptr<const Environment> environment;  ///< null: black
  std::vector<GoniometricLight> lights;
  std::vector<std::filesystem::path> files;  ///< that it was read from
};

/// Makes the samplers of the materials that have tables.
void build_materials(Scene& scene, const Progress& progress = {});

}  // namespace gonio
