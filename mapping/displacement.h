#pragma once

#include <optional>

#include <gonio/mapping/diagram.h>
#include <gonio/mapping/monotone_root.h>
#include <gonio/mapping/polar_map.h>

namespace gonio {

/// The displacement map between two diagrams: both map (u, v), and the images are interpolated by
/// alpha, as Havran et al. (2003, section 6.2) propose, in polar coordinates of the disk. The paper
/// gives no density. In these coordinates both maps are triangular and monotone, so is their convex
/// combination, and the density is exact:
///   pdf = 1 / (dphi_alpha/du  dr_alpha/dv  2 r_alpha),  both derivatives interpolated too.
///
/// A view: both diagrams must outlive it and have the same azimuth. u goes over that azimuth.
/// Thread safety: immutable; concurrent use is safe.
template <class T>
class Displacement {
 public:
  /// @param alpha in [0, 1]; 0 is `first`, 1 is `second`.
  Displacement(const Diagram<T>& first, const Diagram<T>& second, T alpha) noexcept
      : d0_(first), d1_(second), w0_(1 - alpha), w1_(alpha) {}

  /// (u, v) in [0, 1]^2 to the disk.
  PolarSample<T> sample(T u, T v) const noexcept {
    v = std::max(v, smallest_v);
    const Meridians m{d0_.meridian_at(u), d1_.meridian_at(u)};
    const auto p0 = d0_.parallel_at(m.first, v), p1 = d1_.parallel_at(m.second, v);
    const T r = w0_ * p0.r + w1_ * p1.r;
    return {{r, w0_ * m.first.phi + w1_ * m.second.phi}, density(m, p0, p1, r)};
  }

  /// The inverse of sample(), by one bracketed root search in u and one in v; the brackets are the
  /// closed-form inverses of the two diagrams. Empty where the map has no image: at directions that
  /// lie in the gap which a region of zero density leaves.
  std::optional<PolarInverse<T>> invert(Polar<T> at) const noexcept {
    const T u0 = d0_.u_of(d0_.meridian_through(at.phi)), u1 = d1_.u_of(d1_.meridian_through(at.phi));
    const T u = monotone_root(
        [&](T x) {
          const auto a = d0_.meridian_at(x), b = d1_.meridian_at(x);
          return Slope<T>{w0_ * a.phi + w1_ * b.phi, slope_phi(a, b)};
        },
        at.phi, std::min(u0, u1), std::max(u0, u1), pi<T> * std::numeric_limits<T>::epsilon());
    Meridians m{d0_.meridian_at(u), d1_.meridian_at(u)};
    const T phi_error = at.phi - (w0_ * m.first.phi + w1_ * m.second.phi);
    if (in_gap(phi_error, slope_phi(m.first, m.second))) return std::nullopt;
    if (std::abs(phi_error) > tolerance) {
      // Beside a meridian without mass u has too few digits for phi: the rest of the way goes without it.
      const T s0 = 1 / m.first.mass, s1 = 1 / m.second.mass, step = phi_error / (w0_ * s0 + w1_ * s1);
      if (std::isfinite(s0 * step) && std::isfinite(s1 * step))
        m = {d0_.meridian_through(m.first.phi + s0 * step), d1_.meridian_through(m.second.phi + s1 * step)};
    }

    // r rises like sqrt(v) at the pole: search in q = sqrt(v), where it is nearly straight.
    const T q0 = std::sqrt(d0_.v_of(m.first, at.r)), q1 = std::sqrt(d1_.v_of(m.second, at.r));
    const T q = monotone_root(
        [&](T x) {
          x = std::max(x, std::sqrt(smallest_v));
          const auto a = d0_.parallel_at(m.first, x * x), b = d1_.parallel_at(m.second, x * x);
          return Slope<T>{w0_ * a.r + w1_ * b.r, x * slope_r2(m, a, b)};
        },
        at.r, std::min(q0, q1), std::max(q0, q1), std::numeric_limits<T>::epsilon());
    const T v = std::max(q * q, smallest_v);
    // The map is infinitely steep at the horizon itself: seen from the float before it.
    const T before = std::min(v, 1 - std::numeric_limits<T>::epsilon() / 2);
    auto p0 = d0_.parallel_at(m.first, before), p1 = d1_.parallel_at(m.second, before);
    const T r_error = at.r - (w0_ * p0.r + w1_ * p1.r);
    if (in_gap(r_error, slope_r2(m, p0, p1) / 2)) return std::nullopt;
    if (std::abs(r_error) > tolerance) {
      // The same for v and r, where the density falls to 0: at the horizon of every reflection.
      const T s0 = m.first.mass / (p0.pdf * p0.r), s1 = m.second.mass / (p1.pdf * p1.r);
      const T step = r_error / (w0_ * s0 + w1_ * s1);
      if (std::isfinite(s0 * step) && std::isfinite(s1 * step)) {
        p0.r = std::clamp(p0.r + s0 * step, T(0), T(1)), p0.pdf = d0_.pdf(m.first, p0.r);
        p1.r = std::clamp(p1.r + s1 * step, T(0), T(1)), p1.pdf = d1_.pdf(m.second, p1.r);
      }
    }
    return PolarInverse<T>{u, v, density(m, p0, p1, w0_ * p0.r + w1_ * p1.r)};
  }

 private:
  using Meridian = typename Diagram<T>::Meridian;
  using Parallel = typename Diagram<T>::Parallel;
  struct Meridians {
    Meridian first, second;
  };

  // Keeps r positive, where the quotient of radii in the density is 0/0 otherwise.
  static constexpr T smallest_v = std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon();
  // A root is as good as phi and r are held.
  static constexpr T tolerance = 4 * std::numeric_limits<T>::epsilon();

  /// Whether a root misses its target by more than the rounding of u or v explains: the map jumps there.
  static bool in_gap(T error, T slope) noexcept {
    constexpr T epsilon = std::numeric_limits<T>::epsilon();
    return std::abs(error) > std::max(4096 * epsilon, 4 * epsilon * slope);
  }

  /// dphi_alpha/du; 0 stands for an infinite slope (a meridian without mass).
  T slope_phi(const Meridian& a, const Meridian& b) const noexcept {
    if ((w0_ > 0 && !(a.mass > 0)) || (w1_ > 0 && !(b.mass > 0))) return 0;
    return (w0_ > 0 ? w0_ * d0_.mass() / a.mass : T(0)) + (w1_ > 0 ? w1_ * d1_.mass() / b.mass : T(0));
  }

  /// The sum of w_k (dr_k^2/dv) / r_k, which is 2 dr_alpha/dv; 0 stands for infinite.
  T slope_r2(const Meridians& m, const Parallel& a, const Parallel& b) const noexcept {
    const T e0 = a.pdf * a.r, e1 = b.pdf * b.r;
    if ((w0_ > 0 && !(e0 > 0)) || (w1_ > 0 && !(e1 > 0))) return 0;
    return (w0_ > 0 ? w0_ * m.first.mass / e0 : T(0)) + (w1_ > 0 ? w1_ * m.second.mass / e1 : T(0));
  }

  T density(const Meridians& m, const Parallel& a, const Parallel& b, T r) const noexcept {
    const T jacobian = slope_phi(m.first, m.second) * slope_r2(m, a, b) * r;
    const T whole = d0_.azimuth() == Azimuth::half ? T(0.5) : T(1);
    return jacobian > 0 ? whole / jacobian : T(0);
  }

  const Diagram<T>&d0_, &d1_;
  T w0_, w1_;
};

}  // namespace gonio
