#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include <gonio/brdf/proof/coherence.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio::proof {
namespace {

using Point = glm::dvec2;  // of the square
using Map = std::function<std::optional<BsdfSample>(const Point&)>;

double distance(const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 d = glm::dvec3(a) - glm::dvec3(b);
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Halves a side fourteen times, each time keeping the half whose ends are further apart. Cube roots,
/// the steepest that a density with isolated zeros makes, come down to 1/25; a jump stays.
bool torn(const Map& map, Point a, Point b, glm::vec3 wa, glm::vec3 wb) {
  const double whole = distance(wa, wb);
  if (whole < 1e-3) return false;  // nothing to see, and near the rounding of a direction after halving
  for (int halving = 0; halving < 14; ++halving) {
    const Point middle = 0.5 * (a + b);
    const auto s = map(middle);
    if (!s) return false;
    if (distance(wa, s->wo) > distance(s->wo, wb))
      b = middle, wb = s->wo;
    else
      a = middle, wa = s->wo;
  }
  return distance(wa, wb) > whole / 8;
}

double slope(const std::vector<double>& error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (std::size_t k = 0; k < error.size(); ++k) {
    if (!(error[k] > 0)) continue;
    const double x = static_cast<double>(k), y = std::log2(error[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
  }
  return n > 1 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : 0;
}

}  // namespace

Coherence measure_coherence(const Subject& subject, double theta_i, int side) {
  const glm::vec3 wi(static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i)));
  const Map map = [&](const Point& p) { return subject.sample(wi, glm::vec2(p)); };
  const std::size_t n = static_cast<std::size_t>(side) + 1;
  const double h = 1.0 / side;
  // Moved by part of a cell: off u = 1, and off the diagonals, where the concentric map has its kinks.
  const auto at = [&](std::size_t i, std::size_t j) {
    return Point(std::min((static_cast<double>(i) + 0.25) * h, 1 - 0x1p-24),
                 std::min((static_cast<double>(j) + 0.4) * h, 1 - 0x1p-24));
  };
  std::vector<std::optional<BsdfSample>> corner(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) corner[i * n + j] = map(at(i, j));

  Coherence result;
  std::vector<double> stretch;
  std::uint64_t positive = 0, negative = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const auto &a = corner[i * n + j], &b = corner[(i + 1) * n + j], &c = corner[i * n + j + 1],
                 &d = corner[(i + 1) * n + j + 1];
      if (!(a && b && c && d)) continue;
      const double sides[] = {distance(a->wo, b->wo), distance(a->wo, c->wo), distance(b->wo, d->wo),
                              distance(c->wo, d->wo)};
      const Point size = at(i + 1, j + 1) - at(i, j);
      const double pdf = (a->pdf + b->pdf + c->pdf + d->pdf) / 4.0;
      stretch.push_back(*std::max_element(sides, sides + 4) / std::sqrt(size.x * size.y / pdf));
      const bool apart = torn(map, at(i, j), at(i + 1, j), a->wo, b->wo),
                 aside = torn(map, at(i, j), at(i, j + 1), a->wo, c->wo);
      result.tears += apart + aside;
      if (apart || aside) continue;
      // Orientation by small corners of the cell: a larger one may be bent. What is turned inside out is so at every
      // size and to both sides; a corner that lies on a kink of the map may look so at every size, but to one side
      // alone.
      const auto orientation = [&](double share) {
        const auto right = map(at(i, j) + Point(share * size.x, 0)), up = map(at(i, j) + Point(0, share * size.y));
        if (!(right && up)) return 0;
        const glm::dvec3 origin(a->wo);
        const double area = dot(cross(glm::dvec3(right->wo) - origin, glm::dvec3(up->wo) - origin), origin);
        if (std::abs(area) <= 0.05 * share * share * size.x * size.y / a->pdf) return 0;
        return area > 0 ? 1 : -1;
      };
      const int sign = orientation(1.0 / 64);
      constexpr double others[] = {1.0 / 512, 1.0 / 2048, -1.0 / 512, -1.0 / 2048};
      if (sign != 0 &&
          std::all_of(std::begin(others), std::end(others), [&](double share) { return orientation(share) == sign; }))
        ++(sign > 0 ? positive : negative);
    }
  }
  result.folds = std::min(positive, negative);
  if (stretch.empty()) return result;
  std::sort(stretch.begin(), stretch.end());
  result.stretch_p50 = stretch[stretch.size() / 2];
  result.stretch_p99 = stretch[stretch.size() * 99 / 100];
  result.stretch_worst = stretch.back();
  return result;
}

glm::vec2 sobol(std::uint32_t k, std::uint32_t shift_u, std::uint32_t shift_v) noexcept {
  // Direction numbers of the second dimension: the primitive polynomial x + 1, v_j = v_(j-1) ^ (v_(j-1) >> 1).
  std::uint32_t u = 0, v = 0;
  for (std::uint32_t bit = 1u << 31, direction = 1u << 31; k != 0; k >>= 1, bit >>= 1, direction ^= direction >> 1)
    if (k & 1u) u ^= bit, v ^= direction;
  return {static_cast<float>((u ^ shift_u) >> 8) * 0x1p-24f, static_cast<float>((v ^ shift_v) >> 8) * 0x1p-24f};
}

Convergence measure_convergence(const Subject& subject, double theta_i, int last, std::uint32_t seed) {
  constexpr int first = 4, repeats = 16;
  const glm::vec3 wi(static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i)));
  const auto estimate = [&](const glm::vec2& u) {
    const auto s = subject.sample(wi, u);
    if (!s) return 0.0;
    return luminance(s->weight) * (1 + 0.5 * s->wo.x + 0.25 * s->wo.y + static_cast<double>(s->wo.z) * s->wo.z);
  };
  const std::size_t sizes = static_cast<std::size_t>(last - first + 1);
  Random random(seed);
  std::mt19937 engine(seed + 1);
  // Sum and sum of squares over the repeats of the estimate at every N; every sequence is used for all N.
  const auto errors = [&](const std::function<std::function<glm::vec2(std::uint32_t)>()>& sequence) {
    std::vector<double> sum(sizes, 0.0), sum2(sizes, 0.0), error;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      const auto point = sequence();
      double total = 0;
      std::uint32_t k = 0;
      for (std::size_t n = 0; n < sizes; ++n) {
        const std::uint32_t count = 1u << (first + n);
        for (; k < count; ++k) total += estimate(point(k));
        sum[n] += total / count;
        sum2[n] += total / count * (total / count);
      }
    }
    for (std::size_t n = 0; n < sizes; ++n) {
      const double mean = sum[n] / repeats, variance = (sum2[n] / repeats - mean * mean) * repeats / (repeats - 1);
      error.push_back(mean > 0 ? std::sqrt(std::max(variance, 0.0)) / mean : 0);
    }
    return error;
  };
  Convergence result;
  result.qmc_error = errors([&] {
    const auto shift_u = static_cast<std::uint32_t>(engine()), shift_v = static_cast<std::uint32_t>(engine());
    return [=](std::uint32_t k) { return sobol(k, shift_u, shift_v); };
  });
  result.mc_error = errors([&] { return [&](std::uint32_t) { return random.pair(); }; });
  result.qmc_slope = slope(result.qmc_error);
  result.mc_slope = slope(result.mc_error);
  return result;
}

}  // namespace gonio::proof
