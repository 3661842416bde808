#include <algorithm>
#include <cmath>

#include <gonio/brdf/formats/rgl/warp2d.h>

namespace gonio {
namespace {

// t in [0, 1] with a t + (b - a) t^2 / 2 = c, for a, b >= 0: the root of the linear density's
// cumulative, in the form that has no cancellation when a and b are close.
float invert_linear(float a, float b, float c) noexcept {
  const float denominator = a + std::sqrt(std::max(a * a + 2.0f * c * (b - a), 0.0f));
  const float t = 2.0f * c / denominator;
  return t > 0.0f ? std::min(t, 1.0f) : 0.0f;  // also takes 0/0 to 0
}

float integrate_linear(float a, float b, float t) noexcept { return t * (a + 0.5f * t * (b - a)); }

// Largest i in [0, n - 2] with cumulative(i) <= target.
template <class Cumulative>
int find_interval(int n, float target, const Cumulative& cumulative) noexcept {
  int lo = 0, length = n - 1;
  while (length > 1) {
    const int half = length / 2;
    const bool upper = cumulative(lo + half) <= target;
    lo = upper ? lo + half : lo;
    length = upper ? length - half : half;
  }
  return lo;
}

struct Cell {
  int i;
  float t;
};

// Cell and fraction of a position in [0, 1] on n nodes.
Cell locate(float x, int n) noexcept {
  const float scaled = x > 0.0f ? std::min(x, 1.0f) * static_cast<float>(n - 1) : 0.0f;
  const int i = std::min(static_cast<int>(scaled), n - 2);
  return {i, scaled - static_cast<float>(i)};
}

}  // namespace

Warp2d::Warp2d(int n_slices, int height, int width, const std::vector<float>& density)
    : height_(height),
      width_(width),
      density_(density),
      conditional_(density.size()),
      marginal_(static_cast<std::size_t>(n_slices) * height) {
  const double dx = 1.0 / (width - 1), dy = 1.0 / (height - 1);
  const std::size_t size = static_cast<std::size_t>(height) * width;
  std::vector<double> mass(static_cast<std::size_t>(height));
  for (int s = 0; s < n_slices; ++s) {
    float* values = density_.data() + static_cast<std::size_t>(s) * size;
    const auto row_mass = [&](int y) {
      double sum = 0.0;
      for (int x = 0; x + 1 < width; ++x) {
        sum += 0.5 * dx * (static_cast<double>(values[y * width + x]) + values[y * width + x + 1]);
      }
      return sum;
    };
    double total = 0.0;
    for (int y = 0; y < height; ++y) {
      total += row_mass(y) * dy * (y == 0 || y == height - 1 ? 0.5 : 1.0);
    }
    if (!(total > 0.0)) {
      std::fill(values, values + size, 1.0f);
      total = 1.0;
    }
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<float>(values[i] / total);

    double below = 0.0;
    for (int y = 0; y < height; ++y) {
      float* cumulative = conditional_.data() + static_cast<std::size_t>(s) * size + y * width;
      double sum = 0.0;
      for (int x = 1; x < width; ++x) {
        sum += 0.5 * dx * (static_cast<double>(values[y * width + x - 1]) + values[y * width + x]);
        cumulative[x] = static_cast<float>(sum);
      }
      mass[static_cast<std::size_t>(y)] = sum;
      if (y > 0) below += 0.5 * dy * (mass[static_cast<std::size_t>(y) - 1] + sum);
      marginal_[static_cast<std::size_t>(s) * height + y] = static_cast<float>(below);
    }
  }
}

Warp2d::Point Warp2d::sample(const Lerp& slice, float u, float v) const noexcept {
  const float* marginal_lo = marginal_.data() + static_cast<std::ptrdiff_t>(slice.lo) * height_;
  const float* marginal_hi = marginal_.data() + static_cast<std::ptrdiff_t>(slice.hi) * height_;
  const auto marginal = [&](int y) { return lerp(marginal_lo[y], marginal_hi[y], slice.t); };
  const int iy = find_interval(height_, v, marginal);

  const float* lo = row(conditional_, slice.lo, iy);
  const float* hi = row(conditional_, slice.hi, iy);
  const int last = width_ - 1;
  const float mass_0 = lerp(lo[last], hi[last], slice.t);
  const float mass_1 = lerp(lo[width_ + last], hi[width_ + last], slice.t);
  const float ty = invert_linear(mass_0, mass_1, (v - marginal(iy)) * static_cast<float>(height_ - 1));

  const auto blend = [&](const float* a, const float* b, int x) {
    return lerp(lerp(a[x], a[width_ + x], ty), lerp(b[x], b[width_ + x], ty), slice.t);
  };
  const float target = u * lerp(mass_0, mass_1, ty);
  const auto conditional = [&](int x) { return blend(lo, hi, x); };
  const int ix = find_interval(width_, target, conditional);

  const float* density_lo = row(density_, slice.lo, iy);
  const float* density_hi = row(density_, slice.hi, iy);
  const float d0 = blend(density_lo, density_hi, ix), d1 = blend(density_lo, density_hi, ix + 1);
  const float tx = invert_linear(d0, d1, (target - conditional(ix)) * static_cast<float>(last));
  return {(static_cast<float>(ix) + tx) / static_cast<float>(last),
          (static_cast<float>(iy) + ty) / static_cast<float>(height_ - 1), lerp(d0, d1, tx)};
}

Warp2d::Point Warp2d::invert(const Lerp& slice, float x, float y) const noexcept {
  const Cell cx = locate(x, width_), cy = locate(y, height_);
  const float* lo = row(conditional_, slice.lo, cy.i);
  const float* hi = row(conditional_, slice.hi, cy.i);
  const int last = width_ - 1;
  const auto blend = [&](const float* a, const float* b, int i) {
    return lerp(lerp(a[i], a[width_ + i], cy.t), lerp(b[i], b[width_ + i], cy.t), slice.t);
  };
  const float* density_lo = row(density_, slice.lo, cy.i);
  const float* density_hi = row(density_, slice.hi, cy.i);
  const float d0 = blend(density_lo, density_hi, cx.i);
  const float d1 = blend(density_lo, density_hi, cx.i + 1);
  const float mass = blend(lo, hi, last);
  const float below = blend(lo, hi, cx.i) + integrate_linear(d0, d1, cx.t) / static_cast<float>(last);

  const float mass_0 = lerp(lo[last], hi[last], slice.t);
  const float mass_1 = lerp(lo[width_ + last], hi[width_ + last], slice.t);
  const auto marginal = [&](int s) { return marginal_[static_cast<std::size_t>(s) * height_ + cy.i]; };
  const float v = lerp(marginal(slice.lo), marginal(slice.hi), slice.t) +
                  integrate_linear(mass_0, mass_1, cy.t) / static_cast<float>(height_ - 1);
  // A line without mass is never sampled; any u would do.
  return {mass > 0.0f ? std::min(below / mass, 1.0f) : x, std::min(v, 1.0f), lerp(d0, d1, cx.t)};
}

float Warp2d::eval(const Lerp& slice, float x, float y) const noexcept {
  const Cell cx = locate(x, width_), cy = locate(y, height_);
  const auto at = [&](int s) {
    const float* cell = row(density_, s, cy.i) + cx.i;
    return lerp(lerp(cell[0], cell[1], cx.t), lerp(cell[width_], cell[width_ + 1], cx.t), cy.t);
  };
  return lerp(at(slice.lo), at(slice.hi), slice.t);
}

}  // namespace gonio
