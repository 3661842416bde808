// The maps of Diagram, Blend and Displacement on vectors, once per instruction set: included by kernels.cpp alone.
#if defined(GONIO_BATCH_MAPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_MAPS_INL_H
#undef GONIO_BATCH_MAPS_INL_H
#else
#define GONIO_BATCH_MAPS_INL_H
#endif

#include <gonio/brdf/batch/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

/// A point of the disk, phi in the stored azimuth, with the density there.
struct OnDisk {
  V r, phi, pdf;
};
struct Uniform {
  V u, v, pdf;
};

/// One diagram in every lane, each its own: Diagram.
struct OneDiagram {
  const BatchLayout& layout;
  const float* values;  // the arrays of the block that `block` is 0 for
  VI block;

  const float* phi() const { return values; }
  const float* cumulative_phi() const { return values + layout.cumulative_phi(); }
  const float* masses() const { return values + layout.mass(); }
  const float* r() const { return values + layout.r(); }
  const float* density() const { return values + layout.density(); }
  const float* cumulative() const { return values + layout.cumulative(); }
  V mass() const { return at(cumulative_phi() + layout.meridians - 1, block); }

  struct Meridian {
    VI i, row;  // indices of the meridian into phi(), and of its row into density()
    V a, phi, mass, phi0, width, m0, m1;
  };
  HWY_INLINE VI row(VI i) const {
    return hn::Add(block, hn::Mul(hn::Sub(i, block), set_int(layout.parallels)));
  }

  HWY_INLINE Meridian meridian_at(V u) const {
    const V target = hn::Mul(u, mass());
    const VI i = find(cumulative_phi(), block, layout.meridians, target);
    const V phi0 = at(phi(), i), width = hn::Sub(at(phi() + 1, i), phi0);
    const V m0 = at(masses(), i), m1 = at(masses() + 1, i);
    const V a = invert_azimuth(width, m0, m1, hn::Sub(target, at(cumulative_phi(), i)));
    return {i, row(i), a, hn::MulAdd(a, width, phi0), mix(a, m0, m1), phi0, width, m0, m1};
  }
  HWY_INLINE Meridian meridian_through(V angle) const {
    const VI i = find(phi(), block, layout.meridians, angle);
    const V phi0 = at(phi(), i), width = hn::Sub(at(phi() + 1, i), phi0);
    const V a = clamp01(hn::Div(hn::Sub(angle, phi0), width)), m0 = at(masses(), i), m1 = at(masses() + 1, i);
    return {i, row(i), a, hn::MulAdd(a, width, phi0), mix(a, m0, m1), phi0, width, m0, m1};
  }
  /// The meridian through `angle` as long as that is between the same lines, else the nearer one of these.
  HWY_INLINE void move_to(Meridian& m, V angle) const {
    m.a = clamp01(hn::Div(hn::Sub(angle, m.phi0), m.width));
    m.phi = hn::MulAdd(m.a, m.width, m.phi0);
    m.mass = mix(m.a, m.m0, m.m1);
  }
  HWY_INLINE V u_of(const Meridian& m) const {
    const V inside = hn::Mul(hn::Mul(m.a, m.width), hn::Mul(set(0.5f), hn::Add(m.m0, m.mass)));
    return hn::Min(hn::Div(hn::Add(at(cumulative_phi(), m.i), inside), mass()), set(1));
  }

  struct Parallel {
    V r, pdf;
    Cell cell;
  };
  HWY_INLINE V across(const float* rows, const Meridian& m, VI index) const {
    return mix(m.a, at(rows, index), at(rows + layout.parallels, index));
  }
  /// The cell behind parallel j of the meridian.
  HWY_INLINE Cell cell(const Meridian& m, VI index, VI j) const {
    const V r0 = at(r(), j);
    return {r0, hn::Sub(at(r() + 1, j), r0), across(density(), m, index), across(density() + 1, m, index)};
  }
  HWY_INLINE Parallel parallel_at(const Meridian& m, V v) const {
    const V target = hn::Mul(v, m.mass);
    VI index = m.row;
    V below = zero();
    for (int length = layout.parallels - 1; length > 1;) {
      const int half = length / 2;
      const VI probe = hn::Add(index, set_int(half));
      const V mass = across(cumulative(), m, probe);
      const M right = hn::Lt(mass, target);
      index = hn::IfThenElse(hn::RebindMask(DI(), right), probe, index);
      below = hn::IfThenElse(right, mass, below);
      length -= half;
    }
    const Cell c = cell(m, index, hn::Add(block, hn::Sub(index, m.row)));
    const V s = c.invert(hn::Sub(target, below));
    return {hn::MulAdd(s, c.h, c.r0), c.density(s), c};
  }
  /// To another radius of the same cell.
  HWY_INLINE void move_to(Parallel& p, V radius) const {
    const V s = place(p.cell, radius);
    p.r = hn::MulAdd(s, p.cell.h, p.cell.r0), p.pdf = p.cell.density(s);
  }
  HWY_INLINE V place(const Cell& c, V radius) const { return clamp01(hn::Div(hn::Sub(radius, c.r0), c.h)); }
  struct Inverse {
    V v, pdf;
  };
  HWY_INLINE Inverse inverse(const Meridian& m, V radius) const {
    const VI j = find(r(), block, layout.parallels, radius), index = hn::Add(m.row, hn::Sub(j, block));
    const Cell c = cell(m, index, j);
    const V s = place(c, radius), below = hn::Add(across(cumulative(), m, index), c.mass(s));
    return {hn::Min(quotient(below, m.mass), set(1)), c.density(s)};
  }

