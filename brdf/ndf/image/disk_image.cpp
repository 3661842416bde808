#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gonio/brdf/ndf/image/disk_image.h>
#include <gonio/brdf/ndf/image/solid_angle.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {

// Gauss-Legendre nodes and weights on [0, 1]: Abramowitz and Stegun 1964, table 25.4, n = 7.
struct Node {
  double x, weight;
};
constexpr Node mapped(double x, double w) { return {(1 + x) / 2, w / 2}; }
constexpr Node nodes[] = {mapped(-0.949107912342759, 0.129484966168870), mapped(-0.741531185599394, 0.279705391489277),
                          mapped(-0.405845151377397, 0.381830050505119), mapped(0, 0.417959183673469),
                          mapped(0.405845151377397, 0.381830050505119),  mapped(0.741531185599394, 0.279705391489277),
                          mapped(0.949107912342759, 0.129484966168870)};

enum class Coverage { inside, cut, outside };

Coverage coverage_of(const PixelBounds& p) noexcept {
  const double near_x = std::max({p.x0, -p.x1, 0.0}), near_y = std::max({p.y0, -p.y1, 0.0});
  const double far_x = std::max(p.x1, -p.x0), far_y = std::max(p.y1, -p.y0);
  if (near_x * near_x + near_y * near_y >= 1) return Coverage::outside;
  return far_x * far_x + far_y * far_y < 1 ? Coverage::inside : Coverage::cut;
}

double mean(const PixelBounds& p, Coverage coverage, const std::function<double(const Vec3<double>&)>& density) {
  if (coverage == Coverage::inside) {
    double sum = 0;
    for (const Node& i : nodes)
      for (const Node& j : nodes) {
        const double x = p.x0 + (p.x1 - p.x0) * i.x, y = p.y0 + (p.y1 - p.y0) * j.x;
        sum += i.weight * j.weight * density({x, y, std::sqrt(1 - x * x - y * y)});
      }
    return sum;
  }
  constexpr int side = 16;
  double sum = 0;
  int inside = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = p.x0 + (p.x1 - p.x0) * (i + 0.5) / side, y = p.y0 + (p.y1 - p.y0) * (j + 0.5) / side;
      const double z2 = 1 - x * x - y * y;
      if (z2 <= 0) continue;
      sum += density({x, y, std::sqrt(z2)});
      ++inside;
    }
  if (inside > 0) return sum / inside;
  // The circle cuts off less than any point: all of it lies at the horizon.
  const double x = (p.x0 + p.x1) / 2, y = (p.y0 + p.y1) / 2, r = std::hypot(x, y);
  return density({x / r, y / r, 0});
}

/// The sum over all pixels that the disk reaches of value times function(bounds).
template <class Function>
double sum(const DiskImage& image, const Function& function) {
  std::vector<double> rows(static_cast<std::size_t>(image.size));
  parallel_for(rows.size(), [&](std::size_t row) {
    for (int column = 0; column < image.size; ++column) {
      const PixelBounds p = pixel_bounds(image.size, static_cast<int>(row), column);
      const float value = image.at(static_cast<int>(row), column);
      if (value != 0 && coverage_of(p) != Coverage::outside) rows[row] += static_cast<double>(value) * function(p);
    }
  });
  double total = 0;
  for (const double row : rows) total += row;
  return total;
}

}  // namespace

PixelBounds pixel_bounds(int size, int row, int column) noexcept {
  const auto line = [size](int k) { return (2.0 * k - size) / size; };
  return {line(column), line(column + 1), -line(row + 1), -line(row)};
}

bool pixel_direction(int size, int row, int column, Vec3<double>& w) noexcept {
  const double x = (2.0 * column + 1 - size) / size, y = -(2.0 * row + 1 - size) / size, z2 = 1 - x * x - y * y;
  if (!(z2 > 0)) return false;
  w = {x, y, std::sqrt(z2)};
  return true;
}

DiskImage rasterise(int size, const std::function<double(const Vec3<double>&)>& density) {
  if (size < 1 || size > max_disk_image_side)
    throw Error("disk image: size: found " + std::to_string(size) + ", expected 1 to " +
                std::to_string(max_disk_image_side));
  DiskImage image(size);
  parallel_for(static_cast<std::size_t>(size), [&](std::size_t row) {
    for (int column = 0; column < size; ++column) {
      const PixelBounds p = pixel_bounds(size, static_cast<int>(row), column);
      const Coverage coverage = coverage_of(p);
      if (coverage != Coverage::outside)
        image.at(static_cast<int>(row), column) = static_cast<float>(mean(p, coverage, density));
    }
  });
  return image;
}

double projected_area(const DiskImage& ndf) {
  return sum(ndf, [](const PixelBounds& p) { return orthographic_normal_integral(p.x0, p.x1, p.y0, p.y1).z; });
}

double microsurface_area(const DiskImage& ndf) {
  return sum(ndf, [](const PixelBounds& p) { return orthographic_solid_angle(p.x0, p.x1, p.y0, p.y1); });
}

MedianSlopes median_slopes(const DiskImage& ndf) {
  std::vector<std::pair<double, double>> x, y;  // slope, mass
  for (int row = 0; row < ndf.size; ++row)
    for (int column = 0; column < ndf.size; ++column) {
      const double d = static_cast<double>(ndf.at(row, column));
      if (!(d > 0)) continue;
      const PixelBounds p = pixel_bounds(ndf.size, row, column);
      const Vec3<double> facet = orthographic_normal_integral(p.x0, p.x1, p.y0, p.y1);
      if (!(facet.z > 0)) continue;
      x.emplace_back(std::abs(facet.x) / facet.z, d * facet.z);
      y.emplace_back(std::abs(facet.y) / facet.z, d * facet.z);
    }
  const auto median = [](std::vector<std::pair<double, double>>& slopes) {
    std::sort(slopes.begin(), slopes.end());
    double total = 0, below = 0;
    for (const auto& [slope, mass] : slopes) total += mass;
    for (const auto& [slope, mass] : slopes)
      if ((below += mass) >= total / 2) return slope;
    return 0.0;
  };
  return {median(x), median(y)};
}

double normalise(DiskImage& ndf) {
  for (int row = 0; row < ndf.size; ++row)
    for (int column = 0; column < ndf.size; ++column) {
      float& value = ndf.at(row, column);
      if (coverage_of(pixel_bounds(ndf.size, row, column)) == Coverage::outside) {
        value = 0;
      } else if (!(value >= 0 && std::isfinite(value))) {
        throw Error("normal distribution: row " + std::to_string(row) + ", column " + std::to_string(column) +
                    ": found " + std::to_string(value) + ", expected a finite value from 0");
      }
    }
  const double before = projected_area(ndf);
  if (!(before > 0)) throw Error("normal distribution: found 0 everywhere, expected some density");
  for (float& value : ndf.values) value = static_cast<float>(static_cast<double>(value) / before);
  return before;
}

}  // namespace gonio
