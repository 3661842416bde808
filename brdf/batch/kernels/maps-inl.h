// The maps of Diagram, Blend and Displacement on vectors, once per instruction set: included by the kernels' own files
// alone.
#if defined(GONIO_BATCH_MAPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_MAPS_INL_H
#undef GONIO_BATCH_MAPS_INL_H
#else
#define GONIO_BATCH_MAPS_INL_H
#endif

#include <gonio/brdf/batch/kernels/search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

struct Uniform {
  V u, v, pdf;
};

/// The last of the `lines` values from base[start] on, which ascend, that is below t, the ends apart: its index from
/// base, in every lane.
HWY_INLINE VI find(const float* base, VI start, int lines, V t) {
  const Lanes<V> targets(t);
  Lanes<VI> index(start);
  for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane)
    index.x[lane] +=
        static_cast<int>(count_below<true, LongPass>(Row{base + index.x[lane]}, 1, lines - 2, targets.x[lane]));
  return index.vector();
}

/// The values of one diagram, at indices of its block.
struct One {
  const float* values;

  HWY_INLINE V value(VI index) const { return at(values, index); }
  HWY_INLINE Two two(VI index) const { return two_at(values, index); }
};
/// Those of a blend with the diagram `stride` behind it.
struct Blended {
  const float* values;
  int stride;
  V alpha;

  HWY_INLINE V value(VI index) const { return mix(alpha, at(values, index), at(values + stride, index)); }
  HWY_INLINE Two two(VI index) const {
    const Two x = two_at(values, index), y = two_at(values + stride, index);
    return {mix(alpha, x.first, y.first), mix(alpha, x.second, y.second)};
  }
};

/// A cell between meridians or parallels as BatchLayout has it: its number, its group, and its place there.
struct CellIndex {
  VI k, group, in_group;

  explicit HWY_INLINE CellIndex(VI cell) : k(cell) {
    const V middle = hn::Add(hn::ConvertTo(D(), cell), set(0.5f));
    group = truncated(hn::Mul(middle, set(1.0f / BatchLayout::group)));
    in_group = hn::Sub(cell, hn::Mul(group, set_int(BatchLayout::group)));
  }
};

/// The inverse maps of Diagram or Blend; every lane has a diagram of its own.
template <class Source>
struct DiagramLanes {
  const BatchLayout& layout;
  Source source;
  VI block;  // of the diagram, or of the first of two

  HWY_INLINE VI index(int part, VI k) const { return hn::Add(hn::Add(block, set_int(part)), k); }
  HWY_INLINE CellIndex find_phi(V angle) const {
    return CellIndex(hn::Sub(find(source.values, block, layout.meridians, angle), block));
  }
  HWY_INLINE CellIndex find_r(V radius) const {
    return CellIndex(hn::Sub(find(source.values + layout.r, block, layout.parallels, radius), block));
  }

  /// A cell between two meridians: where they are, the mass along each, and the mass before the first.
  struct Sector {
    VI i;
    V phi0, phi1, m0, m1, before;
  };
  HWY_INLINE Sector sector(const CellIndex& i) const {
    const VI group = index(layout.meridian_groups, hn::Mul(i.group, set_int(BatchLayout::meridian_group)));
    const VI before = hn::Add(group, i.in_group),
             first = hn::Add(hn::Add(before, i.in_group), set_int(BatchLayout::group + 1));
    const Two line0 = source.two(first), line1 = source.two(hn::Add(first, set_int(2)));
    return {i.k, line0.first, line1.first, line0.second, line1.second, source.value(before)};
  }

