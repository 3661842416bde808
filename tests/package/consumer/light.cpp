// Draws from a luminaire.
#include <gonio/mapping/light/emission.h>

namespace {

gonio::LightDiagram lambertian() {
  gonio::LightDiagram light;
  light.c = {0, gonio::pi<double>, 2 * gonio::pi<double>};
  light.gamma = {0, gonio::pi<double> / 4, gonio::pi<double> / 2};
  for (int i = 0; i < 3; ++i) light.cd.insert(light.cd.end(), {100, 70.7, 0});
  return light;
}

}  // namespace

int main() {
  const gonio::EmissionSampler<float> sampler(lambertian());
  return sampler.sample(0.25f, 0.5f).pdf > 0 ? 0 : 1;
}
