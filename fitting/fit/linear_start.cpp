#include <algorithm>
#include <cmath>

#include <gonio/fitting/fit/linear_start.h>

namespace gonio::detail {

// Coordinate descent: each step is exact in one unknown, and with at most a dozen unknowns a few
// hundred sweeps cost nothing.
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::MatrixXd ata = a.transpose() * a;
  const Eigen::VectorXd atb = a.transpose() * b;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(atb.size());
  for (int sweep = 0; sweep < 400; ++sweep) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (!(ata(i, i) > 0)) continue;
      x[i] = std::fmax(0.0, x[i] + (atb[i] - ata.col(i).dot(x)) / ata(i, i));
    }
  }
  return x;
}

namespace {

// The values of the unit lobes: columns of the linear problem, a row per sample.
Eigen::MatrixXd unit_columns(const std::vector<FitSample>& samples, const LobeModel& model, int channel,
                             Eigen::Index columns) {
  Eigen::MatrixXd values(samples.size(), columns);
  for (size_t s = 0; s < samples.size(); ++s) {
    const Angles<double>& angles = samples[s].angles;
    Eigen::Index at = 0;
    for (const Lobe& lobe : model.lobes) {
      const double shape[max_shape] = {lobe.shape[0][channel], lobe.shape[1][channel]};
      const double value =
          angles.cos_o * visit_lobe(lobe.kind, shape, [&](const auto& functor) { return functor.eval(angles); });
      if (lobe.specular()) {
        values(s, at++) = value * schlick(1.0, 0.0, angles.cos_d);
        values(s, at++) = value * schlick(0.0, 1.0, angles.cos_d);
      } else {
        values(s, at++) = value;
      }
    }
  }
  return values;
}

Eigen::VectorXd solve_channel(const std::vector<FitSample>& samples, Compression compression,
                              const Eigen::MatrixXd& columns, int channel) {
  Eigen::VectorXd target(samples.size()), weight(samples.size()), x;
  for (size_t s = 0; s < samples.size(); ++s) target[s] = samples[s].value[channel];
  Eigen::VectorXd model = target;
  for (int round = 0; round < 4; ++round) {
    for (size_t s = 0; s < samples.size(); ++s) {
      const double difference = model[s] - target[s];
      double slope = 0;
      const double compressed = compress(compression, target[s], &slope);
      if (std::fabs(difference) > 1e-6 * (model[s] + target[s]) + 1e-12) {
        slope = (compress(compression, model[s]) - compressed) / difference;
      }
      weight[s] = samples[s].weight * slope;
    }
    x = non_negative_least_squares(weight.asDiagonal() * columns, weight.cwiseProduct(target));
    model = columns * x;
  }
  return x;
}

}  // namespace

void solve_colors(const std::vector<FitSample>& samples, Compression compression, LobeModel& model) {
  Eigen::Index columns = 0;
  for (const Lobe& lobe : model.lobes) columns += lobe.specular() ? 2 : 1;
  const bool separate =
      std::any_of(model.lobes.begin(), model.lobes.end(), [](const Lobe& lobe) { return lobe.separate(); });
  Eigen::MatrixXd values;
  for (int c = 0; c < 3; ++c) {
    if (c == 0 || separate) values = unit_columns(samples, model, c, columns);
    const Eigen::VectorXd x = solve_channel(samples, compression, values, c);
    Eigen::Index at = 0;
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
