#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/emission.h>

namespace gonio {
namespace {

struct Oriented {
  SphereGrid grid;
  Vec3<double> x, y, z;
};

/// The diagram from the pole that it starts at: the nadir, or the zenith if only that half is lit.
Oriented oriented(const LightDiagram& diagram) {
  check(diagram);
  const LightDiagram lit = with_parallel(without_dark_hemisphere(diagram), pi<double> / 2);
  Oriented o;
  o.x = lit.frame.c0, o.y = lit.frame.c90, o.z = lit.frame.nadir;
  o.grid.phi = lit.c;
  o.grid.theta = lit.gamma;
  o.grid.density = lit.cd;
  if (lit.gamma.front() > 0.1) {  // the upper hemisphere alone
    o.z = -o.z;
    const std::size_t n = lit.gamma.size();
    for (std::size_t j = 0; j < n; ++j) o.grid.theta[j] = pi<double> - lit.gamma[n - 1 - j];
    for (std::size_t i = 0; i < lit.c.size(); ++i)
      for (std::size_t j = 0; j < n; ++j) o.grid.density[i * n + j] = lit.at(i, n - 1 - j);
  }
  return o;
}

/// A cumulative table of texels: row by marginal, column by conditional, uniform in solid angle
/// inside.
class TexelTable {
 public:
  TexelTable(const LightDiagram& diagram, int rows, int columns)
      : rows_(rows), columns_(columns), frame_(diagram.frame) {
    double sum = 0;
    for (int j = 0; j < rows; ++j) {
      const double z0 = std::cos(pi<double> * j / rows), z1 = std::cos(pi<double> * (j + 1) / rows);
      double row = 0;
      for (int i = 0; i < columns; ++i) {
        const LightAngles centre{2 * pi<double> * (i + 0.5) / columns, pi<double> * (j + 0.5) / rows};
        const double value = diagram.intensity(centre);
        texel_.push_back(value);
        conditional_.push_back(row += value);
      }
      marginal_.push_back(sum += row * (z0 - z1) * 2 * pi<double> / columns);
    }
    total_ = sum;
  }
  struct Draw {
    LightAngles angles;
    double pdf;
  };
  Draw sample(double u, double v) const {
    const auto row_at = std::upper_bound(marginal_.begin(), marginal_.end() - 1, v * total_);
    const auto j = row_at - marginal_.begin();
    const double below = j > 0 ? marginal_[static_cast<std::size_t>(j - 1)] : 0;
    const double t = std::clamp((v * total_ - below) / (*row_at - below), 0.0, 1.0);
    const auto first = conditional_.begin() + j * columns_;
    const double target = u * first[columns_ - 1];
    const auto column_at = std::upper_bound(first, first + columns_ - 1, target);
    const auto i = column_at - first;
    const double before = i > 0 ? first[i - 1] : 0;
    const double s = std::clamp((target - before) / (*column_at - before), 0.0, 1.0);
    const double z0 = std::cos(pi<double> * double(j) / rows_), z1 = std::cos(pi<double> * double(j + 1) / rows_);
    return {{2 * pi<double> * (double(i) + s) / columns_, std::acos(std::clamp(z0 + t * (z1 - z0), -1.0, 1.0))},
            texel_[static_cast<std::size_t>(j * columns_ + i)] / total_};
  }

 private:
  int rows_, columns_;
  LightFrame frame_;
  std::vector<double> texel_, conditional_, marginal_;
  double total_;
};

template <class Draw>
EmissionQuality measure(std::string id, std::string method, int draws, const Draw& draw) {
  std::mt19937 random(20030625);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> u, v;
  for (int y = 0; y < draws; ++y)
    for (int x = 0; x < draws; ++x) {
      u.push_back((x + uniform(random)) / draws);
      v.push_back((y + uniform(random)) / draws);
    }
  std::vector<double> weight(u.size());
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < u.size(); ++k) weight[k] = draw(u[k], v[k]);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double count = static_cast<double>(u.size());
  double mean = 0, square = 0;
  for (double w : weight) mean += w / count;
  for (double w : weight) square += (w - mean) * (w - mean) / count;
  return {std::move(id), std::move(method), mean, mean > 0 ? square / (mean * mean) : 0, seconds.count() / count * 1e9};
}

}  // namespace

template <class T>
EmissionSampler<T>::EmissionSampler(const LightDiagram& diagram) : map_(oriented(diagram).grid) {
  const Oriented o = oriented(diagram);
  x_ = Vec3<T>(o.x), y_ = Vec3<T>(o.y), z_ = Vec3<T>(o.z);
  flux_ = gonio::flux(diagram);
  mapped_flux_ = 1 / map_.scale();
}

template class EmissionSampler<float>;
template class EmissionSampler<double>;

std::vector<EmissionQuality> emission_quality(const LightDiagram& diagram, int draws) {
  if (draws < 2) throw Error("emission: found " + std::to_string(draws) + " draws a side, expected at least 2");
  const EmissionSampler<float> sampler(diagram);
  const LightDiagram lit = without_dark_hemisphere(diagram);
  const double z_from = std::cos(lit.gamma.front()), z_to = std::cos(lit.gamma.back());
  const double solid_angle = 2 * pi<double> * (z_from - z_to);
  const TexelTable table(diagram, 180, 360);
  return {
      measure("uniform", "uniform over the lit sphere or hemisphere", draws,
              [&](double u, double v) {
                const double gamma = std::acos(std::clamp(z_from + v * (z_to - z_from), -1.0, 1.0));
                return diagram.intensity(LightAngles{2 * pi<double> * u, gamma}) * solid_angle;
              }),
      measure("texels", "cumulative table of 1-degree texels", draws,
              [&](double u, double v) {
                const auto d = table.sample(u, v);
                return d.pdf > 0 ? diagram.intensity(d.angles) / d.pdf : 0.0;
              }),
      measure("r_linear", "goniometric mapping, linear in r", draws,
              [&](double u, double v) {
                const auto s = sampler.sample(static_cast<float>(u), static_cast<float>(v));
                return s.pdf > 0 ? sampler.mapped_flux() : 0.0;
              }),
      measure("gamma_linear", "goniometric mapping, corrected to linear in gamma", draws,
              [&](double u, double v) {
                return double(sampler.sample(static_cast<float>(u), static_cast<float>(v)).weight);
              }),
  };
}

}  // namespace gonio
