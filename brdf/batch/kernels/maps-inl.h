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

/// The last of the `count` values from base[start] on, which ascend, that is below t, the ends apart: its number, in
/// every lane.
HWY_INLINE VI find(const float* base, VI start, int count, V t) {
  const Lanes<V> targets(t);
  Lanes<VI> index(start);
  for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane)
    index.x[lane] = static_cast<int>(count_below<LongPass>(Row{base + index.x[lane]}, 1, count - 2, targets.x[lane]));
  return index.vector();
}

/// The values of the codes at index and index + 1, in units of half floats.
HWY_INLINE Two two_codes(const std::uint16_t* base, VI index) {
#if !defined(GONIO_LANE_CAP) && (HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2)
  const VI both = two_shorts(base, index);
  const hn::Rebind<std::uint16_t, D> narrow;
  const hn::Rebind<hwy::float16_t, D> half;
  const auto value = [&](VI code)
                         GONIO_INLINED { return hn::PromoteTo(D(), hn::BitCast(half, hn::DemoteTo(narrow, code))); };
  return {value(hn::And(both, set_int(0xffff))), value(hn::ShiftRight<16>(both))};
#else
  Lanes<V> first(zero()), second(zero());
  const Lanes<VI> lanes(index);
  for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
    first.x[k] = decode16(base[lanes.x[k]]) / half_unit, second.x[k] = decode16(base[lanes.x[k] + 1]) / half_unit;
  }
  return {first.vector(), second.vector()};
#endif
}

/// Numbers of one diagram in every lane, the k-th.
struct One {
  using OfLane = OneSource;
  const BatchLayout& layout;
  VI k, at_floats, at_codes;

  HWY_INLINE One(const BatchLayout& all, VI diagram)
      : layout(all),
        k(diagram),
        at_floats(hn::Mul(k, set_int(all.stride))),
        at_codes(hn::Mul(k, set_int(all.code_stride))) {}

  HWY_INLINE VI diagram() const { return k; }
  HWY_INLINE V value(VI index) const { return at(layout.diagrams().floats, hn::Add(at_floats, index)); }
  HWY_INLINE Two two(VI index) const { return two_at(layout.diagrams().floats, hn::Add(at_floats, index)); }
  HWY_INLINE Two densities(VI index) const {
    const Two codes = two_codes(layout.diagrams().codes, hn::Add(at_codes, index));
    const V scale = at(layout.diagrams().floats, at_floats);
    return {hn::Mul(scale, codes.first), hn::Mul(scale, codes.second)};
  }
  HWY_INLINE OneSource lane(int diagram, std::size_t) const { return OneSource(layout.diagrams(), diagram); }
};
/// Those of a blend with the next one.
struct Blended {
  One one;
  V alpha;

  HWY_INLINE Blended(const BatchLayout& layout, VI diagram, V of_next) : one(layout, diagram), alpha(of_next) {}

  HWY_INLINE VI diagram() const { return one.k; }
  HWY_INLINE One next() const { return One(one.layout, hn::Add(one.k, set_int(1))); }
  HWY_INLINE V value(VI index) const { return mix(alpha, one.value(index), next().value(index)); }
  HWY_INLINE Two mixed(const Two& x, const Two& y) const {
    return {mix(alpha, x.first, y.first), mix(alpha, x.second, y.second)};
  }
  HWY_INLINE Two two(VI index) const { return mixed(one.two(index), next().two(index)); }
  HWY_INLINE Two densities(VI index) const { return mixed(one.densities(index), next().densities(index)); }
  HWY_INLINE TwoSources lane(int diagram, std::size_t lane) const {
    return TwoSources(one.layout.diagrams(), diagram, Lanes<V>(alpha).x[lane]);
  }
};
/// The inverse maps of Diagram or Blend; every lane has a diagram of its own.
template <class Source>
struct DiagramLanes {
  const BatchLayout& layout;
  Source source;

  HWY_INLINE VI lines() const { return hn::Mul(source.diagram(), set_int(layout.lines_stride)); }
  HWY_INLINE VI find_phi(V angle) const { return find(layout.diagrams().lines, lines(), layout.meridians, angle); }
  HWY_INLINE VI find_r(V radius) const {
    return find(layout.diagrams().lines + layout.r, lines(), layout.parallels, radius);
  }

  /// A cell between two meridians: where they are, the mass along each, and the mass before the first.
  struct Sector {
    VI i;
    V phi0, phi1, m0, m1, before;
  };
  HWY_INLINE Sector sector(VI i) const {
    const Two phi = two_at(layout.diagrams().lines, hn::Add(lines(), i));
    const Two along = source.two(hn::Add(i, set_int(layout.along)));
    return {i, phi.first, phi.second, along.first, along.second, source.value(hn::Add(i, set_int(layout.before)))};
  }

