#include "tools/render/scene/scene.h"

namespace gonio {

void build_materials(Scene& scene, const Progress& progress) {
  const double count = static_cast<double>(scene.materials.size());
  double before = 0;
  for (Material& material : scene.materials) {
    if (material.table && !material.bsdf) {
      MethodBuilder builder(material.table, material.model);
      material.bsdf = builder.build(material.sampling, [&](double share) {
        if (progress) progress((before + share) / count);
      });
    }
    ++before;
  }
}

}  // namespace gonio
