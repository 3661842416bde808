// The maps of Diagram, Blend and Displacement on vectors, once per instruction set: included by the kernels' own files alone.
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

/// Calls step(half) for the steps of a binary search among `count` lines.
template <class Step>
HWY_INLINE void for_halves(int count, const Step& step) {
  for (int length = count - 1; length > 1; length -= length / 2) step(length / 2);
}

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
  V mass() const { return set(layout.whole_mass()); }

  struct Meridian {
    VI i;  // index of the meridian into phi(), and of its first value into density()
    V a, phi, mass, width, m0;
  };

  /// A search that goes on: the line reached, counted from `block` as r and phi are, its index into the array that is
  /// searched, and the mass before it.
  struct Search {
    VI line, index;
    V below;
    HWY_INLINE void step(VI next, VI probe, V mass, V target) {
      const M right = hn::Lt(mass, target);
      line = hn::IfThenElse(hn::RebindMask(DI(), right), next, line);
      index = hn::IfThenElse(hn::RebindMask(DI(), right), probe, index);
      below = hn::IfThenElse(right, mass, below);
    }
  };
  HWY_INLINE void step_across(Search& s, V target, int half) const {
    const VI probe = hn::Add(s.line, set_int(half));
    s.step(probe, probe, at(cumulative_phi(), probe), target);
  }
  HWY_INLINE void step_along(Search& s, const Meridian& m, V target, int half) const {
    const VI probe = hn::Add(s.index, set_int(half * layout.meridians));
    s.step(hn::Add(s.line, set_int(half)), probe, across(cumulative(), m.a, probe), target);
  }
  HWY_INLINE Meridian meridian_of(const Search& s, V target) const {
    const Two lines = two_at(phi(), s.line), m = two_at(masses(), s.line);
    const V width = hn::Sub(lines.second, lines.first);
    const V a = invert_azimuth(width, m.first, m.second, hn::Sub(target, s.below));
    return {s.line, a, hn::MulAdd(a, width, lines.first), mix(a, m.first, m.second), width, m.first};
  }

  HWY_INLINE Meridian meridian_through(V angle) const {
    const VI i = find(phi(), block, layout.meridians, angle);
    const Two lines = two_at(phi(), i), m = two_at(masses(), i);
    const V width = hn::Sub(lines.second, lines.first), a = clamp01(hn::Div(hn::Sub(angle, lines.first), width));
    return {i, a, hn::MulAdd(a, width, lines.first), mix(a, m.first, m.second), width, m.first};
  }
  HWY_INLINE V u_of(const Meridian& m) const {
    const V inside = hn::Mul(hn::Mul(m.a, m.width), hn::Mul(set(0.5f), hn::Add(m.m0, m.mass)));
    return hn::Min(hn::Div(hn::Add(at(cumulative_phi(), m.i), inside), mass()), set(1));
  }

  struct Parallel {
    V r, pdf;
  };
  /// Between the meridian and the next one; `index` is of the former.
  HWY_INLINE V across(const float* rows, V a, VI index) const {
    const Two x = two_at(rows, index);
    return mix(a, x.first, x.second);
  }
  /// The parallel j of a meridian: its index into density().
  HWY_INLINE VI crossing(const Meridian& m, VI j) const {
    return hn::Add(m.i, hn::Mul(hn::Sub(j, block), set_int(layout.meridians)));
  }
  /// The cell behind parallel j of the meridian.
  HWY_INLINE Cell cell(V a, VI index, VI j) const {
    const Two lines = two_at(r(), j);
    return {lines.first, hn::Sub(lines.second, lines.first), across(density(), a, index),
            across(density() + layout.meridians, a, index)};
  }
  HWY_INLINE Parallel parallel_of(const Search& s, const Meridian& m, V target) const {
    const Cell c = cell(m.a, s.index, s.line);
    const V t = c.invert(hn::Sub(target, s.below));
    return {hn::MulAdd(t, c.h, c.r0), c.density(t)};
  }
  HWY_INLINE V place(const Cell& c, V radius) const { return clamp01(hn::Div(hn::Sub(radius, c.r0), c.h)); }

  HWY_INLINE OnDisk sample(V u, V v) const {
    const V before = hn::Mul(u, mass());
    Search across{block, block, zero()};
    for_halves(layout.meridians, [&](int half) HWY_ATTR { step_across(across, before, half); });
    const Meridian m = meridian_of(across, before);
    const V target = hn::Mul(v, m.mass);
    Search along{block, m.i, zero()};
    for_halves(layout.parallels, [&](int half) HWY_ATTR { step_along(along, m, target, half); });
    const Parallel p = parallel_of(along, m, target);
    return {p.r, m.phi, p.pdf};
  }
  HWY_INLINE V pdf(V radius, V angle) const {
    const Meridian m = meridian_through(angle);
    const VI j = find(r(), block, layout.parallels, radius);
    const Cell c = cell(m.a, crossing(m, j), j);
    return c.density(place(c, radius));
  }
  HWY_INLINE Uniform invert(V radius, V angle) const {
    const Meridian m = meridian_through(angle);
    const VI j = find(r(), block, layout.parallels, radius), index = crossing(m, j);
    const Cell c = cell(m.a, index, j);
    const V s = place(c, radius), below = hn::Add(across(cumulative(), m.a, index), c.mass(s));
    return {u_of(m), hn::Min(quotient(below, m.mass), set(1)), c.density(s)};
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
  HWY_INLINE Two both_two(const float* array, VI index) const {
    const Two x = two_at(array, index), y = two_at(array + layout.stride, index);
    return {mix(alpha, x.first, y.first), mix(alpha, x.second, y.second)};
  }
  HWY_INLINE V value(const float* array, V a, VI index) const {
    const Two x = both_two(array, index);
    return mix(a, x.first, x.second);
  }
  HWY_INLINE Cell cell(V a, VI index, VI j) const {
    const float* density = values + layout.density();
    const Two lines = two_at(values + layout.r(), j);
    return {lines.first, hn::Sub(lines.second, lines.first), value(density, a, index),
            value(density + layout.meridians, a, index)};
  }
  struct Place {
    VI i, index, j;
    V a, width, s;
    Cell cell;
  };
  HWY_INLINE Place find_place(V r, V phi) const {
    Place p;
    p.i = find(values, block, layout.meridians, phi);
    p.j = find(values + layout.r(), block, layout.parallels, r);
    const Two lines = two_at(values, p.i);
    p.width = hn::Sub(lines.second, lines.first);
    p.a = clamp01(hn::Div(hn::Sub(phi, lines.first), p.width));
    p.index = hn::Add(p.i, hn::Mul(hn::Sub(p.j, block), set_int(layout.meridians)));
    p.cell = cell(p.a, p.index, p.j);
    p.s = clamp01(hn::Div(hn::Sub(r, p.cell.r0), p.cell.h));
    return p;
  }

  HWY_INLINE OnDisk sample(V u, V v) const {
    const float *phi = values, *cumulative_phi = values + layout.cumulative_phi(), *masses = values + layout.mass();
    const V angle = hn::Mul(u, set(layout.whole_mass()));
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
    const Two lines = two_at(phi, i), m = both_two(masses, i);
    const V width = hn::Sub(lines.second, lines.first);
    const V a = invert_azimuth(width, m.first, m.second, hn::Sub(angle, below));

    const float* cumulative = values + layout.cumulative();
    const V target = hn::Mul(v, mix(a, m.first, m.second));
    VI index = i, j = block;
    below = zero();
    for (int length = layout.parallels - 1; length > 1;) {
      const int half = length / 2;
      const VI probe = hn::Add(index, set_int(half * layout.meridians));
      const V mass = value(cumulative, a, probe);
      const M right = hn::Lt(mass, target);
      index = hn::IfThenElse(hn::RebindMask(DI(), right), probe, index);
      j = hn::IfThenElse(hn::RebindMask(DI(), right), hn::Add(j, set_int(half)), j);
      below = hn::IfThenElse(right, mass, below);
      length -= half;
    }
    const Cell c = cell(a, index, j);
    const V s = c.invert(hn::Sub(target, below));
    return {hn::MulAdd(s, c.h, c.r0), hn::MulAdd(a, width, lines.first), c.density(s)};
  }
  HWY_INLINE V pdf(V r, V phi) const {
    const Place p = find_place(r, phi);
    return p.cell.density(p.s);
  }
  HWY_INLINE Uniform invert(V r, V phi) const {
    const Place p = find_place(r, phi);
    const Two m = both_two(values + layout.mass(), p.i);
    const V mass = mix(p.a, m.first, m.second);
    const V inside = hn::Mul(hn::Mul(p.a, p.width), hn::Mul(set(0.5f), hn::Add(m.first, mass)));
    const V u = hn::Div(hn::Add(both(values + layout.cumulative_phi(), p.i), inside), set(layout.whole_mass()));
    const V v = quotient(hn::Add(value(values + layout.cumulative(), p.a, p.index), p.cell.mass(p.s)), mass);
    return {hn::Min(u, set(1)), hn::Min(v, set(1)), p.cell.density(p.s)};
  }
};