  /// A cell between two parallels on the meridian at `a` in a sector: its group, its place there, and where it ends.
  struct Ring {
    VI group, in_group;
    Cell cell;
    V end;
  };
  HWY_INLINE Ring ring(VI i, V a, VI j) const {
    const V middle = hn::Add(hn::ConvertTo(D(), j), set(0.5f));
    const VI g = truncated(hn::Mul(middle, set(1.0f / BatchLayout::group)));
    const VI in_group = hn::Sub(j, hn::Mul(g, set_int(BatchLayout::group)));
    const VI codes = set_int(BatchLayout::group_codes);
    const VI first = hn::Add(hn::Mul(hn::Add(hn::Mul(g, set_int(layout.meridians)), i), codes), in_group);
    const Two d0 = source.densities(first), d1 = source.densities(hn::Add(first, codes));
    const Two r = two_at(layout.diagrams().lines + layout.r, hn::Add(lines(), j));
    return {g,
            in_group,
            {r.first, hn::Sub(r.second, r.first), mix(a, d0.first, d1.first), mix(a, d0.second, d1.second)},
            r.second};
  }

  /// The mass along the meridian at `a` in a sector, before a ring and behind it. The latter by differences of the mass
  /// of each meridian: next to its end they are exact.
  struct Masses {
    V before, behind;
  };
  HWY_INLINE Masses masses_around(const Sector& s, V a, const Ring& at) const {
    const Lanes<VI> k(source.diagram()), i(s.i), group_of(at.group), in_group(at.in_group);
    const Lanes<V> a_of(a);
    Lanes<V> before(zero()), behind(zero());
    for (std::size_t lane = 0; lane < hn::Lanes(D()); ++lane) {
      const auto from = source.lane(k.x[lane], lane);
      const float a1 = a_of.x[lane], a0 = 1 - a1;
      const int g = group_of.x[lane], j = in_group.x[lane];
      const Eight density = from.group(group_index(layout, g, i.x[lane]), a0, a1).densities();
      const Eight mass = masses(density, from.lines + layout.r + g * BatchLayout::group);
      const std::ptrdiff_t length = layout.groups - 1, first = layout.starts + i.x[lane] * length;
      if (g > 0) before.x[lane] = from.row(first, length, a0, a1).at(g - 1);
      before.x[lane] += mass.sum(0, j);
      const auto start = from.row(first + g);
      if (g < length && start.at(0) < BatchLayout::beyond / 2) {  // there is a next group
        const auto whole = from.row(layout.along);
        behind.x[lane] = a0 * (whole.at(i.x[lane]) - start.at(0)) + a1 * (whole.at(i.x[lane] + 1) - start.at(length));
      }
      behind.x[lane] += mass.sum(j + 1, BatchLayout::group);
    }
    return {before.vector(), behind.vector()};
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
    const V before = masses_around(m.sector, m.a, at).before;
    const V inside =
        hn::Mul(hn::Mul(m.a, hn::Sub(m.sector.phi1, m.sector.phi0)), hn::Mul(set(0.5f), hn::Add(m.sector.m0, m.mass)));
    const V u = hn::Div(hn::Add(m.sector.before, inside), set(layout.whole_mass()));
    const V s = at.cell.place(radius), v = quotient(hn::Add(before, at.cell.mass(s)), m.mass);
    return {hn::Min(u, set(1)), hn::Min(v, set(1)), at.cell.density_at(radius, gap, at.end)};
  }
};
using OneDiagram = DiagramLanes<One>;

/// Displacement between a diagram and the next one. d0 is the one with the lesser weight.
struct DisplacementLanes {
  OneDiagram d0, d1;
  V w0, w1;

  HWY_INLINE DisplacementLanes(const BatchLayout& layout, VI k, V alpha)
      : DisplacementLanes(layout, k, hn::Add(k, set_int(1)), alpha) {}
  HWY_INLINE DisplacementLanes(const BatchLayout& layout, VI k, VI next, V alpha)
      : d0{layout, One(layout, hn::IfThenElse(hn::RebindMask(DI(), hn::Lt(alpha, set(0.5f))), next, k))},
        d1{layout, One(layout, hn::Sub(hn::Add(k, next), d0.source.k))},
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
        const OneDiagram::Ring ring = d.ring(sector.i, a, d.find_r(clamp01(r)));
        const OneDiagram::Masses around = d.masses_around(sector, a, ring);
        const V r0 = ring.cell.r0, r1 = ring.end;
        below = hn::Mul(hn::IfThenElse(outer, around.behind, around.before), scale);
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
