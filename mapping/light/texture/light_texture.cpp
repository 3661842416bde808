#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/texture/light_texture.h>

namespace gonio {
namespace {

constexpr double tau = 2 * pi<double>;

/// The number of even cells over `range` that has all `lines` among its own lines; at most `most`.
int even_cells(const std::vector<double>& lines, double range, int most, int multiple) {
  for (int n = multiple; n < most; n += multiple) {
    const bool all = std::all_of(lines.begin(), lines.end(), [&](double line) {
      const double position = (line - lines.front()) / range * n;
      return std::abs(position - std::round(position)) < 1e-6 * n;
    });
    if (all) return n;
  }
  return most;
}

/// Texels of the whole texture by row (meridian) and column (parallel), continued beyond the ends.
class Continued {
 public:
  Continued(int n, int m, bool pole_first, bool pole_last)
      : n_(n), m_(m), pole_first_(pole_first), pole_last_(pole_last) {}

  std::size_t index(int i, int j) const {
    while (j < 0 || j >= n_) {
      const bool first = j < 0;
      j = first ? -j : 2 * (n_ - 1) - j;
      if (first ? pole_first_ : pole_last_) i += m_ / 2;
    }
    return static_cast<std::size_t>(((i % m_) + m_) % m_ * n_ + j);
  }

 private:
  int n_, m_;
  bool pole_first_, pole_last_;
};

/// Coefficients of the cubic B-spline that interpolates `values`: the inverse of the filter (1 4
/// 1)/6 along both axes, h_k = -6 z / (1 - z^2) z^|k| with z = sqrt(3) - 2, cut where it is below
/// rounding.
std::vector<double> bspline_coefficients(const std::vector<double>& values, int n, int m, const Continued& at) {
  constexpr int reach = 28;
  const double z = std::sqrt(3.0) - 2;
  std::array<double, reach + 1> h;
  h[0] = -6 * z / (1 - z * z);
  for (std::size_t k = 1; k <= reach; ++k) h[k] = h[k - 1] * z;
  const auto filtered = [&](const std::vector<double>& from, bool along_c) {
    std::vector<double> to(from.size());
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < n; ++j) {
        double sum = h[0] * from[at.index(i, j)];
        for (int k = 1; k <= reach; ++k)
          sum += h[static_cast<std::size_t>(k)] * (along_c ? from[at.index(i + k, j)] + from[at.index(i - k, j)]
                                                           : from[at.index(i, j + k)] + from[at.index(i, j - k)]);
        to[at.index(i, j)] = sum;
      }
    return to;
  };
  return filtered(m > 1 ? filtered(values, true) : values, false);
}

}  // namespace

std::array<float, 4> filter_weights(LightFilter filter, float t) noexcept {
  const float s = 1 - t;
  switch (filter) {
    case LightFilter::bilinear:
      return {0, s, t, 0};
    case LightFilter::catmull_rom:
      return {-0.5f * t * s * s, 1 + t * t * (1.5f * t - 2.5f), 1 + s * s * (1.5f * s - 2.5f), -0.5f * s * t * t};
    case LightFilter::bspline:
      return {s * s * s / 6, (4 + 3 * t * t * (t - 2)) / 6, (4 + 3 * s * s * (s - 2)) / 6, t * t * t / 6};
    case LightFilter::mitchell:
      break;
  }
  // B = C = 1/3: a third of the B-spline and two thirds of Catmull-Rom.
  const auto a = filter_weights(LightFilter::bspline, t), b = filter_weights(LightFilter::catmull_rom, t);
  std::array<float, 4> w;
  for (std::size_t k = 0; k < 4; ++k) w[k] = (a[k] + 2 * b[k]) / 3;
  return w;
}

