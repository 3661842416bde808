#include <cmath>
#include <string>
#include <type_traits>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/diagram/diagram.h>

namespace gonio {
namespace {

void check_lines(const std::vector<double>& lines, double last, const char* name) {
  const std::string field = std::string("diagram: ") + name;
  if (lines.size() < 2) throw Error(field + ": found " + std::to_string(lines.size()) + " lines, expected at least 2");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::isfinite(lines[i]) || (i > 0 && !(lines[i] > lines[i - 1])))
      throw Error(field + "[" + std::to_string(i) + "]: found " + std::to_string(lines[i]) +
                  ", expected strictly ascending values");
  }
  if (std::abs(lines.front()) > 1e-6 || std::abs(lines.back() - last) > 1e-6)
    throw Error(field + ": found the range " + std::to_string(lines.front()) + " to " + std::to_string(lines.back()) +
                ", expected 0 to " + std::to_string(last));
}

void check(const DiagramGrid& grid) {
  check_lines(grid.phi, grid.azimuth == Azimuth::half ? pi<double> : 2 * pi<double>, "meridians");
  check_lines(grid.r, 1.0, "parallels");
  const std::size_t expected = grid.phi.size() * grid.r.size();
  if (grid.density.size() != expected)
    throw Error("diagram: density: found " + std::to_string(grid.density.size()) + " values, expected " +
                std::to_string(expected));
  double largest = 0;
  for (std::size_t k = 0; k < expected; ++k) {
    const double d = grid.density[k];
    if (!std::isfinite(d) || d < 0)
      throw Error("diagram: density[" + std::to_string(k) + "]: found " + std::to_string(d) +
                  ", expected a finite value >= 0");
    largest = std::max(largest, d);
  }
  if (grid.azimuth == Azimuth::full)
    for (std::size_t j = 0; j < grid.r.size(); ++j)
      if (grid.at(grid.phi.size() - 1, j) != grid.at(0, j))
        throw Error("diagram: density: the last meridian differs from the first at parallel " + std::to_string(j) +
                    ", expected the same values at phi = 0 and 2 pi");
  if (largest == 0) throw Error("diagram: density: found zero everywhere, expected some mass");
}

}  // namespace

template <class T>
Diagram<T>::Diagram(const DiagramGrid& grid) : azimuth_(grid.azimuth) {
  check(grid);
  meridians_ = static_cast<int>(grid.phi.size());
  parallels_ = static_cast<int>(grid.r.size());
  using Wide = std::conditional_t<(sizeof(T) > sizeof(double)), T, double>;
  const std::size_t m = grid.phi.size(), n = grid.r.size();
  values_.resize(2 * m + n + 2 * m * n);
  T* phi = values_.data();
  T* cumulative_phi = phi + m;
  T* r = phi + 2 * m;
  T* density = r + n;
  T* cumulative = density + m * n;
  for (std::size_t i = 0; i < m; ++i) phi[i] = static_cast<T>(grid.phi[i]);
  for (std::size_t j = 0; j < n; ++j) r[j] = static_cast<T>(grid.r[j]);
  phi[0] = 0;
  phi[m - 1] = azimuth_ == Azimuth::half ? pi<T> : 2 * pi<T>;
  r[0] = 0;
  r[n - 1] = 1;
  for (std::size_t i = 1; i < m; ++i)
    if (!(phi[i] > phi[i - 1])) throw Error("diagram: meridians: two lines coincide after rounding");
  for (std::size_t j = 1; j < n; ++j)
    if (!(r[j] > r[j - 1])) throw Error("diagram: parallels: two lines coincide after rounding");

  const auto mass_along = [&](const auto* d, Wide* below) {
    Wide sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (below) below[j] = sum;
      if (j + 1 < n) sum += RadialCell<Wide>{r[j], Wide(r[j + 1]) - Wide(r[j]), Wide(d[j]), Wide(d[j + 1])}.mass(1);
    }
    return sum;
  };
  const auto total_mass = [&](const auto* d) {
    Wide sum = 0, previous = mass_along(d, nullptr);
    for (std::size_t i = 1; i < m; ++i) {
      const Wide next = mass_along(d + i * n, nullptr);
      sum += (Wide(phi[i]) - Wide(phi[i - 1])) * (previous + next) / 2;
      previous = next;
    }
    return sum;
  };

  // Two stages: scale to a pdf and round to T; then integrate what is stored, so that the map and
  // its pdf agree to rounding whatever T is. Data that is normalised already is kept bit by bit.
  const Wide whole = azimuth_ == Azimuth::half ? Wide(0.5) : Wide(1);
  const Wide mass = total_mass(grid.density.data());
  if (!(mass > 0) || !std::isfinite(mass))
    throw Error("diagram: density: the mass is " + std::to_string(static_cast<double>(mass)) +
                ", expected a positive finite number");
  const bool normalised = std::abs(mass / whole - 1) < Wide(1e-6);
  const Wide scale = normalised ? Wide(1) : whole / mass;
  for (std::size_t k = 0; k < m * n; ++k) density[k] = static_cast<T>(grid.density[k] * scale);

  std::vector<Wide> below(n);
  Wide sum = 0, previous = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const Wide next = mass_along(density + i * n, below.data());
    for (std::size_t j = 0; j < n; ++j) cumulative[i * n + j] = static_cast<T>(below[j]);
    if (i > 0) sum += (Wide(phi[i]) - Wide(phi[i - 1])) * (previous + next) / 2;
    cumulative_phi[i] = static_cast<T>(sum);
    previous = next;
  }
}

template <class T>
DiagramGrid Diagram<T>::grid() const {
  DiagramGrid grid;
  grid.azimuth = azimuth_;
  grid.phi.assign(phi(), phi() + meridians_);
  grid.r.assign(r(), r() + parallels_);
  grid.density.assign(density(0), density(meridians_));
  return grid;
}

template <class T>
bool Diagram<T>::same_lines(const Diagram& other) const noexcept {
  return azimuth_ == other.azimuth_ && meridians_ == other.meridians_ && parallels_ == other.parallels_ &&
         std::equal(phi(), phi() + meridians_, other.phi()) && std::equal(r(), r() + parallels_, other.r());
}

template class Diagram<float>;
template class Diagram<double>;
template class Diagram<long double>;

}  // namespace gonio
