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

  /// A position on the sphere: the meridian cell and fraction, the parallel cell and fraction.
  struct Place {
    int i;     ///< between meridians i and i + 1
    T a;       ///< 0 at meridian i, 1 at i + 1
    T phi;     ///< [rad] in [0, 2 pi]
    T mass;    ///< integral of the pdf along the meridian: d(mass)/dphi
    int j;     ///< between parallels j and j + 1
    T radius;  ///< sqrt(1 - |cos theta|) in [0, 1]: from the pole of the place's own hemisphere
    T gap;     ///< 1 - radius, with digits next to the equator that radius has not
  };

  /// The map. u and v in [0, 1]; other values are clamped. Of a hemispherical grid, the gap is at least `least_gap`.
  Place at(T u, T v) const noexcept;
  /// The place of a direction. @param w a unit vector; below the equator of a hemispherical grid
  /// the place is on its edge.
  Place place_of(const Vec3<T>& w) const noexcept;
  /// The inverse map.
  SquarePoint<T> square_of(const Place& place) const noexcept;

  /// The direction of a place, a unit vector.
  Vec3<T> direction(const Place& place) const noexcept;
  /// The pdf per solid angle [1/sr] that the map realises: bilinear in phi and r.
  T pdf(const Place& place) const noexcept;
  /// The density that is linear in theta instead of r between the same values, in the units of
  /// pdf(): what the goniometric diagram of a luminaire means (Havran et al. 2003, eq. 4). Its
  /// quotient by pdf() is the correction factor of their section 6.1; 0 where both are 0.
  T theta_linear(const Place& place) const noexcept;

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

 private:
  const T* phi() const noexcept { return values_.data(); }
  const T* cumulative_phi() const noexcept { return phi() + meridians_; }
  const T* theta() const noexcept { return phi() + 2 * meridians_; }
  const T* radius() const noexcept { return theta() + parallels_; }
  const T* density(int i) const noexcept { return radius() + parallels_ + i * parallels_; }
  const T* cumulative(int i) const noexcept { return density(meridians_ + i); }
  T meridian_mass(int i) const noexcept { return cumulative(i)[parallels_ - 1]; }
  T density_at(const Place& p, int j) const noexcept { return (1 - p.a) * density(p.i)[j] + p.a * density(p.i + 1)[j]; }
  /// The cell j of a meridian, in its hemisphere's chart: beyond the equator it runs backwards.
  RadialCell<T> cell(const Place& p) const noexcept {
    const T d0 = density_at(p, p.j), d1 = density_at(p, p.j + 1);
    const T r0 = radius()[p.j], r1 = radius()[p.j + 1];
    return p.j < equator_ ? RadialCell<T>{r0, r1 - r0, d0, d1} : RadialCell<T>{r1, r0 - r1, d1, d0};
  }
  /// The radius at which it ends, towards the equator.
  T end_radius(int j) const noexcept { return radius()[j < equator_ ? j + 1 : j]; }

  int meridians_, parallels_, equator_;
  double scale_;
  std::vector<T> values_;  // phi | cumulative_phi | theta | radius | density | cumulative, one block
};

template <class T>
typename SphereDiagram<T>::Place SphereDiagram<T>::at(T u, T v) const noexcept {
  // Keeps draws off the poles themselves, where a density that falls to 0 is 0.
  constexpr T least = std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon();
  const DiskPoint<T> disk = square_to_disk(std::clamp(u, T(0), T(1)), std::clamp(v, T(0), T(1)));
  const T r2 = std::max(least, disk.r2), rest = std::max(least, disk.rest);
  Place p;
  // M_C: the meridian, as Diagram::meridian_at().
  const T* below = cumulative_phi();
  const T target_phi = disk.turn * below[meridians_ - 1];
  p.i = find_cell(below, meridians_, target_phi);
  const T m0 = meridian_mass(p.i), m1 = meridian_mass(p.i + 1);
  const T width = phi()[p.i + 1] - phi()[p.i];
  p.a = AzimuthCell<T>{width, m0, m1}.invert(target_phi - below[p.i]);
  p.phi = phi()[p.i] + p.a * width;
  p.mass = (1 - p.a) * m0 + p.a * m1;
  // M_D: the parallel, from pole to pole.
  const T target = r2 * p.mass;
  const T *u0 = cumulative(p.i), *u1 = cumulative(p.i + 1);
  const auto before = [&](int j) { return (1 - p.a) * u0[j] + p.a * u1[j]; };
  p.j = find_cell_of(before, parallels_, target);
  // The mass of the cell on either side of the draw. In the last cell with mass, that behind it is known to all digits.
  const RadialCell<T> c = cell(p);
  const bool last = ends_mass(before(p.j + 1), p.mass);
  const T inside = target - before(p.j), behind = last ? rest * p.mass : c.mass(1) - inside;
  // Beyond the equator the cell runs backwards.
  const bool near = p.j < equator_;
  auto place = RadialPlace<T>::of(c, end_radius(p.j), near ? inside : behind, behind, near && last).off_end(least_gap);
  if (!near && last && c.r0 > 0) place.s = std::max(place.s, std::min(RadialPlace<T>::inside() / c.h, T(1)));
  p.radius = place.r(), p.gap = std::max(place.gap(), T(0));
  return p;
}