LightTexture::LightTexture(const LightDiagram& diagram, LightFilter filter, int most_cells) : filter_(filter) {
  check(diagram);
  const LightDiagram d = without_dark_hemisphere(diagram);
  max_cd_ = gonio::max_intensity(d);
  if (!(max_cd_ > 0)) throw Error("light texture: found a diagram that is dark everywhere, expected some light");
  frame_ = d.frame;
  nadir_ = Vec3<float>(frame_.nadir), c0_ = Vec3<float>(frame_.c0), c90_ = Vec3<float>(frame_.c90);

  const double range = d.gamma.back() - d.gamma.front();
  const bool half = range < 3;
  const int cells = even_cells(d.gamma, range, half ? most_cells / 4 : most_cells / 2, 1);
  n_gamma_ = cells + 1;
  // An even number of meridians: each has its opposite, where it goes on beyond a pole.
  m_c_ = d.rotational() ? 1 : even_cells(d.c, tau, most_cells, 2);
  gamma_from_ = static_cast<float>(d.gamma.front());
  gamma_step_ = static_cast<float>(range / cells);

  std::vector<double> values;
  for (int i = 0; i < m_c_; ++i)
    for (int j = 0; j < n_gamma_; ++j) {
      const double gamma = j == cells ? d.gamma.back() : d.gamma.front() + range * j / cells;
      values.push_back(d.intensity({tau * i / m_c_, gamma}) / max_cd_);
    }
  const bool pole_first = d.gamma.front()<0.1, pole_last = d.gamma.back()> 3;
  const Continued at(n_gamma_, m_c_, pole_first, pole_last);
  if (filter == LightFilter::bspline) values = bspline_coefficients(values, n_gamma_, m_c_, at);

  const auto ring_mean = [&](int j) {
    double sum = 0;
    for (int i = 0; i < m_c_; ++i) sum += values[at.index(i, j)];
    return sum / m_c_;
  };
  const auto border = [&](int i, int outside, int inside, bool pole) {
    if (pole && filter == LightFilter::mitchell) return 2 * ring_mean(inside) - values[at.index(i, inside)];
    return values[at.index(i, outside)];
  };
  texels_.reserve(static_cast<std::size_t>(m_c_) * static_cast<std::size_t>(width()));
  for (int i = 0; i < m_c_; ++i) {
    texels_.push_back(static_cast<float>(border(i, -1, 1, pole_first)));
    for (int j = 0; j < n_gamma_; ++j) texels_.push_back(static_cast<float>(values[at.index(i, j)]));
    texels_.push_back(static_cast<float>(border(i, n_gamma_, n_gamma_ - 2, pole_last)));
  }
}

float LightTexture::lookup(const Vec3<float>& w) const noexcept {
  const float x = glm::dot(w, c0_), y = glm::dot(w, c90_), z = glm::dot(w, nadir_);
  const float gamma = std::atan2(std::sqrt(x * x + y * y), z);
  const float s = (gamma - gamma_from_) / gamma_step_;
  if (s < -1e-4f || s > static_cast<float>(n_gamma_ - 1) + 1e-4f) return 0;
  const int j = std::clamp(static_cast<int>(s), 0, n_gamma_ - 2);
  const std::array<float, 4> along = filter_weights(filter_, std::clamp(s - static_cast<float>(j), 0.0f, 1.0f));

  const auto row = [&](int i) {
    const float* texel = texels_.data() + i * width() + j;
    return along[0] * texel[0] + along[1] * texel[1] + along[2] * texel[2] + along[3] * texel[3];
  };
  if (m_c_ == 1) return std::max(row(0), 0.0f);
  const float turn = std::atan2(y, x) / (2 * pi<float>);
  const float t = (turn < 0 ? turn + 1 : turn) * static_cast<float>(m_c_);
  const int i = std::min(static_cast<int>(t), m_c_ - 1);
  const std::array<float, 4> across = filter_weights(filter_, t - static_cast<float>(i));
  float sum = 0;
  for (int k = 0; k < 4; ++k) sum += across[static_cast<std::size_t>(k)] * row((i + k - 1 + m_c_) % m_c_);
  return std::max(sum, 0.0f);
}

float point_light(const LightTexture& texture, float intensity, const Vec3<float>& offset) noexcept {
  const float d2 = glm::dot(offset, offset);
  return intensity * texture.lookup(offset / std::sqrt(d2)) / d2;
}

double two_plane_intensity(const LightDiagram& d, const Vec3<double>& w) noexcept {
  const double x = glm::dot(w, d.frame.c0), y = glm::dot(w, d.frame.c90), z = glm::dot(w, d.frame.nadir);
  const double i0 = d.intensity({x < 0 ? pi<double> : 0, std::atan2(std::abs(x), z)});
  const double i1 = d.intensity({y < 0 ? 1.5 * pi<double> : pi<double> / 2, std::atan2(std::abs(y), z)});
  const double r2 = x * x + y * y;
  if (r2 == 0) return i0;
  return std::sqrt((i0 * i0 * x * x + i1 * i1 * y * y) / r2);
}

}  // namespace gonio
