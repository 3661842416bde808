#pragma once

#include <gonio/mapping/charts/polar_map.h>
#include <gonio/mapping/diagram/diagram.h>

namespace gonio {

/// The map of the linear blend (1 - alpha) d0 + alpha d1 of two diagrams on the same lines. The blend is
/// itself a bilinear density on these lines and its cumulative arrays are the blends of theirs, so that
/// it is sampled and inverted as one diagram is (see Diagram): in closed form, without iteration and
/// without a third random number, and continuous in (u, v) and alpha. A lobe that moves between the
/// diagrams is blended into two; the half-vector chart keeps it in place.
///
/// A view: both diagrams must outlive it, and have the same azimuth and lines. u goes over that azimuth.
/// Errors: those of Diagram, with 1 epsilon more. Thread safety: immutable; concurrent use is safe.
template <class T>
class Blend {
 public:
  /// @param alpha in [0, 1]; 0 is `first`, 1 is `second`.
  Blend(const Diagram<T>& first, const Diagram<T>& second, T alpha) noexcept
      : d0_(first), d1_(second), w0_(1 - alpha), w1_(alpha) {}

  /// (u, v) in [0, 1]^2 to the disk. @param rest 1 - v, see Diagram::parallel_at().
  PolarSample<T> sample(T u, T v, T rest) const noexcept {
    const int count = d0_.meridians_;
    const T *c0 = d0_.cumulative_phi(), *c1 = d1_.cumulative_phi();
    const T angle = std::clamp(u, T(0), T(1)) * mix(c0[count - 1], c1[count - 1]);
    const int i = find_cell_of([=, w0 = w0_, w1 = w1_](int k) { return w0 * c0[k] + w1 * c1[k]; }, count, angle);
    const T* phi = d0_.phi();
    const AzimuthCell<T> across{phi[i + 1] - phi[i], meridian_mass(i), meridian_mass(i + 1)};
    const T a = across.invert(angle - mix(c0[i], c1[i]));
    const Rows rows = rows_at(i, a);

    const int last = d0_.parallels_ - 1;
    const T mass = rows.cumulative(last), target = std::clamp(v, T(0), T(1)) * mass;
    const int j = find_cell_of([&](int k) { return rows.cumulative(k); }, last + 1, target);
    const auto p = RadialPlace<T>::of(radial_cell(rows, j), d0_.r()[j + 1], target - rows.cumulative(j), rest * mass,
                                      ends_mass(rows.cumulative(j + 1), mass))
                       .off_end(least_gap<T>);
    return {{p.r(), phi[i] + a * across.width, p.gap()}, p.density()};
  }

  /// The density at a position: one bilinear look-up of the blend.
  T pdf(Polar<T> at) const noexcept {
    const auto m = d0_.meridian_through(at.phi);
    const int j = find_cell(d0_.r(), d0_.parallels_, at.r);
    return radial_cell(rows_at(m.i, m.a), j).density_at(at.r, at.gap, d0_.r()[j + 1]);
  }

  /// The inverse of sample(), exists everywhere; its pdf may be 0.
  PolarInverse<T> invert(Polar<T> at) const noexcept {
    const auto m = d0_.meridian_through(at.phi);
    const T* phi = d0_.phi();
    const Rows rows = rows_at(m.i, m.a);
    const int last = d0_.parallels_ - 1, j = find_cell(d0_.r(), d0_.parallels_, at.r);
    const T mass = rows.cumulative(last);
    const T inside = m.a * (phi[m.i + 1] - phi[m.i]) * (meridian_mass(m.i) + mass) / 2;
    const T below = mix(d0_.cumulative_phi()[m.i], d1_.cumulative_phi()[m.i]);
    const RadialCell<T> cell = radial_cell(rows, j);
    const T s = std::clamp((at.r - cell.r0) / cell.h, T(0), T(1));
    const T v = mass > 0 ? std::min((rows.cumulative(j) + cell.mass(s)) / mass, T(1)) : T(0);
    return {std::min((below + inside) / mix(d0_.mass(), d1_.mass()), T(1)), v,
            cell.density_at(at.r, at.gap, d0_.r()[j + 1])};
  }

 private:
  T mix(T a, T b) const noexcept { return w0_ * a + w1_ * b; }
  T meridian_mass(int i) const noexcept { return mix(d0_.meridian_mass(i), d1_.meridian_mass(i)); }

  /// The rows of both diagrams on either side of a meridian, and their weights.
  struct Rows {
    const T *a0, *a1, *b0, *b1;  // densities; the cumulative rows lie `stride` behind them
    T wa0, wa1, wb0, wb1;
    int stride;

    T density(int j) const noexcept { return wa0 * a0[j] + wa1 * a1[j] + wb0 * b0[j] + wb1 * b1[j]; }
    T cumulative(int j) const noexcept { return density(stride + j); }
  };
  Rows rows_at(int i, T a) const noexcept {
    return {d0_.density(i),
            d0_.density(i + 1),
            d1_.density(i),
            d1_.density(i + 1),
            w0_ * (1 - a),
            w0_ * a,
            w1_ * (1 - a),
            w1_ * a,
            d0_.meridians_ * d0_.parallels_};
  }
  RadialCell<T> radial_cell(const Rows& rows, int j) const noexcept {
    const T* r = d0_.r();
    return {r[j], r[j + 1] - r[j], rows.density(j), rows.density(j + 1)};
  }

  const Diagram<T>&d0_, &d1_;
  T w0_, w1_;
};

}  // namespace gonio
