#include <cstdio>
#include <random>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/light/files/text_scanner.h>
#include <gonio/mapping/light/photometry.h>

#include "tools/light/command.h"

namespace gonio {
namespace {

void print_difference(const char* name, const LightDifference& d) {
  std::printf("%-14s rms %.5f  largest %.5f  Hausdorff %.5f  flux %+.3f %%\n", name, d.rms, d.largest, d.hausdorff,
              100 * d.flux);
}

}  // namespace

void light_sample(const CLI::App& verb, const LightCommand& o) {
  const Luminaire light = load(o.in, o);
  if (verb.count("--quality") > 0) {
    std::printf("%-52s %12s %10s %8s\n", "method", ("flux, " + flux_unit(light)).c_str(), "relvar", "ns");
    for (const EmissionQuality& q : emission_quality(light.diagram))
      std::printf("%-52s %12s %10.2e %8.0f\n", q.method.c_str(), format_number(q.flux).c_str(), q.relvar,
                  q.nanoseconds_per_draw);
    std::printf("%-52s %12s\n", "quadrature", format_number(flux(light.diagram)).c_str());
    return;
  }
  const EmissionSampler<float> sampler(light.diagram);
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::printf("x,y,z,pdf,weight\n");
  for (int k = 0; k < o.draws; ++k) {
    const float u = uniform(random), v = uniform(random);
    const auto s = sampler.sample(u, v);
    std::printf("%.8g,%.8g,%.8g,%.8g,%.8g\n", double(s.direction.x), double(s.direction.y), double(s.direction.z),
                double(s.pdf), double(s.weight));
  }
}

void light_compare(const LightCommand& o) {
  std::printf("All but the flux as fractions of the largest intensity of the first.\n");
  if (o.files.size() == 2) {
    const Luminaire a = load(o.files[0], o), b = load(o.files[1], o);
    print_difference("second file",
                     compare(bilinear_reconstruction(a.diagram), bilinear_reconstruction(b.diagram), o.rows));
    return;
  }
  if (o.files.size() != 1) throw Error("found " + std::to_string(o.files.size()) + " files, expected 1 or 2");
  const LightDiagram diagram = load(o.files[0], o).diagram;
  const Reconstruction reference = bilinear_reconstruction(diagram);
  std::printf("Against the bilinear diagram:\n");
  for (const char* name : {"catmull-rom", "mitchell", "bspline", "two-plane"})
    print_difference(name, compare(reference, reconstruction(diagram, name), o.rows));
  if (diagram.gamma.size() < 3 || diagram.gamma.size() % 2 == 0) {
    std::printf("No odd number of gamma angles: every second one cannot be left out.\n");
    return;
  }
  std::printf("Every second angle left out, and predicted from the rest:\n");
  const LightDiagram half = every_second(diagram);
  for (const char* name : {"bilinear", "catmull-rom", "mitchell", "bspline"}) {
    const Reconstruction rebuilt = reconstruction(half, name);
    const Prediction p = predict_left_out(diagram, rebuilt);
    const LightDifference d = compare(reference, rebuilt, o.rows);
    std::printf("%-14s rms %.5f  largest %.5f at %zu angles;  Hausdorff %.5f  flux %+.3f %%\n", name, p.rms, p.largest,
                p.angles, d.hausdorff, 100 * d.flux);
  }
}

}  // namespace gonio