/// Displacement between the diagrams of a block and of the block behind it. d0 is the one with the lesser weight.
struct DisplacementLanes {
  OneDiagram d0, d1;
  V w0, w1;

  HWY_INLINE DisplacementLanes(const BatchLayout& layout, const float* values, VI block, V alpha)
      : DisplacementLanes(layout, values, block, hn::Add(block, set_int(layout.stride)), alpha) {}
  HWY_INLINE DisplacementLanes(const BatchLayout& layout, const float* values, VI block, VI next, V alpha)
      : d0{layout, values, hn::IfThenElse(hn::RebindMask(DI(), hn::Lt(alpha, set(0.5f))), next, block)},
        d1{layout, values, hn::Sub(hn::Add(block, next), d0.block)},
        w0(hn::Min(alpha, hn::Sub(set(1), alpha))),
        w1(hn::Sub(set(1), w0)) {}

  using Meridian = OneDiagram::Meridian;
  using Parallel = OneDiagram::Parallel;
  using Search = OneDiagram::Search;
  static constexpr float epsilon = 1.1920929e-7f, smallest_v = epsilon * epsilon;

  HWY_INLINE V both(V x0, V x1) const { return hn::MulAdd(w0, x0, hn::Mul(w1, x1)); }
  /// w0 x0 / y0 + w1 x1 / y1 over the terms with weight; 0 if one of these has y = 0: the sum is infinite.
  HWY_INLINE V quotients(V x0, V y0, V x1, V y1) const {
    const M use0 = hn::Gt(w0, zero());
    const M infinite = hn::Or(hn::AndNot(hn::Gt(y0, zero()), use0), hn::Not(hn::Gt(y1, zero())));
    const V sum = hn::MulAdd(w1, hn::Div(x1, y1), hn::IfThenElseZero(use0, hn::Mul(w0, hn::Div(x0, y0))));
    return hn::IfThenZeroElse(infinite, sum);
  }
  HWY_INLINE V density(V mass0, V mass1, const Parallel& a, const Parallel& b, V r) const {
    const V slope_phi = quotients(d0.mass(), mass0, d1.mass(), mass1);
    const V slope_r2 = quotients(mass0, hn::Mul(a.pdf, a.r), mass1, hn::Mul(b.pdf, b.r));
    return quotient(set(d0.layout.half_azimuth ? 0.5f : 1.0f), hn::Mul(hn::Mul(slope_phi, slope_r2), r));
  }

