#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/folded_disk.h>
#include <gonio/mapping/numeric/code16.h>
#include <gonio/mapping/stack/packed_stack.h>

namespace gonio {

/// The blend of the two diagrams about an incident angle, as Blend. Densities and masses of a diagram are in
/// units of its scale, which is part of its weight.
class PackedStack::Blended {
 public:
  Blended(const PackedStack& stack, float theta_i) noexcept : stack_(stack) {
    const auto [k, alpha] = bracket(stack.theta_i_, theta_i);
    k0_ = k, k1_ = stack.theta_i_.size() > 1 ? k + 1 : k;
    w0_ = (1 - alpha) * stack.scale()[k0_], w1_ = alpha * stack.scale()[k1_];
  }

  PolarSample<float> sample(float u, float v, float rest) const noexcept { return sample_lines(*this, u, v, rest); }
  float pdf(Polar<float> at) const noexcept { return pdf_of_lines(*this, at); }
  PolarInverse<float> invert(Polar<float> at) const noexcept { return invert_lines(*this, at); }

  int meridians() const noexcept { return stack_.meridians_; }
  const float* phi() const noexcept { return stack_.phi(); }
  float before(int i) const noexcept { return mix(stack_.cumulative_phi(k0_)[i], stack_.cumulative_phi(k1_)[i]); }
  float along(int i) const noexcept {
    const int last = stack_.blocks_ - 1;
    return mix(stack_.ends(k0_, i)[last], stack_.ends(k1_, i)[last]);
  }

  /// The cells of a block. Those that fill up the last one have no mass.
  struct Cells {
    const float* r;
    float density[block + 1], mass[block];

    RadialCell<float> cell(int k) const noexcept { return {r[k], r[k + 1] - r[k], density[k], density[k + 1]}; }
  };

  /// The rows of both diagrams on either side of a position, and their weights.
  struct Row {
    const PackedStack& stack;
    const std::uint16_t *a0, *a1, *b0, *b1;
    const float *ends_a0, *ends_a1, *ends_b0, *ends_b1;
    float wa0, wa1, wb0, wb1;

    float density(int j) const noexcept {
      return wa0 * decode16(a0[j]) + wa1 * decode16(a1[j]) + wb0 * decode16(b0[j]) + wb1 * decode16(b1[j]);
    }
    /// The mass before a block.
    float before_block(int b) const noexcept {
      return b > 0 ? wa0 * ends_a0[b - 1] + wa1 * ends_a1[b - 1] + wb0 * ends_b0[b - 1] + wb1 * ends_b1[b - 1] : 0.0f;
    }
    Cells cells(int b) const noexcept {
      Cells c;
      c.r = stack.r() + b * block;
      for (int k = 0; k < block; ++k) c.density[k] = density(b * block + k);
      c.density[block] = density(b * block + block);
      for (int k = 0; k < block; ++k) {  // RadialCell::mass(1) without its division
        const float h = c.r[k + 1] - c.r[k];
        c.mass[k] =
            h * (c.r[k] * (c.density[k] + c.density[k + 1]) + h * (c.density[k] + 2 * c.density[k + 1]) * (1 / 3.0f));
      }
      return c;
    }

    RadialPlace<float> place(float target, float beyond, float mass) const noexcept {
      const int b = find_cell_of([this](int k) { return before_block(k); }, stack.blocks_ + 1, target);
      const Cells c = cells(b);
      const float start = before_block(b), inside = target - start;
      int j = 0;
      float sum = 0, before_cell = 0;
      for (int k = 0; k < block; ++k) {  // the last cell with mass that begins before the target
        const bool later = c.mass[k] > 0 && sum < inside;
        j = later ? k : j, before_cell = later ? sum : before_cell;
        sum += c.mass[k];
      }
      const bool last = b * block + j == stack.parallels_ - 2 || ends_mass(start + before_cell + c.mass[j], mass);
      return RadialPlace<float>::of(c.cell(j), c.r[j + 1], inside - before_cell, beyond, last);
    }
    CellOfRow<float> cell_at(float radius) const noexcept {
      const float* r = stack.r();
      const int j = find_cell(r, stack.parallels_, radius);
      return {j, {r[j], r[j + 1] - r[j], density(j), density(j + 1)}, r[j + 1]};
    }
    float before(int j) const noexcept {
      const int b = j / block;
      const Cells c = cells(b);
      float sum = before_block(b);
      for (int k = 0; k < j - b * block; ++k) sum += c.mass[k];
      return sum;
    }
  };
  Row row(int i, float a) const noexcept {
    return {stack_,
            stack_.codes(k0_, i),
            stack_.codes(k0_, i + 1),
            stack_.codes(k1_, i),
            stack_.codes(k1_, i + 1),
            stack_.ends(k0_, i),
            stack_.ends(k0_, i + 1),
            stack_.ends(k1_, i),
            stack_.ends(k1_, i + 1),
            w0_ * (1 - a),
            w0_ * a,
            w1_ * (1 - a),
            w1_ * a};
  }

 private:
  float mix(float a, float b) const noexcept { return w0_ * a + w1_ * b; }

