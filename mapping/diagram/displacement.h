#pragma once

#include <gonio/mapping/diagram/diagram.h>
#include <gonio/mapping/numeric/monotone_root.h>

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

  /// (u, v) in [0, 1]^2 to the disk. @param rest 1 - v, see Diagram::sample().
  PolarSample<T> sample(T u, T v, T rest) const noexcept {
    v = std::max(smallest_v, v);
    const T before = std::clamp(u, T(0), T(1));
    const Meridians m{meridian_at_mass(d0_, before * d0_.mass()), meridian_at_mass(d1_, before * d1_.mass())};
    const RadialPlace<T> p0 = place_at(d0_.row(m.first.i, m.first.a), m.first.mass, v, rest).off_end(0),
                         p1 = place_at(d1_.row(m.second.i, m.second.a), m.second.mass, v, rest).off_end(0);
    const T r = w0_ * p0.r() + w1_ * p1.r(), gap = w0_ * p0.gap() + w1_ * p1.gap(),
            phi = w0_ * m.first.phi + w1_ * m.second.phi;
    if (rest < tail || gap < least_gap<T>) {
      const Polar<T> at{std::min(r, 1 - least_gap<T>), phi, std::max(gap, least_gap<T>)};
      return {at, invert(at).pdf};
    }
    return {{r, phi, gap}, density(m, {p0.r(), p0.density()}, {p1.r(), p1.density()}, r)};
  }

  /// The inverse of sample(): exists everywhere; its pdf is 0 in the gap which a region of zero density leaves.
  ///
  /// The two positions that are interpolated to `at` have the same mass before them in their diagrams. Mass is a
  /// polynomial of the position within a cell, cheaper than its inverse: so the positions are what is searched
  /// for, by one root search in phi and one in r, and u and v are the masses found. In the outer half of the
  /// hemisphere gaps and the masses beyond are taken instead of radii and the masses before: next to the horizon
  /// these are the small numbers.
  PolarInverse<T> invert(Polar<T> at) const noexcept {
    Across a0{d0_}, a1{d1_};
    balance(a0, a1, at.phi, d0_.azimuth() == Azimuth::half ? pi<T> : 2 * pi<T>);
    const Meridians m{a0.at, a1.at};
    const T r = std::max(at.r, std::numeric_limits<T>::epsilon());  // the density is a quotient of radii
    const bool outer = r * r > T(0.5);
    Along b0(d0_, m.first, outer), b1(d1_, m.second, outer);
    balance(b0, b1, outer ? at.gap : r, T(1));
    const T v = mass(b0, b1);
    return {mass(a0, a1), outer ? 1 - v : v, density(m, {b0.at.r(), b0.at.density()}, {b1.at.r(), b1.at.density()}, r)};
  }

 private:
  struct Parallel {
    T r, pdf;
  };
  struct Meridians {
    Meridian<T> first, second;
  };

  // Keeps r positive, where the quotient of radii in the density is 0/0 otherwise.
  static constexpr T smallest_v = std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon();
  // Of 1 - v. With less mass than that beyond them, the two positions that draws find are hardly those with the same
  // mass beyond them: sums of masses round. There the pdf of a draw is taken from its direction.
  static constexpr T tail = 128 * std::numeric_limits<T>::epsilon();
  /// A position between two meridians, and the share of the diagram's mass before it: `below` before the cell,
  /// `inside` from there on; `slope` is its derivative.
  struct Across {
    const Diagram<T>& d;
    Meridian<T> at{-1, 0, 0, 0};
    T below = 0, inside = 0, slope = 0, first = 1, last = -1, m0 = 0, m1 = 0;

    void move(T phi) noexcept {
      if (!(phi >= first && phi <= last)) {
        at.i = find_cell(d.phi(), d.meridians(), phi);
        first = d.phi()[at.i], last = d.phi()[at.i + 1];
        m0 = d.along(at.i), m1 = d.along(at.i + 1), below = d.before(at.i) / d.mass();
      }
      const T width = last - first;
      at.a = std::clamp((phi - first) / width, T(0), T(1));
      at.phi = first + at.a * width;
      at.mass = (1 - at.a) * m0 + at.a * m1;
      inside = at.a * width * (m0 + at.mass) / (2 * d.mass());
      slope = at.mass / d.mass();
    }
  };

  /// The same along a meridian: from the pole by radii or, `outer`, from the horizon by gaps.
  struct Along {
    const Diagram<T>& d;
    const Meridian<T>& m;
    bool outer;
    T scale;  // 0 for a meridian without mass
    RadialPlace<T> at{{0, 0, 0, 0}, 0};
    T below = 0, inside = 0, slope = 0, first = 1, last = -1;

    Along(const Diagram<T>& diagram, const Meridian<T>& meridian, bool from_horizon) noexcept
        : d(diagram), m(meridian), outer(from_horizon), scale(meridian.mass > 0 ? 1 / meridian.mass : T(0)) {}

    void move(T way) noexcept {
      if (!(way >= first && way <= last)) {
        const auto row = d.row(m.i, m.a);
        const auto [j, cell, r1] = row.cell_at(outer ? 1 - way : way);
        at.cell = outer ? cell.from_end(r1) : cell;
        // The mass beyond a cell as a sum of differences: next to the horizon these are the small numbers.
        const int n = row.parallels - 1;
        below = (outer ? row.w0 * (row.cumulative0[n] - row.cumulative0[j + 1]) +
                             row.w1 * (row.cumulative1[n] - row.cumulative1[j + 1])
                       : row.before(j)) *
                scale;
        first = outer ? 1 - r1 : cell.r0, last = outer ? 1 - cell.r0 : r1;
      }
      at.s = std::clamp((way - first) / (last - first), T(0), T(1));
      inside = std::abs(at.cell.mass(at.s)) * scale;
      slope = 2 * at.r() * at.density() * scale;
    }
  };

  /// Moves both to where the mass before them is the same and they are interpolated to `target`, in [0, end].
  template <class Position>
  void balance(Position& first, Position& second, T target, T end) const noexcept {
    // The one with the lesser weight is free; the rounding of the other one is not amplified.
    const bool swap = w0_ > w1_;
    Position &free = swap ? second : first, &bound = swap ? first : second;
    const T lesser = std::min(w0_, w1_), larger = std::max(w0_, w1_), ratio = lesser / larger;
    const auto difference = [&](T x) {
      free.move(x), bound.move((target - lesser * x) / larger);
      return Slope<T>{(free.below - bound.below) + (free.inside - bound.inside), free.slope + ratio * bound.slope};
    };
    // std::max and std::min drop the NaN of 0/0.
    const T hi = std::min(end, target / lesser), lo = std::min(std::max(T(0), (target - larger * end) / lesser), hi);
    difference(monotone_root(difference, std::clamp(target, lo, hi), lo, hi));
  }

  /// Of two positions balanced, the mass from the diagram that moves more with it.
  template <class Position>
  T mass(const Position& first, const Position& second) const noexcept {
    const Position& p = w0_ * second.slope >= w1_ * first.slope ? first : second;
    return std::clamp(p.below + p.inside, T(0), T(1));
  }

  /// dphi_alpha/du; 0 stands for an infinite slope (a meridian without mass).
  T slope_phi(const Meridian<T>& a, const Meridian<T>& b) const noexcept {
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