  HWY_INLINE OnDisk sample(V u, V v) const {
    const Meridian m = meridian_at(u);
    const Parallel p = parallel_at(m, v);
    return {p.r, m.phi, p.pdf};
  }
  HWY_INLINE V pdf(V radius, V angle) const {
    const Meridian m = meridian_through(angle);
    const VI j = find(r(), block, layout.parallels, radius);
    const Cell c = cell(m, hn::Add(m.row, hn::Sub(j, block)), j);
    return c.density(place(c, radius));
  }
  HWY_INLINE Uniform invert(V radius, V angle) const {
    const Meridian m = meridian_through(angle);
    const Inverse along = inverse(m, radius);
    return {u_of(m), along.v, along.pdf};
  }
};

/// Blend of the diagrams of a block and of the block behind it.
struct BlendLanes {
  const BatchLayout& layout;
  const float* values;
  VI block;
  V alpha;

  HWY_INLINE V both(const float* array, VI index) const {
    return mix(alpha, at(array, index), at(array + layout.stride, index));
  }
  struct Rows {
    VI index;
    V wa0, wa1, wb0, wb1;
  };
  HWY_INLINE Rows rows(VI i, V a) const {
    const V w0 = hn::Sub(set(1), alpha), b = hn::Sub(set(1), a);
    return {hn::Add(block, hn::Mul(hn::Sub(i, block), set_int(layout.parallels))), hn::Mul(w0, b), hn::Mul(w0, a),
            hn::Mul(alpha, b), hn::Mul(alpha, a)};
  }
  HWY_INLINE V value(const float* array, const Rows& w, VI index) const {
    const float* second = array + layout.stride;
    const V first = hn::MulAdd(w.wa0, at(array, index), hn::Mul(w.wa1, at(array + layout.parallels, index)));
    return hn::Add(first, hn::MulAdd(w.wb0, at(second, index), hn::Mul(w.wb1, at(second + layout.parallels, index))));
  }
  HWY_INLINE Cell cell(const Rows& w, VI index, VI j) const {
    const float *r = values + layout.r(), *density = values + layout.density();
    const V r0 = at(r, j);
    return {r0, hn::Sub(at(r + 1, j), r0), value(density, w, index), value(density + 1, w, index)};
  }
  struct Meridian {
    VI i;
    V a, width, m0, m1;
  };
  HWY_INLINE Meridian meridian_through(V angle) const {
    const float *phi = values, *mass = values + layout.mass();
    const VI i = find(phi, block, layout.meridians, angle);
    const V phi0 = at(phi, i), width = hn::Sub(at(phi + 1, i), phi0);
    return {i, clamp01(hn::Div(hn::Sub(angle, phi0), width)), width, both(mass, i), both(mass + 1, i)};
  }

