#pragma once

#include <cstddef>
#include <vector>

#include <gonio/mapping/charts/hemisphere.h>
#include <gonio/mapping/diagram/azimuth_cell.h>
#include <gonio/mapping/diagram/radial_cell.h>
#include <gonio/mapping/numeric/find_cell.h>

namespace gonio {

/// How much of the azimuth a diagram stores.
enum class Azimuth {
  half,  ///< [0, pi], mirrored to negative phi: isotropic BRDFs
  full   ///< [0, 2 pi]: anything else; the last meridian repeats the first
};

/// A goniometric diagram as data: densities at the crossings of M meridians and N parallels, any
/// positive scale. Between them the density is bilinear in phi and r.
struct DiagramGrid {
  Azimuth azimuth = Azimuth::half;
  std::vector<double> phi;      ///< M >= 2 meridians, ascending, from 0 to pi (half) or 2 pi (full)
  std::vector<double> r;        ///< N >= 2 parallels as r = sqrt(1 - cos theta), ascending, from 0 to 1
  std::vector<double> density;  ///< M x N, meridian-major, finite and >= 0, in 1/sr up to a factor

  double& at(std::size_t meridian, std::size_t parallel) { return density[meridian * r.size() + parallel]; }
  double at(std::size_t meridian, std::size_t parallel) const { return density[meridian * r.size() + parallel]; }
};

/// One diagram ready to be sampled: the maps M_C and M_D of Havran et al. (2003), forward and
/// inverse, as the inverse-CDF maps that they are (marginal in phi, conditional in r).
///
/// Both stages take uniform numbers in [0, 1]: `u` goes over the stored azimuth (half or full), `v`
/// is r_B^2. The density of the image is the stored density over its integral: pdf() is exact.
/// No map iterates; each does one search over the lines and a fixed number of operations.
///
/// Maximum errors, against exact arithmetic on the same lines and densities, epsilon being that of T:
/// - forward maps: the mass below the position given, taken exactly at one of the values of T next to it,
///   differs from the mass asked for by 16 epsilon of the whole, for any grid;
/// - u_of() 4 epsilon, v_of() 8 epsilon, absolute;
/// - pdf() 4 epsilon times the largest density, and 16 epsilon relative to the bilinear density at a
///   position within 4 epsilon of the one given.
///
/// Memory: 2 M N + 2 M + N values of T (the paper's 2 M N + 3 M + 2 without the array that its
/// radius compensation, eq. 27, needs).
///
/// Thread safety: immutable; concurrent use is safe.
template <class T>
class Diagram {
 public:
  /// Normalises `grid` to a pdf per solid angle over the whole hemisphere and precomputes the
  /// cumulative arrays, from the values as rounded to T, in at least double.
  /// @throws Error if lines are not ascending over the stated range, sizes do not match, a density
  ///   is negative or not finite, or all are zero.
  explicit Diagram(const DiagramGrid& grid);

  /// A position between the meridians i and i + 1, and the marginal density there.
  struct Meridian {
    int i;
    T a;     ///< 0 at meridian i, 1 at i + 1
    T phi;   ///< [rad], in the stored range
    T mass;  ///< integral of the pdf over r (2 r dr): d(mass)/dphi
  };
  /// A position along a meridian, and the pdf [1/sr] there.
  struct Parallel {
    T r = T(0), pdf = T(0), gap = 1 - r;  ///< gap: see Polar
  };

  /// M_C forward, eqs. 20-25: the meridian below which the fraction u of the mass lies. The
  /// quadratic (eq. 24) is solved in the form without cancellation. u outside [0, 1] is clamped.
  Meridian meridian_at(T u) const noexcept;
  /// The meridian through `phi`, clamped to the stored range.
  Meridian meridian_through(T phi) const noexcept;
  /// M_C inverse: the u of a meridian.
  T u_of(const Meridian& m) const noexcept;

  /// M_D forward, eqs. 10-19: the radius below which the fraction v of the meridian's mass lies. `rest` is 1 - v, to
  /// as many digits as are known: next to the horizon they decide. The gap is at least `least_gap`.
  Parallel parallel_at(const Meridian& m, T v, T rest) const noexcept;
  Parallel parallel_at(const Meridian& m, T v) const noexcept { return parallel_at(m, v, 1 - v); }
  /// M_D inverse: the v of radius r, clamped to [0, 1].
  T v_of(const Meridian& m, T r) const noexcept;
  /// The pdf [1/sr] on a meridian at radius r, clamped to [0, 1], and its gap.
  T pdf(const Meridian& m, T r, T gap) const noexcept;
  T pdf(const Meridian& m, T r) const noexcept { return pdf(m, r, 1 - r); }

  /// The mass of the stored azimuth: 1/2 for half diagrams, 1 for full ones, to rounding.
  T mass() const noexcept { return cumulative_phi()[meridians_ - 1]; }
  Azimuth azimuth() const noexcept { return azimuth_; }
  int meridians() const noexcept { return meridians_; }
  int parallels() const noexcept { return parallels_; }
  std::size_t bytes() const noexcept { return sizeof(*this) + values_.capacity() * sizeof(T); }

  /// The lines and normalised densities; building a diagram from them gives this one again, bit by bit.
  DiagramGrid grid() const;

