#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include <gonio/mapping/charts/polar_map.h>
#include <gonio/mapping/diagram/azimuth_cell.h>
#include <gonio/mapping/diagram/radial_cell.h>
#include <gonio/mapping/numeric/find_cell.h>

namespace gonio {

// The maps M_C and M_D of Havran et al. (2003) and their inverses: invert the marginal in phi, then the conditional
// in r. They are written once, for all that can be read as meridians with masses:
//
//   lines.meridians(), lines.phi()  the meridians
//   lines.before(i)                 the mass before meridian i; the last one is the whole
//   lines.along(i)                  the mass along it
//   lines.row(i, a)                 what lies along a position between the meridians i and i + 1:
//     row.place(t, beyond, mass)      where the mass t lies before and `beyond`, to all its digits, behind, of `mass`
//     row.cell_at(r)                  the cell around a radius
//     row.before(j)                   the mass before cell j
//
// No map iterates: each does one search over the lines and a fixed number of operations.

/// A position between the meridians i and i + 1.
template <class T>
struct Meridian {
  int i;
  T a;     ///< 0 at meridian i, 1 at i + 1
  T phi;   ///< [rad]
  T mass;  ///< along it (2 r dr): d(mass)/dphi
};

/// A cell of a row: its index, and the radius at its end.
template <class T>
struct CellOfRow {
  int j;
  RadialCell<T> cell;
  T r1;
};

/// Whether a cell that ends with the mass `below` before its end is the last one with mass of a meridian with `mass`,
/// to rounding.
template <class T>
inline bool ends_mass(T below, T mass) noexcept {
  return below >= mass * (1 - 2 * std::numeric_limits<T>::epsilon());
}

/// M_C forward, eqs. 20-25: where the mass before is `target`, in [0, the whole].
template <class T, class Lines>
inline Meridian<T> meridian_at_mass(const Lines& lines, T target) noexcept {
  const int i = find_cell_of([&lines](int k) { return lines.before(k); }, lines.meridians(), target);
  const T* phi = lines.phi() + i;
  const AzimuthCell<T> across{phi[1] - phi[0], lines.along(i), lines.along(i + 1)};
  const T a = across.invert(target - lines.before(i));
  return {i, a, phi[0] + a * across.width, (1 - a) * across.m0 + a * across.m1};
}

/// The position of `angle` between the lines `phi`: its cell, and how far it is through it, in [0, 1].
template <class T>
inline std::pair<int, T> between_lines(const T* phi, int count, T angle) noexcept {
  const int i = find_cell(phi, count, angle);
  return {i, std::clamp((angle - phi[i]) / (phi[i + 1] - phi[i]), T(0), T(1))};
}

/// The meridian through `angle`, clamped to the range of the lines.
template <class T, class Lines>
inline Meridian<T> meridian_at_angle(const Lines& lines, T angle) noexcept {
  const T* phi = lines.phi();
  const auto [i, a] = between_lines(phi, lines.meridians(), angle);
  return {i, a, phi[i] + a * (phi[i + 1] - phi[i]), (1 - a) * lines.along(i) + a * lines.along(i + 1)};
}

/// M_C inverse: the mass before a meridian.
template <class T, class Lines>
inline T mass_before(const Lines& lines, const Meridian<T>& m) noexcept {
  const T width = lines.phi()[m.i + 1] - lines.phi()[m.i];
  return lines.before(m.i) + m.a * width * (lines.along(m.i) + m.mass) / 2;
}

/// M_D forward, eqs. 10-19: where the fraction v of the row's mass lies before. @param rest 1 - v, to as many digits as
/// are known: next to the horizon they decide.
template <class T, class Row>
inline RadialPlace<T> place_at(const Row& row, T mass, T v, T rest) noexcept {
  return row.place(std::clamp(v, T(0), T(1)) * mass, rest * mass, mass);
}

/// M_D inverse: the fraction of the row's mass before a radius within the cell.
template <class T, class Row>
inline T fraction_before(const Row& row, T mass, const CellOfRow<T>& c, T r) noexcept {
  const T s = std::clamp((r - c.cell.r0) / c.cell.h, T(0), T(1));
  return mass > 0 ? std::min((row.before(c.j) + c.cell.mass(s)) / mass, T(1)) : T(0);
}

/// Both maps, from (u, v) in [0, 1]^2, and the density of the image. The gap is at least `least_gap`.
template <class T, class Lines>
inline PolarSample<T> sample_lines(const Lines& lines, T u, T v, T rest) noexcept {
  const T target = std::clamp(u, T(0), T(1)) * lines.before(lines.meridians() - 1);
  const Meridian<T> m = meridian_at_mass(lines, target);
  const RadialPlace<T> p = place_at(lines.row(m.i, m.a), m.mass, v, rest).off_end(least_gap<T>);
  return {{p.r(), m.phi, p.gap()}, p.density()};
}

/// The density at a position: one bilinear look-up.
template <class T, class Lines>
inline T pdf_of_lines(const Lines& lines, Polar<T> at) noexcept {
  const auto [i, a] = between_lines(lines.phi(), lines.meridians(), at.phi);
  const CellOfRow<T> c = lines.row(i, a).cell_at(at.r);
  return c.cell.density_at(at.r, at.gap, c.r1);
}

/// Both inverse maps. They exist everywhere; the pdf may be 0.
template <class T, class Lines>
inline PolarInverse<T> invert_lines(const Lines& lines, Polar<T> at) noexcept {
  const Meridian<T> m = meridian_at_angle(lines, at.phi);
  const auto row = lines.row(m.i, m.a);
  const CellOfRow<T> c = row.cell_at(at.r);
  return {std::min(mass_before(lines, m) / lines.before(lines.meridians() - 1), T(1)),
          fraction_before(row, m.mass, c, at.r), c.cell.density_at(at.r, at.gap, c.r1)};
}

/// A row whose densities and masses at `parallels` radii are sums of those of meridians: of one diagram, or of two.
/// `Sums` has density(j) and before(j).
template <class T, class Sums>
struct RowOfSums : Sums {
  const T* r;
  int parallels;

  RowOfSums(const Sums& sums, const T* radii, int count) noexcept : Sums(sums), r(radii), parallels(count) {}

  RadialCell<T> cell(int j) const noexcept { return {r[j], r[j + 1] - r[j], this->density(j), this->density(j + 1)}; }
  CellOfRow<T> cell_at(T radius) const noexcept {
    const int j = find_cell(r, parallels, radius);
    return {j, cell(j), r[j + 1]};
  }
  RadialPlace<T> place(T target, T beyond, T mass) const noexcept {  // eq. 18
    const int j = find_cell_of([this](int k) { return this->before(k); }, parallels, target);
    return RadialPlace<T>::of(cell(j), r[j + 1], target - this->before(j), beyond,
                              ends_mass(this->before(j + 1), mass));
  }
};

}  // namespace gonio
