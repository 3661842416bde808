#pragma once

#include <cstddef>
#include <vector>

#include <gonio/mapping/charts/concentric.h>
#include <gonio/mapping/diagram/diagram.h>

namespace gonio {

/// A goniometric diagram on the sphere as data: densities at the crossings of M meridians and N
/// parallels, any positive scale.
struct SphereGrid {
  std::vector<double> phi;      ///< M >= 2 meridians [rad], ascending from 0 to 2 pi; the last repeats the first
  std::vector<double> theta;    ///< N >= 2 parallels [rad], ascending from 0 to pi/2 or pi, with one at pi/2
  std::vector<double> density;  ///< M x N, meridian-major, finite and >= 0, per solid angle
};

/// The extension of the goniometric diagram mapping to the whole sphere (the future work of Havran
/// et al. 2003): unit square -> disk -> sphere, forward and inverse, with an exact pdf.
///
/// One spherical map instead of two hemispheres: phi inverts the marginal of the whole sphere, and
/// the disk's radius the conditional along the whole meridian from one pole to the other. Each
/// hemisphere has the chart r = sqrt(1 - |cos theta|) of its own pole, in which solid angles are
/// areas (dw = 2 r dr dphi) and the density is bilinear in phi and r; at the equator the two agree.
/// So the map is continuous, also across the equator, where two separate hemispheres would not
/// meet. The circle that bounds the disk is the far pole: the inverse is continuous everywhere but
/// at that one point, and no map of a square onto a sphere can do better. A grid that ends at pi/2
/// is a diagram of the hemisphere, at its cost.
///
/// Local frame: theta = 0 is +z, phi = 0 is +x.
///
/// Memory: 2 M N + 2 M + 2 N values of T. Thread safety: immutable; concurrent use is safe.
template <class T>
class SphereDiagram {
 public:
  /// @throws Error if lines are not ascending over the stated ranges, there is no parallel at pi/2,
  ///   sizes do not match, a density is negative or not finite, or all are zero.
  explicit SphereDiagram(const SphereGrid& grid);

  /// A position on the sphere.
  struct Position {
    Meridian<T> meridian;  ///< phi in [0, 2 pi]
    int j;                 ///< between parallels j and j + 1
    T radius;              ///< sqrt(1 - |cos theta|) in [0, 1]: from the pole of the position's own hemisphere
    T gap;                 ///< 1 - radius, with digits next to the equator that radius has not
  };

  /// The map. u and v in [0, 1]; other values are clamped. Of a hemispherical grid, the gap is at least `least_gap`.
  Position at(T u, T v) const noexcept;
  /// The position of a direction. @param w a unit vector; below the equator of a hemispherical grid
  /// the position is on its edge.
  Position position_of(const Vec3<T>& w) const noexcept;
  /// The inverse map.
  SquarePoint<T> square_of(const Position& position) const noexcept;

  /// The direction of a position, a unit vector.
  Vec3<T> direction(const Position& position) const noexcept;
  /// The pdf per solid angle [1/sr] that the map realises: bilinear in phi and r.
  T pdf(const Position& position) const noexcept;
  /// The density that is linear in theta instead of r between the same values, in the units of
  /// pdf(): what the goniometric diagram of a luminaire means (Havran et al. 2003, eq. 4). Its
  /// quotient by pdf() is the correction factor of their section 6.1; 0 where both are 0.
  T theta_linear(const Position& position) const noexcept;

  /// True if the grid covers one hemisphere.
  bool hemisphere() const noexcept { return equator_ == parallels_ - 1; }
  /// Directions nearer to the edge of a hemispherical grid count as that far from it. A direction that was turned
  /// in space holds its distance to the edge to a rounding error of 1: this is some hundred of them.
  static constexpr T least_gap = 32 * std::numeric_limits<T>::epsilon();
  int meridians() const noexcept { return meridians_; }
  int parallels() const noexcept { return parallels_; }
  /// What one unit of the grid's density is in units of pdf().
  double scale() const noexcept { return scale_; }
  std::size_t bytes() const noexcept { return sizeof(*this) + values_.capacity() * sizeof(T); }

  /// What the maps read, see inversion.h.
  const T* phi() const noexcept { return values_.data(); }
  T before(int i) const noexcept { return phi()[meridians_ + i]; }
  T along(int i) const noexcept { return cumulative(i)[parallels_ - 1]; }

 private:
  const T* theta() const noexcept { return phi() + 2 * meridians_; }
  const T* radius() const noexcept { return theta() + parallels_; }
  const T* density(int i) const noexcept { return radius() + parallels_ + i * parallels_; }
  const T* cumulative(int i) const noexcept { return density(meridians_ + i); }
  T density_at(const Meridian<T>& m, int j) const noexcept {
    return (1 - m.a) * density(m.i)[j] + m.a * density(m.i + 1)[j];
  }
  T mass_before_parallel(const Meridian<T>& m, int j) const noexcept {
    return (1 - m.a) * cumulative(m.i)[j] + m.a * cumulative(m.i + 1)[j];
  }
  /// The cell j of a meridian, in its hemisphere's chart: beyond the equator it runs backwards.
  RadialCell<T> cell(const Meridian<T>& m, int j) const noexcept {
    const T d0 = density_at(m, j), d1 = density_at(m, j + 1);
    const T r0 = radius()[j], r1 = radius()[j + 1];
    return j < equator_ ? RadialCell<T>{r0, r1 - r0, d0, d1} : RadialCell<T>{r1, r0 - r1, d1, d0};
  }
  /// The radius at which it ends, towards the equator.
  T end_radius(int j) const noexcept { return radius()[j < equator_ ? j + 1 : j]; }