  /// A cell between two parallels on the meridian at `a` in a sector, and the mass along it before the cell.
  struct Ring {
    Cell cell;
    V before, end;  // of the mass, and the radius
  };
  HWY_INLINE VI before_in_ring(VI i, const CellIndex& j) const {
    const VI g = hn::Add(hn::Mul(i, set_int(layout.along)), j.group);
    return hn::Add(index(layout.parallel_groups, hn::Mul(g, set_int(BatchLayout::parallel_group))), j.in_group);
  }
  HWY_INLINE Ring ring(VI i, V a, const CellIndex& j) const {
    const VI before0 = before_in_ring(i, j);
    const VI before1 = hn::Add(before0, set_int(layout.along * BatchLayout::parallel_group)),
             density = set_int(BatchLayout::group);
    const Two d0 = source.two(hn::Add(before0, density)), d1 = source.two(hn::Add(before1, density));
    const Two r = two_at(source.values + layout.r, hn::Add(block, j.k));
    return {{r.first, hn::Sub(r.second, r.first), mix(a, d0.first, d1.first), mix(a, d0.second, d1.second)},
            mix(a, source.value(before0), source.value(before1)),
            r.second};
  }

  /// The mass along the meridian at `a` in a sector from a cell between two parallels on. Differences first: they are
  /// exact.
  HWY_INLINE V mass_from(const Sector& s, V a, const CellIndex& j) const {
    const VI first = before_in_ring(s.i, j),
             second = hn::Add(first, set_int(layout.along * BatchLayout::parallel_group));
    return mix(a, hn::Sub(s.m0, source.value(first)), hn::Sub(s.m1, source.value(second)));
  }

  struct Meridian {
    Sector sector;
    V a, mass;
  };
  HWY_INLINE Meridian meridian_through(V angle) const {
    const Sector s = sector(find_phi(angle));
    const V a = clamp01(hn::Div(hn::Sub(angle, s.phi0), hn::Sub(s.phi1, s.phi0)));
    return {s, a, mix(a, s.m0, s.m1)};
  }
  HWY_INLINE V pdf(V radius, V gap, V angle) const {
    const Meridian m = meridian_through(angle);
    const Ring at = ring(m.sector.i, m.a, find_r(radius));
    return at.cell.density_at(radius, gap, at.end);
  }
  HWY_INLINE Uniform invert(V radius, V gap, V angle) const {
    const Meridian m = meridian_through(angle);
    const Ring at = ring(m.sector.i, m.a, find_r(radius));
    const V inside =
        hn::Mul(hn::Mul(m.a, hn::Sub(m.sector.phi1, m.sector.phi0)), hn::Mul(set(0.5f), hn::Add(m.sector.m0, m.mass)));
    const V u = hn::Div(hn::Add(m.sector.before, inside), set(layout.whole_mass()));
    const V s = at.cell.place(radius), v = quotient(hn::Add(at.before, at.cell.mass(s)), m.mass);
    return {hn::Min(u, set(1)), hn::Min(v, set(1)), at.cell.density_at(radius, gap, at.end)};
  }
};
using OneDiagram = DiagramLanes<One>;

/// Displacement between the diagrams of a block and of the block behind it. d0 is the one with the lesser weight.
struct DisplacementLanes {
  OneDiagram d0, d1;
  V w0, w1;

  HWY_INLINE DisplacementLanes(const BatchLayout& layout, VI block, V alpha)
      : DisplacementLanes(layout, block, hn::Add(block, set_int(layout.stride)), alpha) {}
  HWY_INLINE DisplacementLanes(const BatchLayout& layout, VI block, VI next, V alpha)
      : d0{layout, {layout.values()}, hn::IfThenElse(hn::RebindMask(DI(), hn::Lt(alpha, set(0.5f))), next, block)},
        d1{layout, {layout.values()}, hn::Sub(hn::Add(block, next), d0.block)},
        w0(hn::Min(alpha, hn::Sub(set(1), alpha))),
        w1(hn::Sub(set(1), w0)) {}

  static constexpr float epsilon = 1.1920929e-7f;
  HWY_INLINE float whole_angle() const { return d0.layout.half_azimuth ? pi<float> : 2 * pi<float>; }

  /// Displacement::Across.
  struct Across {
    const OneDiagram& d;
    float end;
    OneDiagram::Sector sector;
    V inverse_mass, a, mass, below, inside, slope;