template <class T>
typename SphereDiagram<T>::Place SphereDiagram<T>::place_of(const Vec3<T>& w) const noexcept {
  Place p;
  const T angle = std::atan2(w.y, w.x);
  p.phi = angle < 0 ? angle + 2 * pi<T> : angle;
  p.i = find_cell(phi(), meridians_, p.phi);
  p.a = std::clamp((p.phi - phi()[p.i]) / (phi()[p.i + 1] - phi()[p.i]), T(0), T(1));
  p.mass = (1 - p.a) * meridian_mass(p.i) + p.a * meridian_mass(p.i + 1);
  const bool near = w.z >= 0 || hemisphere();
  // 1 - |cos| as sin^2 / (1 + |cos|): no digits lost next to the poles.
  p.radius = w.z < 0 && near ? T(1) : std::min(std::sqrt((w.x * w.x + w.y * w.y) / (1 + std::abs(w.z))), T(1));
  p.gap = w.z < 0 && near ? T(0) : std::abs(w.z) / (1 + p.radius);
  if (hemisphere()) p.gap = std::max(least_gap, p.gap);
  const T* r = radius();
  if (near) {
    p.j = find_cell(r, equator_ + 1, p.radius);
  } else {
    int first = equator_;
    for (int length = parallels_ - 1 - equator_; length > 1;) {
      const int half = length / 2;
      first = r[first + half] > p.radius ? first + half : first;
      length -= half;
    }
    p.j = first;
  }
  return p;
}

template <class T>
SquarePoint<T> SphereDiagram<T>::square_of(const Place& p) const noexcept {
  const T width = phi()[p.i + 1] - phi()[p.i];
  const T inside = p.a * width * (meridian_mass(p.i) + p.mass) / 2;
  const T turn = (cumulative_phi()[p.i] + inside) / cumulative_phi()[meridians_ - 1];
  const RadialCell<T> c = cell(p);
  const T *u0 = cumulative(p.i), *u1 = cumulative(p.i + 1);
  const bool near = p.j < equator_;
  // Counted from the line of the cell that lies nearer to its pole, where little mass is taken
  // from.
  const int from = near ? p.j : p.j + 1;
  const T s = std::clamp((p.radius - c.r0) / c.h, T(0), T(1));
  const T mass = (1 - p.a) * u0[from] + p.a * u1[from] + (near ? c.mass(s) : -c.mass(s));
  const T r2 = p.mass > 0 ? std::clamp(mass / p.mass, T(0), T(1)) : T(0);
  return disk_to_square(DiskPoint<T>{turn < 1 ? turn : T(0), r2});
}

template <class T>
Vec3<T> SphereDiagram<T>::direction(const Place& p) const noexcept {
  Vec3<T> w = polar_to_direction(Polar<T>{p.radius, p.phi, p.gap});
  if (p.j >= equator_) w.z = -w.z;
  return w;
}

template <class T>
T SphereDiagram<T>::pdf(const Place& p) const noexcept {
  return cell(p).density_at(p.radius, p.gap, end_radius(p.j));
}

template <class T>
T SphereDiagram<T>::theta_linear(const Place& p) const noexcept {
  // In the hemisphere's own chart, from the end of the cell that is nearer: poles and equator are exact.
  const bool near = p.j < equator_;
  const RadialCell<T> c = cell(p);
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
