// A BSDF of one diagram and one colour.
#include <gonio/brdf/bsdf/bsdf.h>

int main() {
  gonio::BsdfData data;
  data.diagrams.theta_i = {0};
  data.diagrams.diagrams.resize(1);
  gonio::DiagramGrid& diagram = data.diagrams.diagrams.front();
  diagram.phi = {0, gonio::pi<double>};
  diagram.r = {0, 1};
  diagram.density = {1, 0, 1, 0};
  data.colour = gonio::Colour({0.0f}, 2, {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}});
  const gonio::Bsdf bsdf(data);
  const auto s = bsdf.sample({0, 0, 1}, {0.25f, 0.5f});
  return s && s->wo.z > 0 && s->pdf > 0 ? 0 : 1;
}
