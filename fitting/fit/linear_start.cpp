#include <gonio/fitting/fit/linear_start.h>

#include <algorithm>
#include <cmath>

namespace gonio::detail {

// Coordinate descent: each step is exact in one unknown, and with at most a dozen unknowns a few
// hundred sweeps cost nothing.
std::vector<double> non_negative_least_squares(const std::vector<double>& ata,
                                               const std::vector<double>& atb) {
  const size_t n = atb.size();
  std::vector<double> x(n, 0.0);
  for (int sweep = 0; sweep < 400; ++sweep) {
    for (size_t i = 0; i < n; ++i) {
      const double diagonal = ata[i * n + i];
      if (!(diagonal > 0)) continue;
      double rest = atb[i];
      for (size_t j = 0; j < n; ++j) {
        if (j != i) rest -= ata[i * n + j] * x[j];
      }
      x[i] = std::fmax(0.0, rest / diagonal);
    }
  }
  return x;
}

namespace {

// The values of the unit lobes: columns of the linear problem, [sample][column].
std::vector<double> unit_columns(const std::vector<FitSample>& samples, const LobeModel& model,
                                 int channel, size_t columns) {
  std::vector<double> values;
  values.reserve(samples.size() * columns);
  for (const FitSample& sample : samples) {
    for (const Lobe& lobe : model.lobes) {
      const double shape[max_shape] = {lobe.shape[0][channel], lobe.shape[1][channel]};
      const double value =
          sample.angles.cos_o * visit_lobe(lobe.kind, shape, [&](const auto& functor) {
            return functor.eval(sample.angles);
          });
      if (lobe.specular()) {
        values.push_back(value * schlick(1.0, 0.0, sample.angles.cos_d));
        values.push_back(value * schlick(0.0, 1.0, sample.angles.cos_d));
      } else {
        values.push_back(value);
      }
    }
  }
  return values;
}

std::vector<double> solve_channel(const std::vector<FitSample>& samples, Compression compression,
                                  const std::vector<double>& values, size_t n, int channel) {
  std::vector<double> x;
  for (int round = 0; round < 4; ++round) {
    std::vector<double> ata(n * n, 0.0), atb(n, 0.0);
    for (size_t s = 0; s < samples.size(); ++s) {
      const double* row = &values[s * n];
      const double target = samples[s].value[channel];
      double model = target;
      if (round > 0) {
        model = 0;
        for (size_t i = 0; i < n; ++i) model += row[i] * x[i];
      }
      const double difference = model - target;
      double slope = 0;
      const double compressed = compress(compression, target, &slope);
      if (std::fabs(difference) > 1e-6 * (model + target) + 1e-12) {
        slope = (compress(compression, model) - compressed) / difference;
      }
      const double weight = samples[s].weight * samples[s].weight * slope * slope;
      for (size_t i = 0; i < n; ++i) {
        atb[i] += weight * row[i] * target;
        for (size_t j = 0; j <= i; ++j) ata[i * n + j] += weight * row[i] * row[j];
      }
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = i + 1; j < n; ++j) ata[i * n + j] = ata[j * n + i];
    }
    x = non_negative_least_squares(ata, atb);
  }
  return x;
}

}  // namespace

void solve_colors(const std::vector<FitSample>& samples, Compression compression,
                  LobeModel& model) {
  size_t columns = 0;
  for (const Lobe& lobe : model.lobes) columns += lobe.specular() ? 2 : 1;
  const bool separate = std::any_of(model.lobes.begin(), model.lobes.end(),
                                    [](const Lobe& lobe) { return lobe.separate(); });
  std::vector<double> values;
  for (int c = 0; c < 3; ++c) {
    if (c == 0 || separate) values = unit_columns(samples, model, c, columns);
    const std::vector<double> x = solve_channel(samples, compression, values, columns, c);
    size_t at = 0;
    for (Lobe& lobe : model.lobes) {
      if (lobe.specular() && lobe.fresnel == Fresnel::conductor) {
        const double f0 = std::fmin(std::fmax(x[at], 0.01), 0.98);
        lobe.color[0][c] = 1;
        lobe.color[1][c] = 2 * std::sqrt(f0 / (1 - f0));
        at += 2;
        continue;
      }
      lobe.color[0][c] = x[at++];
      if (lobe.specular()) lobe.color[1][c] = x[at++];
    }
  }
}

}  // namespace gonio::detail