  HWY_INLINE OnDisk sample(V u, V v) const {
    const float *phi = values, *cumulative_phi = values + layout.cumulative_phi(), *mass = values + layout.mass();
    const V angle = hn::Mul(u, both(cumulative_phi + layout.meridians - 1, block));
    VI i = block;
    V below = zero();
    for (int length = layout.meridians - 1; length > 1;) {
      const int half = length / 2;
      const VI probe = hn::Add(i, set_int(half));
      const V m = both(cumulative_phi, probe);
      const M right = hn::Lt(m, angle);
      i = hn::IfThenElse(hn::RebindMask(DI(), right), probe, i);
      below = hn::IfThenElse(right, m, below);
      length -= half;
    }
    const V phi0 = at(phi, i), width = hn::Sub(at(phi + 1, i), phi0);
    const V m0 = both(mass, i), m1 = both(mass + 1, i);
    const V a = invert_azimuth(width, m0, m1, hn::Sub(angle, below));
    const Rows w = rows(i, a);

    const float* cumulative = values + layout.cumulative();
    const V target = hn::Mul(v, mix(a, m0, m1));
    VI index = w.index;
    below = zero();
    for (int length = layout.parallels - 1; length > 1;) {
      const int half = length / 2;
      const VI probe = hn::Add(index, set_int(half));
      const V m = value(cumulative, w, probe);
      const M right = hn::Lt(m, target);
      index = hn::IfThenElse(hn::RebindMask(DI(), right), probe, index);
      below = hn::IfThenElse(right, m, below);
      length -= half;
    }
    const Cell c = cell(w, index, hn::Add(block, hn::Sub(index, w.index)));
    const V s = c.invert(hn::Sub(target, below));
    return {hn::MulAdd(s, c.h, c.r0), hn::MulAdd(a, width, phi0), c.density(s)};
  }
  HWY_INLINE V pdf(V r, V phi) const {
    const float* lines = values;
    const VI i = find(lines, block, layout.meridians, phi);
    const V phi0 = at(lines, i);
    const Rows w = rows(i, clamp01(hn::Div(hn::Sub(phi, phi0), hn::Sub(at(lines + 1, i), phi0))));
    const VI j = find(values + layout.r(), block, layout.parallels, r);
    const Cell c = cell(w, hn::Add(w.index, hn::Sub(j, block)), j);
    return c.density(clamp01(hn::Div(hn::Sub(r, c.r0), c.h)));
  }
  HWY_INLINE Uniform invert(V r, V phi) const {
    const Meridian m = meridian_through(phi);
    const Rows w = rows(m.i, m.a);
    const VI j = find(values + layout.r(), block, layout.parallels, r), index = hn::Add(w.index, hn::Sub(j, block));
    const Cell c = cell(w, index, j);
    const V s = clamp01(hn::Div(hn::Sub(r, c.r0), c.h)), mass = mix(m.a, m.m0, m.m1);
    const V inside = hn::Mul(hn::Mul(m.a, m.width), hn::Mul(set(0.5f), hn::Add(m.m0, mass)));
    const float* cumulative_phi = values + layout.cumulative_phi();
    const V u = hn::Div(hn::Add(both(cumulative_phi, m.i), inside), both(cumulative_phi + layout.meridians - 1, block));
    const V v = quotient(hn::Add(value(values + layout.cumulative(), w, index), c.mass(s)), mass);
    return {hn::Min(u, set(1)), hn::Min(v, set(1)), c.density(s)};
  }
};

/// Displacement between the diagrams of a block and of the block behind it.
struct DisplacementLanes {
  OneDiagram d0, d1;
  V w0, w1;

  HWY_INLINE DisplacementLanes(const BatchLayout& layout, const float* values, VI block, V alpha)
      : d0{layout, values, block}, d1{layout, values + layout.stride, block}, w0(hn::Sub(set(1), alpha)), w1(alpha) {}

  using Meridian = OneDiagram::Meridian;
  using Parallel = OneDiagram::Parallel;
  struct Meridians {
    Meridian first, second;
  };
  static constexpr float epsilon = 1.1920929e-7f, smallest_v = epsilon * epsilon;

  HWY_INLINE V both(V x0, V x1) const { return hn::MulAdd(w0, x0, hn::Mul(w1, x1)); }
  /// w0 x0 / y0 + w1 x1 / y1 over the terms with weight; 0 if one of these has y = 0: the sum is infinite.
  HWY_INLINE V quotients(V x0, V y0, V x1, V y1) const {
    const M use0 = hn::Gt(w0, zero()), use1 = hn::Gt(w1, zero());
    const M infinite = hn::Or(hn::AndNot(hn::Gt(y0, zero()), use0), hn::AndNot(hn::Gt(y1, zero()), use1));
    const V sum = hn::Add(hn::IfThenElseZero(use0, hn::Mul(w0, hn::Div(x0, y0))),
                          hn::IfThenElseZero(use1, hn::Mul(w1, hn::Div(x1, y1))));
    return hn::IfThenZeroElse(infinite, sum);
  }
  HWY_INLINE V slope_phi(const Meridians& m) const {
    return quotients(d0.mass(), m.first.mass, d1.mass(), m.second.mass);
  }
  HWY_INLINE V slope_r2(const Meridians& m, const Parallel& a, const Parallel& b) const {
    return quotients(m.first.mass, hn::Mul(a.pdf, a.r), m.second.mass, hn::Mul(b.pdf, b.r));
  }
  HWY_INLINE V density(const Meridians& m, const Parallel& a, const Parallel& b, V r) const {
    const V jacobian = hn::Mul(hn::Mul(slope_phi(m), slope_r2(m, a, b)), r);
    return quotient(set(d0.layout.half_azimuth ? 0.5f : 1.0f), jacobian);
  }

