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
      nodes_(density.size()),
      lines_(static_cast<std::size_t>(n_slices) * static_cast<std::size_t>(height)) {
  const double dx = 1.0 / (width - 1), dy = 1.0 / (height - 1);
  const std::size_t size = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].density = density[i];
  for (int s = 0; s < n_slices; ++s) {
    Node* nodes = nodes_.data() + static_cast<std::size_t>(s) * size;
    Line* lines = lines_.data() + static_cast<std::ptrdiff_t>(s) * height;
    const auto area = [&](const Node* right) {
      return 0.5 * dx * (static_cast<double>(right[-1].density) + right->density);
    };
    double total = 0.0;
    for (int y = 0; y < height; ++y) {
      double mass = 0.0;
      for (int x = 1; x < width; ++x) mass += area(nodes + y * width + x);
      total += mass * dy * (y == 0 || y == height - 1 ? 0.5 : 1.0);
    }
    for (std::size_t i = 0; i < size; ++i)
      nodes[i].density = total > 0.0 ? static_cast<float>(nodes[i].density / total) : 1.0f;

    double below = 0.0, mass_before = 0.0;
    for (int y = 0; y < height; ++y) {
      Node* row = nodes + y * width;
      double mass = 0.0;
      row[0].before = 0.0f;
      for (int x = 1; x < width; ++x) {
        mass += area(row + x);
        row[x].before = static_cast<float>(mass);
      }
      if (y > 0) below += 0.5 * dy * (mass_before + mass);
      lines[y] = {static_cast<float>(below), row[width - 1].before};
      mass_before = mass;
    }
  }
}

Warp2d::Point Warp2d::sample(const Lerp& slice, float u, float v) const noexcept {
  const Line* lines_lo = line(slice.lo, 0);
  const Line* lines_hi = line(slice.hi, 0);
  const auto marginal = [&](int y) { return lerp(lines_lo[y].before, lines_hi[y].before, slice.t); };
  const auto mass = [&](int y) { return lerp(lines_lo[y].mass, lines_hi[y].mass, slice.t); };
  const int iy = find_interval(height_, v, marginal);
  const float mass_0 = mass(iy), mass_1 = mass(iy + 1);
  const float ty = invert_linear(mass_0, mass_1, (v - marginal(iy)) * static_cast<float>(height_ - 1));

  const Node* lo = row(slice.lo, iy);
  const Node* hi = row(slice.hi, iy);
  const auto blend = [&](float Node::*what, int x) {
    return lerp(lerp(lo[x].*what, lo[width_ + x].*what, ty), lerp(hi[x].*what, hi[width_ + x].*what, ty), slice.t);
  };
  const float target = u * lerp(mass_0, mass_1, ty);
  const auto conditional = [&](int x) { return blend(&Node::before, x); };
  const int ix = find_interval(width_, target, conditional);

  const int last = width_ - 1;
  const float d0 = blend(&Node::density, ix), d1 = blend(&Node::density, ix + 1);
  const float tx = invert_linear(d0, d1, (target - conditional(ix)) * static_cast<float>(last));
  return {(static_cast<float>(ix) + tx) / static_cast<float>(last),
          (static_cast<float>(iy) + ty) / static_cast<float>(height_ - 1), lerp(d0, d1, tx)};
}

Warp2d::Point Warp2d::invert(const Lerp& slice, float x, float y) const noexcept {
  const Cell cx = locate(x, width_), cy = locate(y, height_);
  const Node* lo = row(slice.lo, cy.i) + cx.i;
  const Node* hi = row(slice.hi, cy.i) + cx.i;
  const auto blend = [&](float Node::*what, int i) {
    return lerp(lerp(lo[i].*what, lo[width_ + i].*what, cy.t), lerp(hi[i].*what, hi[width_ + i].*what, cy.t), slice.t);
  };
  const float d0 = blend(&Node::density, 0), d1 = blend(&Node::density, 1);
  const float before = blend(&Node::before, 0) + integrate_linear(d0, d1, cx.t) / static_cast<float>(width_ - 1);

  const Line* lines_lo = line(slice.lo, cy.i);
  const Line* lines_hi = line(slice.hi, cy.i);
  const float mass_0 = lerp(lines_lo[0].mass, lines_hi[0].mass, slice.t);
  const float mass_1 = lerp(lines_lo[1].mass, lines_hi[1].mass, slice.t);
  const float mass = lerp(mass_0, mass_1, cy.t);
  const float v = lerp(lines_lo[0].before, lines_hi[0].before, slice.t) +
                  integrate_linear(mass_0, mass_1, cy.t) / static_cast<float>(height_ - 1);
  // A line without mass is never sampled; any u would do.
  return {mass > 0.0f ? std::min(before / mass, 1.0f) : x, std::min(v, 1.0f), lerp(d0, d1, cx.t)};
}

float Warp2d::eval(const Lerp& slice, float x, float y) const noexcept {
  const Cell cx = locate(x, width_), cy = locate(y, height_);
  const auto at = [&](int s) {
    const Node* cell = row(s, cy.i) + cx.i;
    return lerp(lerp(cell[0].density, cell[1].density, cx.t),
                lerp(cell[width_].density, cell[width_ + 1].density, cx.t), cy.t);
  };
  return lerp(at(slice.lo), at(slice.hi), slice.t);
}

}  // namespace gonio