  int meridians_, parallels_, equator_;
  double scale_;
  std::vector<T> values_;  // phi | mass before each meridian | theta | radius | density | cumulative, one block
};

template <class T>
typename SphereDiagram<T>::Position SphereDiagram<T>::at(T u, T v) const noexcept {
  // Keeps draws off the poles themselves, where a density that falls to 0 is 0.
  constexpr T least = std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon();
  const DiskPoint<T> disk = square_to_disk(std::clamp(u, T(0), T(1)), std::clamp(v, T(0), T(1)));
  const T r2 = std::max(least, disk.r2), rest = std::max(least, disk.rest);
  const Meridian<T> m = meridian_at_mass(*this, disk.turn * before(meridians_ - 1));
  // The parallel, from pole to pole.
  const T target = r2 * m.mass;
  const auto mass_to = [&](int k) { return mass_before_parallel(m, k); };
  const int j = find_cell_of(mass_to, parallels_, target);
  // The mass of the cell on either side of the draw. In the last cell with mass, that behind it is known to all digits.
  const RadialCell<T> c = cell(m, j);
  const bool last = ends_mass(mass_to(j + 1), m.mass);
  const T inside = target - mass_to(j), behind = last ? rest * m.mass : c.mass(1) - inside;
  // Beyond the equator the cell runs backwards.
  const bool near = j < equator_;
  auto place = RadialPlace<T>::of(c, end_radius(j), near ? inside : behind, behind, near && last).off_end(least_gap);
  if (!near && last && c.r0 > 0) place.s = std::max(place.s, std::min(RadialPlace<T>::inside() / c.h, T(1)));
  return {m, j, place.r(), std::max(place.gap(), T(0))};
}

template <class T>
typename SphereDiagram<T>::Position SphereDiagram<T>::position_of(const Vec3<T>& w) const noexcept {
  Position p;
  const T angle = std::atan2(w.y, w.x);
  p.meridian = meridian_at_angle(*this, angle < 0 ? angle + 2 * pi<T> : angle);
  const bool near = w.z >= 0 || hemisphere();
  // 1 - |cos| as sin^2 / (1 + |cos|): no digits lost next to the poles.
  p.radius = w.z < 0 && near ? T(1) : std::min(std::sqrt((w.x * w.x + w.y * w.y) / (1 + std::abs(w.z))), T(1));
  p.gap = w.z < 0 && near ? T(0) : std::abs(w.z) / (1 + p.radius);
  if (hemisphere()) p.gap = std::max(least_gap, p.gap);
  const T* r = radius();
  // Beyond the equator the radii descend.
  p.j = near ? find_cell(r, equator_ + 1, p.radius)
             : equator_ + find_cell_of([r = r + equator_](int k) { return -r[k]; }, parallels_ - equator_, -p.radius);
  return p;
}

template <class T>
SquarePoint<T> SphereDiagram<T>::square_of(const Position& p) const noexcept {
  const Meridian<T>& m = p.meridian;
  const T turn = mass_before(*this, m) / before(meridians_ - 1);
  const RadialCell<T> c = cell(m, p.j);
  const bool near = p.j < equator_;
  // Counted from the line of the cell that lies nearer to its pole, where little mass is taken from.
  const int from = near ? p.j : p.j + 1;
  const T s = std::clamp((p.radius - c.r0) / c.h, T(0), T(1));
  const T mass = mass_before_parallel(m, from) + (near ? c.mass(s) : -c.mass(s));
  const T r2 = m.mass > 0 ? std::clamp(mass / m.mass, T(0), T(1)) : T(0);
  return disk_to_square(DiskPoint<T>{turn < 1 ? turn : T(0), r2});
}

template <class T>
Vec3<T> SphereDiagram<T>::direction(const Position& p) const noexcept {
  Vec3<T> w = polar_to_direction(Polar<T>{p.radius, p.meridian.phi, p.gap});
  if (p.j >= equator_) w.z = -w.z;
  return w;
}

template <class T>
T SphereDiagram<T>::pdf(const Position& p) const noexcept {
  return cell(p.meridian, p.j).density_at(p.radius, p.gap, end_radius(p.j));
}

template <class T>
T SphereDiagram<T>::theta_linear(const Position& p) const noexcept {
  // In the hemisphere's own chart, from the end of the cell that is nearer: poles and equator are exact.
  const bool near = p.j < equator_;
  const RadialCell<T> c = cell(p.meridian, p.j);
  const T start = near ? theta()[p.j] : pi<T> - theta()[p.j + 1], end = near ? theta()[p.j + 1] : pi<T> - theta()[p.j];
  const bool at_equator = (near ? p.j + 1 : p.j) == equator_;
  const T angle = radius_to_theta(p.radius), width = end - start;
  const T s = std::clamp((angle - start) / width, T(0), T(1));
  const T t = std::clamp((at_equator ? elevation(p.gap) : end - angle) / width, T(0), T(1));
  return t < T(0.5) ? (1 - t) * c.d1 + t * c.d0 : c.density(s);
}

extern template class SphereDiagram<float>;
extern template class SphereDiagram<double>;

}  // namespace gonio
