#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gonio/brdf/build/stack/raise_tail.h>

namespace gonio::detail {
namespace {

constexpr double tail_weight = 1.1;
// Where less than this share of the mass of the meridian, or of the mean one, is further out, a row is raised.
constexpr double tail_share = 1e-3;
// No more than this share of its mass, or of that of the mean one, is added to a meridian in its last cell.
constexpr double horizon_share = 1e-3;

double wanted_at(const DiskDensity& density, Polar<double> at) {
  const double g = density(at);
  return g > 0 && std::isfinite(g) ? g / tail_weight : 0;
}

/// The mass of every meridian beyond every row, and that of the mean meridian.
struct Masses {
  std::vector<double> beyond;
  double mean;

  double of_meridian(std::size_t i, std::size_t rows) const { return std::max(mean, beyond[i * rows]); }
};
Masses masses(const DiagramGrid& grid) {
  const std::size_t rows = grid.r.size();
  std::vector<double> beyond(grid.density.size(), 0.0);
  double whole = 0;
  for (std::size_t i = 0; i < grid.phi.size(); ++i) {
    double* mass = beyond.data() + i * rows;
    for (std::size_t j = rows - 1; j-- > 0;)
      mass[j] = mass[j + 1] +
                RadialCell<double>{grid.r[j], grid.r[j + 1] - grid.r[j], grid.at(i, j), grid.at(i, j + 1)}.mass(1);
    if (i > 0) whole += (grid.phi[i] - grid.phi[i - 1]) * (mass[0] + *(mass - rows)) / 2;
  }
  return {std::move(beyond), whole / grid.phi.back()};
}

/// Rows but the last: to what the density is at them and half way to the next row, on the meridian and half way to its
/// neighbours.
void raise_inner_rows(const DiskDensity& density, const Masses& m, DiagramGrid& grid) {
  const std::size_t count = grid.phi.size(), rows = grid.r.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double phi = grid.phi[i], before = grid.phi[i > 0 ? i - 1 : i], next = grid.phi[std::min(i + 1, count - 1)];
    for (std::size_t j = rows - 2; j > 0 && m.beyond[i * rows + j] < tail_share * m.of_meridian(i, rows); --j)
      for (const double r : {grid.r[j], (grid.r[j] + grid.r[j + 1]) / 2})
        for (const double angle : {(before + phi) / 2, phi, (phi + next) / 2})
          grid.at(i, j) = std::max(grid.at(i, j), wanted_at(density, {r, angle}));
  }
}

/// The last row, where densities fall to 0: to what the last cells need at all distances from the horizon.
void raise_horizon(const DiskDensity& density, const Masses& m, DiagramGrid& grid) {
  constexpr int steps = 24;  // from a meridian to the next
  const std::size_t last = grid.r.size() - 1, count = grid.phi.size();
  const double h = 1 - grid.r[last - 1];
  std::vector<double> wanted(count, 0.0);
  for (std::size_t k = 0; k <= (count - 1) * steps; ++k) {
    const std::size_t i = k / steps, next = std::min(i + (k % steps > 0), count - 1);
    const double t = static_cast<double>(k % steps) / steps, phi = (1 - t) * grid.phi[i] + t * grid.phi[next];
    const double start = (1 - t) * grid.at(i, last - 1) + t * grid.at(next, last - 1);
    for (double part = 0.5; part * h > least_gap<float>; part *= 0.25) {
      const double end = (wanted_at(density, {1 - part * h, phi, part * h}) - start * part) / (1 - part);
      wanted[i] = std::max(wanted[i], end), wanted[next] = std::max(wanted[next], end);
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    grid.at(i, last) = std::max(grid.at(i, last), std::min(wanted[i], horizon_share * m.of_meridian(i, last + 1) / h));
}

}  // namespace

void raise_tail(const DiskDensity& density, DiagramGrid& grid) {
  const Masses m = masses(grid);
  raise_inner_rows(density, m, grid);
  raise_horizon(density, m, grid);
}

}  // namespace gonio::detail