  HWY_INLINE OnDisk sample(V u, V v) const {
    v = hn::Max(v, set(smallest_v));
    // Both diagrams are searched side by side: a step waits for its gathers.
    const V before = hn::Mul(u, d0.mass());
    Search across0{d0.block, d0.block, zero()}, across1{d1.block, d1.block, zero()};
    for_halves(d0.layout.meridians, [&](int half) HWY_ATTR {
      d0.step_across(across0, before, half), d1.step_across(across1, before, half);
    });
    const Meridian m0 = d0.meridian_of(across0, before), m1 = d1.meridian_of(across1, before);
    const V v0 = hn::Mul(v, m0.mass), v1 = hn::Mul(v, m1.mass);
    Search along0{d0.block, m0.i, zero()}, along1{d1.block, m1.i, zero()};
    for_halves(d0.layout.parallels, [&](int half) HWY_ATTR {
      d0.step_along(along0, m0, v0, half), d1.step_along(along1, m1, v1, half);
    });
    const Parallel a = d0.parallel_of(along0, m0, v0), b = d1.parallel_of(along1, m1, v1);
    const V r = both(a.r, b.r);
    return {r, both(m0.phi, m1.phi), density(m0.mass, m1.mass, a, b, r)};
  }

  /// Displacement::Across.
  struct Across {
    const OneDiagram& d;
    VI i;
    V inverse_mass, a, mass, below, inside, slope, first, last, m0, m1;