  /// All that the maps read, as one block: phi (M), mass up to each meridian (M), r (N), density (M x N),
  /// mass along each meridian up to each parallel (M x N).
  const std::vector<T>& values() const noexcept { return values_; }

  /// Whether the meridians and parallels of another diagram are the same.
  bool same_lines(const Diagram& other) const noexcept;

 private:
  template <class U>
  friend class Blend;
  template <class U>
  friend class Displacement;

  const T* phi() const noexcept { return values_.data(); }
  const T* cumulative_phi() const noexcept { return phi() + meridians_; }
  const T* r() const noexcept { return phi() + 2 * meridians_; }
  const T* density(int i) const noexcept { return r() + parallels_ + i * parallels_; }
  /// U(i, j) of eq. 19: the mass of meridian i up to parallel j.
  const T* cumulative(int i) const noexcept { return density(meridians_ + i); }
  T meridian_mass(int i) const noexcept { return cumulative(i)[parallels_ - 1]; }
  RadialPlace<T> place_at(const Meridian& m, T v, T rest) const noexcept;

  Azimuth azimuth_;
  int meridians_, parallels_;
  std::vector<T> values_;  // phi | cumulative_phi | r | density | cumulative, one block
};

/// Whether a cell that ends with the mass `below` before its end is the last one with mass of a meridian with `mass`,
/// to rounding.
template <class T>
bool ends_mass(T below, T mass) noexcept {
  return below >= mass * (1 - 2 * std::numeric_limits<T>::epsilon());
}

template <class T>
typename Diagram<T>::Meridian Diagram<T>::meridian_at(T u) const noexcept {
  const T target = std::clamp(u, T(0), T(1)) * mass();
  const int i = find_cell(cumulative_phi(), meridians_, target);
  const T m0 = meridian_mass(i), m1 = meridian_mass(i + 1);
  const T width = phi()[i + 1] - phi()[i];
  const T a = AzimuthCell<T>{width, m0, m1}.invert(target - cumulative_phi()[i]);
  return {i, a, phi()[i] + a * width, (1 - a) * m0 + a * m1};
}

template <class T>
typename Diagram<T>::Meridian Diagram<T>::meridian_through(T angle) const noexcept {
  const int i = find_cell(phi(), meridians_, angle);
  const T width = phi()[i + 1] - phi()[i];
  const T a = std::clamp((angle - phi()[i]) / width, T(0), T(1));
  return {i, a, phi()[i] + a * width, (1 - a) * meridian_mass(i) + a * meridian_mass(i + 1)};
}

template <class T>
T Diagram<T>::u_of(const Meridian& m) const noexcept {
  const T width = phi()[m.i + 1] - phi()[m.i];
  const T inside = m.a * width * (meridian_mass(m.i) + m.mass) / 2;
  return std::min((cumulative_phi()[m.i] + inside) / mass(), T(1));
}

template <class T>
RadialPlace<T> Diagram<T>::place_at(const Meridian& m, T v, T rest) const noexcept {
  const T target = std::clamp(v, T(0), T(1)) * m.mass;
  const T *u0 = cumulative(m.i), *u1 = cumulative(m.i + 1);
  const T a = m.a, b = 1 - a;
  const int j = find_cell_of([=](int k) { return b * u0[k] + a * u1[k]; }, parallels_, target);  // eq. 18
  const T *d0 = density(m.i), *d1 = density(m.i + 1);
  const RadialCell<T> cell{r()[j], r()[j + 1] - r()[j], b * d0[j] + a * d1[j], b * d0[j + 1] + a * d1[j + 1]};
  return RadialPlace<T>::of(cell, r()[j + 1], target - (b * u0[j] + a * u1[j]), rest * m.mass,
                            ends_mass(b * u0[j + 1] + a * u1[j + 1], m.mass));
}

template <class T>
typename Diagram<T>::Parallel Diagram<T>::parallel_at(const Meridian& m, T v, T rest) const noexcept {
  const RadialPlace<T> p = place_at(m, v, rest).off_end(least_gap<T>);
  return {p.r(), p.density(), p.gap()};
}

template <class T>
T Diagram<T>::v_of(const Meridian& m, T radius) const noexcept {
  const int j = find_cell(r(), parallels_, radius);
  const T a = m.a, b = 1 - a;
  const T *d0 = density(m.i), *d1 = density(m.i + 1);
  const RadialCell<T> cell{r()[j], r()[j + 1] - r()[j], b * d0[j] + a * d1[j], b * d0[j + 1] + a * d1[j + 1]};
  const T s = std::clamp((radius - cell.r0) / cell.h, T(0), T(1));
  const T below = b * cumulative(m.i)[j] + a * cumulative(m.i + 1)[j];
  return m.mass > 0 ? std::min((below + cell.mass(s)) / m.mass, T(1)) : T(0);
}

template <class T>
T Diagram<T>::pdf(const Meridian& m, T radius, T gap) const noexcept {
  const int j = find_cell(r(), parallels_, radius);
  const T *d0 = density(m.i), *d1 = density(m.i + 1);
  const T a = m.a, b = 1 - a;
  const RadialCell<T> cell{r()[j], r()[j + 1] - r()[j], b * d0[j] + a * d1[j], b * d0[j + 1] + a * d1[j + 1]};
  return cell.density_at(radius, gap, r()[j + 1]);
}

extern template class Diagram<float>;
extern template class Diagram<double>;
extern template class Diagram<long double>;

}  // namespace gonio