    HWY_INLINE Across(const OneDiagram& diagram, float whole_angle)
        : d(diagram), end(whole_angle), inverse_mass(hn::Div(set(1), set(d.layout.whole_mass()))) {
      sector.phi0 = set(1), sector.phi1 = set(-1);
    }
    HWY_INLINE void move(V phi) {
      if (!hn::AllTrue(D(), hn::And(hn::Ge(phi, sector.phi0), hn::Le(phi, sector.phi1)))) {
        sector = d.sector(d.find_phi(hn::Min(phi, set(end))));
        below = hn::Mul(sector.before, inverse_mass);
      }
      const V width = hn::Sub(sector.phi1, sector.phi0);
      a = clamp01(hn::Div(hn::Sub(phi, sector.phi0), width));
      mass = mix(a, sector.m0, sector.m1);
      slope = hn::Mul(mass, inverse_mass);
      inside = hn::Mul(hn::Mul(set(0.5f), hn::Mul(a, width)), hn::MulAdd(sector.m0, inverse_mass, slope));
    }
  };

  /// Displacement::Along: by radii or, in the lanes of `outer`, by gaps.
  struct Along {
    const OneDiagram& d;
    OneDiagram::Sector sector;
    M outer;
    V a, scale, below, inside, slope, first, last, radius, pdf;
    Cell cell;

    HWY_INLINE Along(const OneDiagram& diagram, const Across& across, M from_horizon)
        : d(diagram),
          sector(across.sector),
          outer(from_horizon),
          a(across.a),
          scale(quotient(set(1), across.mass)),
          first(set(1)),
          last(set(-1)) {}
    HWY_INLINE void move(V way) {
      const V one = set(1);
      if (!hn::AllTrue(D(), hn::And(hn::Ge(way, first), hn::Le(way, last)))) {
        const V r = hn::IfThenElse(outer, hn::Sub(one, way), way);
        const CellIndex j = d.find_r(clamp01(r));
        const OneDiagram::Ring ring = d.ring(sector.i, a, j);
        const V r0 = ring.cell.r0, r1 = ring.end;
        const M inner = hn::Lt(r1, one);  // the last cell has nothing behind it
        const CellIndex next(hn::Add(j.k, hn::IfThenElseZero(hn::RebindMask(DI(), inner), set_int(1))));
        const V beyond = hn::IfThenElseZero(inner, hn::Max(d.mass_from(sector, a, next), zero()));
        below = hn::Mul(hn::IfThenElse(outer, beyond, ring.before), scale);
        first = hn::IfThenElse(outer, hn::Sub(one, r1), r0), last = hn::IfThenElse(outer, hn::Sub(one, r0), r1);
        cell = ring.cell.from_end(outer, r1);
      }
      const V s = clamp01(hn::Div(hn::Sub(way, first), hn::Sub(last, first)));
      radius = cell.radius(s), pdf = cell.density(s);
      inside = hn::Mul(hn::Abs(cell.mass(s)), scale);
      slope = hn::Mul(hn::Mul(set(2), radius), hn::Mul(pdf, scale));
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

  HWY_INLINE Uniform invert(V r, V gap, V phi) const {
    Across a0(d0, whole_angle()), a1(d1, whole_angle());
    balance(a0, a1, phi, set(whole_angle()));
    r = hn::Max(r, set(epsilon));
    const M outer = hn::Gt(hn::Mul(r, r), set(0.5f));
    Along b0(d0, a0, outer), b1(d1, a1, outer);
    balance(b0, b1, hn::IfThenElse(outer, gap, r), set(1));
    const Displaced at0{a0.mass, b0.radius, b0.pdf}, at1{a1.mass, b1.radius, b1.pdf};
    const V v = mass(b0, b1);
    return {mass(a0, a1), hn::IfThenElse(outer, hn::Sub(set(1), v), v),
            displaced_density(w0, w1, set(d0.layout.whole_mass()), at0, at1, r)};
  }
  HWY_INLINE V pdf(V r, V gap, V phi) const { return invert(r, gap, phi).pdf; }
};

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
