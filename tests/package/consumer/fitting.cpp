// Evaluates a sum of analytic lobes.
#include <gonio/fitting/model/model.h>

int main() {
  const gonio::LobeModel model = gonio::parse_model("ggx:alpha=0.2+lambert:albedo=0.5");
  return model.eval(glm::dvec3(0.6, 0, 0.8), glm::dvec3(0, 0, 1)).y > 0 ? 0 : 1;
}