  HWY_INLINE OnDisk sample(V u, V v) const {
    v = hn::Max(v, set(smallest_v));
    const Meridians m{d0.meridian_at(u), d1.meridian_at(u)};
    const Parallel a = d0.parallel_at(m.first, v), b = d1.parallel_at(m.second, v);
    const V r = both(a.r, b.r);
    return {r, both(m.first.phi, m.second.phi), density(m, a, b, r)};
  }

  static HWY_INLINE M in_gap(V error, V slope) {
    return hn::Gt(hn::Abs(error), hn::Max(set(4096 * epsilon), hn::Mul(set(4 * epsilon), slope)));
  }
  /// Where the straight lines of slopes s0 and s1 through the two inverses meet the target, in the bracket.
  HWY_INLINE V start(V x0, V s0, V x1, V s1) const {
    const V lo = hn::Min(x0, x1), hi = hn::Max(x0, x1);
    const V weight0 = hn::Mul(w0, s0), weight1 = hn::Mul(w1, s1);
    const V x = hn::Div(hn::MulAdd(weight0, x0, hn::Mul(weight1, x1)), hn::Add(weight0, weight1));
    const M inside = hn::And(hn::Ge(x, lo), hn::Le(x, hi));
    return hn::IfThenElse(inside, x, hn::MulAdd(set(0.5f), hn::Sub(hi, lo), lo));
  }

  HWY_INLINE Uniform invert(V r, V phi) const {
    const Meridian through0 = d0.meridian_through(phi), through1 = d1.meridian_through(phi);
    const V u0 = d0.u_of(through0), u1 = d1.u_of(through1);
    Meridians m;
    const V u = root(
        [&](V x) HWY_ATTR {
          m = {d0.meridian_at(x), d1.meridian_at(x)};
          return Slope<V>{both(m.first.phi, m.second.phi), slope_phi(m)};
        },
        phi, start(u0, quotient(set(1), through0.mass), u1, quotient(set(1), through1.mass)), hn::Min(u0, u1),
        hn::Max(u0, u1), set(64 * pi<float> * epsilon));
    const V phi_error = hn::Sub(phi, both(m.first.phi, m.second.phi));
    const V u_slope = slope_phi(m), u_step = quotient(phi_error, u_slope);
    M gap = in_gap(phi_error, u_slope);
    const V phi_step = quotient(phi_error, quotients(set(1), m.first.mass, set(1), m.second.mass));
    d0.move_to(m.first, hn::Add(m.first.phi, quotient(phi_step, m.first.mass)));
    d1.move_to(m.second, hn::Add(m.second.phi, quotient(phi_step, m.second.mass)));

    const OneDiagram::Inverse along0 = d0.inverse(m.first, r), along1 = d1.inverse(m.second, r);
    const V q0 = hn::Sqrt(along0.v), q1 = hn::Sqrt(along1.v);
    const V at0 = hn::Mul(along0.pdf, r), at1 = hn::Mul(along1.pdf, r);
    Parallel a, b;
    const auto v_at = [](V x) HWY_ATTR {
      return hn::Min(hn::Max(hn::Mul(x, x), set(smallest_v)), set(1 - epsilon / 2));
    };
    const V q = root(
        [&](V x) HWY_ATTR {
          const V v = v_at(x);
          a = d0.parallel_at(m.first, v), b = d1.parallel_at(m.second, v);
          return Slope<V>{both(a.r, b.r), hn::Mul(x, slope_r2(m, a, b))};
        },
        r, start(q0, quotient(hn::Mul(q0, m.first.mass), at0), q1, quotient(hn::Mul(q1, m.second.mass), at1)),
        hn::Min(q0, q1), hn::Max(q0, q1), set(64 * epsilon));
    const V r_error = hn::Sub(r, both(a.r, b.r));
    const V v_slope = hn::Mul(set(0.5f), slope_r2(m, a, b)), v_step = quotient(r_error, v_slope);
    gap = hn::Or(gap, in_gap(r_error, v_slope));
    const V s0 = quotient(m.first.mass, hn::Mul(a.pdf, a.r)), s1 = quotient(m.second.mass, hn::Mul(b.pdf, b.r));
    const V r_step = quotient(r_error, both(s0, s1));
    d0.move_to(a, hn::MulAdd(s0, r_step, a.r));
    d1.move_to(b, hn::MulAdd(s1, r_step, b.r));
    return {clamp01(hn::Add(u, u_step)), clamp01(hn::Add(v_at(q), v_step)), hn::IfThenZeroElse(gap, density(m, a, b, both(a.r, b.r)))};
  }
  HWY_INLINE V pdf(V r, V phi) const { return invert(r, phi).pdf; }
};

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