  const PackedStack& stack_;
  int k0_, k1_;
  float w0_, w1_;
};

PackedStack::PackedStack(const StackGrid& grid) : chart_(grid.chart) {
  // Checks the grid, and rounds lines and angles.
  const StackGrid rounded = Stack<float>(grid, Interpolation::blend).grid();
  const DiagramGrid& lines = rounded.diagrams.front();
  if (lines.azimuth != Azimuth::half) throw Error("packed stack: found the full azimuth, expected half of it");
  theta_i_.assign(rounded.theta_i.begin(), rounded.theta_i.end());
  const std::size_t k_count = theta_i_.size(), m = lines.phi.size(), n = lines.r.size();
  const std::size_t blocks = (n - 1 + block - 1) / block;
  if (k_count * m * std::max(n, 4 * blocks) > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error("packed stack: found " + std::to_string(k_count * m * n) + " crossings, expected fewer than 2^31");
  meridians_ = static_cast<int>(m), parallels_ = static_cast<int>(n), blocks_ = static_cast<int>(blocks);

  values_.reserve(k_count + m + blocks * block + 1 + k_count * m * (1 + blocks));
  values_.resize(k_count);
  values_.insert(values_.end(), lines.phi.begin(), lines.phi.end());
  values_.insert(values_.end(), lines.r.begin(), lines.r.end());
  values_.resize(values_.size() + blocks * block + 1 - n, 1.0f);
  values_.resize(values_.capacity());
  codes_.reserve(k_count * m * n + block);
  for (const DiagramGrid& d : grid.diagrams) {
    const double largest = *std::max_element(d.density.begin(), d.density.end());
    for (const double density : d.density) codes_.push_back(encode16(density / largest));
  }
  codes_.resize(codes_.size() + block);

  const auto store = [&](const float* at, double value) { values_[at - values_.data()] = static_cast<float>(value); };
  for (int k = 0; k < static_cast<int>(k_count); ++k) {
    double sum = 0, previous = 0;
    for (int i = 0; i < meridians_; ++i) {
      const std::uint16_t* code = codes(k, i);
      double mass = 0;
      for (int j = 0; j + 1 < parallels_; ++j) {
        mass +=
            RadialCell<double>{r()[j], double{r()[j + 1]} - r()[j], decode16(code[j]), decode16(code[j + 1])}.mass(1);
        store(ends(k, i) + j / block, mass);
      }
      if (i > 0) sum += (double{phi()[i]} - phi()[i - 1]) * (previous + mass) / 2;
      store(cumulative_phi(k) + i, sum);
      previous = mass;
    }
    const double scale_k = 0.5 / sum;
    if (!(scale_k < 1e38))
      throw Error("packed stack: diagram " + std::to_string(k) + ": found a mass of " + std::to_string(sum) +
                  " of its largest density, expected more");
    store(scale() + k, scale_k);
  }
}

DirectionSample<float> PackedStack::sample(float theta_i, float u, float v) const noexcept {
  const DiskPoint<float> disk = square_to_disk(u, v);
  const Folded<float> folded = fold(disk.turn, true);
  return from_disk(chart_, theta_i, Blended(*this, theta_i).sample(folded.u, disk.r2, disk.rest), folded.mirrored);
}

float PackedStack::pdf(float theta_i, const Vec3<float>& wo) const noexcept {
  if (!(wo.z >= 0)) return 0;
  const OnDisk<float> d = to_disk(chart_, true, theta_i, wo);
  return Blended(*this, theta_i).pdf(d.at) / d.jacobian;
}

std::optional<SquareInverse<float>> PackedStack::invert(float theta_i, const Vec3<float>& wo) const noexcept {
  if (!(wo.z >= 0)) return std::nullopt;
  const OnDisk<float> d = to_disk(chart_, true, theta_i, wo);
  const PolarInverse<float> inverse = Blended(*this, theta_i).invert(d.at);
  if (!(inverse.pdf > 0)) return std::nullopt;
  return SquareInverse<float>{disk_to_square(DiskPoint<float>{unfold(inverse.u, d.mirrored, true), inverse.v}),
                              inverse.pdf / d.jacobian};
}

std::size_t PackedStack::bytes() const noexcept {
  return sizeof(*this) + (theta_i_.capacity() + values_.capacity()) * sizeof(float) +
         codes_.capacity() * sizeof(std::uint16_t);
}

StackGrid PackedStack::grid() const {
  StackGrid grid;
  grid.chart = chart_;
  grid.theta_i.assign(theta_i_.begin(), theta_i_.end());
  for (int k = 0; k < static_cast<int>(theta_i_.size()); ++k) {
    DiagramGrid d;
    d.phi.assign(phi(), phi() + meridians_);
    d.r.assign(r(), r() + parallels_);
    for (const std::uint16_t* code = codes(k, 0); code < codes(k, meridians_); ++code)
      d.density.push_back(double{scale()[k]} * decode16(*code));
    grid.diagrams.push_back(std::move(d));
  }
  return grid;
}

}  // namespace gonio
