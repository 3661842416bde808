#pragma once

#include <cstddef>
#include <vector>

#include <gonio/mapping/diagram/inversion.h>

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
/// - u of invert() 4 epsilon, v 8 epsilon, absolute;
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

  /// (u, v) in [0, 1]^2 to the disk; other values are clamped. @param rest 1 - v, to as many digits as are known: next
  /// to the horizon they decide. The gap is at least `least_gap`.
  PolarSample<T> sample(T u, T v, T rest) const noexcept { return sample_lines(*this, u, v, rest); }
  PolarSample<T> sample(T u, T v) const noexcept { return sample(u, v, 1 - v); }

  /// The density at a position, clamped to the stored range.
  T pdf(Polar<T> at) const noexcept { return pdf_of_lines(*this, at); }

  /// The inverse of sample(), exists everywhere; its pdf may be 0.
  PolarInverse<T> invert(Polar<T> at) const noexcept { return invert_lines(*this, at); }

  /// The mass of the stored azimuth: 1/2 for half diagrams, 1 for full ones, to rounding.
  T mass() const noexcept { return before(meridians_ - 1); }
  Azimuth azimuth() const noexcept { return azimuth_; }
  int meridians() const noexcept { return meridians_; }
  int parallels() const noexcept { return parallels_; }
  std::size_t bytes() const noexcept { return sizeof(*this) + values_.capacity() * sizeof(T); }

  /// The lines and normalised densities; building a diagram from them gives this one again, bit by bit.
  DiagramGrid grid() const;

  /// Whether the meridians and parallels of another diagram are the same.
  bool same_lines(const Diagram& other) const noexcept;

  const T* phi() const noexcept { return values_.data(); }
  const T* r() const noexcept { return phi() + 2 * meridians_; }
  T before(int i) const noexcept { return phi()[meridians_ + i]; }         ///< the mass before a meridian
  T along(int i) const noexcept { return cumulative(i)[parallels_ - 1]; }  ///< the mass along it, U(i, N) of eq. 19
  const T* density(int i) const noexcept { return r() + parallels_ + i * parallels_; }
  /// U(i, j) of eq. 19: the mass of meridian i up to parallel j.
  const T* cumulative(int i) const noexcept { return density(meridians_ + i); }

  /// What lies along a position between two meridians, see inversion.h.
  struct Sums {
    const T *density0, *density1, *cumulative0, *cumulative1;
    T w0, w1;

    T density(int j) const noexcept { return w0 * density0[j] + w1 * density1[j]; }
    T before(int j) const noexcept { return w0 * cumulative0[j] + w1 * cumulative1[j]; }
  };
  RowOfSums<T, Sums> row(int i, T a) const noexcept {
    return {{density(i), density(i + 1), cumulative(i), cumulative(i + 1), 1 - a, a}, r(), parallels_};
  }

 private:
  Azimuth azimuth_;
  int meridians_, parallels_;
  std::vector<T> values_;  // phi | mass before each meridian | r | density | cumulative, one block
};

extern template class Diagram<float>;
extern template class Diagram<double>;
extern template class Diagram<long double>;

}  // namespace gonio
