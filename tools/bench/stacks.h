#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio::bench {

/// A lobe about the mirror direction over a diffuse base, on even lines: the same cost as a fitted diagram of its size.
inline DiagramGrid lobe_diagram(double theta_i, int meridians, int parallels) {
  DiagramGrid d;
  for (int i = 0; i < meridians; ++i) d.phi.push_back(pi<double> * i / (meridians - 1));
  for (int j = 0; j < parallels; ++j) d.r.push_back(static_cast<double>(j) / (parallels - 1));
  const double mirror = theta_to_radius(theta_i);
  for (const double phi : d.phi)
    for (const double r : d.r) {
      const double x = r * std::cos(phi) + mirror, y = r * std::sin(phi);
      d.density.push_back(0.05 * (1 - r * r) + 1e-4 + std::exp(-(x * x + y * y) / 0.02));
    }
  return d;
}

inline StackGrid lobe_stack(int angles, int meridians, int parallels, Chart chart) {
  StackGrid grid;
  grid.chart = chart;
  for (int k = 0; k < angles; ++k) {
    const double theta_i = angles == 1 ? 0.5 : 1.5 * k / (angles - 1);
    grid.theta_i.push_back(theta_i);
    grid.diagrams.push_back(lobe_diagram(chart == Chart::half ? 0 : theta_i, meridians, parallels));
  }
  return grid;
}

/// What a stack is asked: uniform numbers and incident angles, and the directions that they are mapped to.
struct Queries {
  std::vector<float> theta_i, u, v, x, y, z, pdf;

  Queries(const Stack<float>& stack, std::size_t count) {
    proof::Random random(1);
    for (std::size_t k = 0; k < count; ++k) {
      theta_i.push_back(1.48f * random());
      u.push_back(random());
      v.push_back(random());
      const auto s = stack.sample(theta_i[k], u[k], v[k]);
      x.push_back(s.wo.x), y.push_back(s.wo.y), z.push_back(s.wo.z), pdf.push_back(s.pdf);
    }
  }
  Vec3<float> wo(std::size_t k) const { return {x[k], y[k], z[k]}; }
};

/// The Halton sequence in a base: the paper's uniform numbers.
inline float halton(std::uint32_t index, std::uint32_t base) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) value += (index % base) * (digit /= base);
  return static_cast<float>(value);
}

}  // namespace gonio::bench