    explicit HWY_INLINE Across(const OneDiagram& diagram)
        : d(diagram), inverse_mass(hn::Div(set(1), d.mass())), first(set(1)), last(set(-1)) {}
    HWY_INLINE void move(V phi) {
      if (!hn::AllTrue(D(), hn::And(hn::Ge(phi, first), hn::Le(phi, last)))) {
        i = find(d.phi(), d.block, d.layout.meridians, phi);
        const Two lines = two_at(d.phi(), i), m = two_at(d.masses(), i);
        first = lines.first, last = lines.second, m0 = m.first, m1 = m.second;
        below = hn::Mul(at(d.cumulative_phi(), i), inverse_mass);
      }
      const V width = hn::Sub(last, first);
      a = clamp01(hn::Div(hn::Sub(phi, first), width));
      mass = mix(a, m0, m1);
      slope = hn::Mul(mass, inverse_mass);
      inside = hn::Mul(hn::Mul(set(0.5f), hn::Mul(a, width)), hn::MulAdd(m0, inverse_mass, slope));
    }
  };

  /// Displacement::Along.
  struct Along {
    const OneDiagram& d;
    Meridian m;
    V scale, below, inside, slope, last;
    Cell cell;
    Parallel at_r;

    HWY_INLINE Along(const OneDiagram& diagram, const Across& across)
        : d(diagram), scale(quotient(set(1), across.mass)), last(set(-1)) {
      m.i = across.i, m.a = across.a;
      cell.r0 = set(1);
    }
    HWY_INLINE void move(V r) {
      if (!hn::AllTrue(D(), hn::And(hn::Ge(r, cell.r0), hn::Le(r, last)))) {
        const VI j = find(d.r(), d.block, d.layout.parallels, r), index = d.crossing(m, j);
        cell = d.cell(m.a, index, j);
        last = hn::Add(cell.r0, cell.h);
        below = hn::Mul(d.across(d.cumulative(), m.a, index), scale);
      }
      const V s = d.place(cell, r);
      at_r = {hn::MulAdd(s, cell.h, cell.r0), cell.density(s)};
      inside = hn::Mul(cell.mass(s), scale);
      slope = hn::Mul(hn::Mul(set(2), at_r.r), hn::Mul(at_r.pdf, scale));
    }
  };

  /// Displacement::balance().
  template <class Position>
  HWY_INLINE void balance(Position& free, Position& bound, V target, V end) const {
    const V larger = hn::Div(set(1), w1), ratio = hn::Mul(w0, larger);
    const auto difference = [&](V x) HWY_ATTR {
      free.move(x), bound.move(hn::Mul(hn::NegMulAdd(w0, x, target), larger));
      return Slope<V>{hn::Add(hn::Sub(free.below, bound.below), hn::Sub(free.inside, bound.inside)),
                      hn::MulAdd(ratio, bound.slope, free.slope)};
    };
    const M shared = hn::Gt(w0, zero());
    const V lo = hn::IfThenElseZero(shared, hn::Max(zero(), hn::Div(hn::NegMulAdd(w1, end, target), w0)));
    const V hi = hn::IfThenElse(shared, hn::Min(end, hn::Div(target, w0)), end);
    difference(root(difference, hn::Min(hn::Max(target, lo), hi), lo, hi));
  }
  template <class Position>
  HWY_INLINE V mass(const Position& free, const Position& bound) const {
    const M first = hn::Ge(hn::Mul(w0, bound.slope), hn::Mul(w1, free.slope));
    return clamp01(hn::IfThenElse(first, hn::Add(free.below, free.inside), hn::Add(bound.below, bound.inside)));
  }

  HWY_INLINE Uniform invert(V r, V phi) const {
    Across a0(d0), a1(d1);
    balance(a0, a1, phi, set(d0.layout.half_azimuth ? pi<float> : 2 * pi<float>));
    r = hn::Max(r, set(epsilon));
    Along b0(d0, a0), b1(d1, a1);
    balance(b0, b1, r, set(1));
    return {mass(a0, a1), mass(b0, b1), density(a0.mass, a1.mass, b0.at_r, b1.at_r, r)};
  }
  HWY_INLINE V pdf(V r, V phi) const { return invert(r, phi).pdf; }
};

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
