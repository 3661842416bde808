// Stack::sample() for a few elements at once, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_DRAW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_DRAW_INL_H
#undef GONIO_BATCH_DRAW_INL_H
#else
#define GONIO_BATCH_DRAW_INL_H
#endif

#include <algorithm>
#include <type_traits>

#include <gonio/brdf/batch/kernels/stack-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

// A draw goes in stages over all elements of a block, arithmetic on vectors and look-ups element by element in turn:
// within a stage nothing waits for anything, and what one stage has stored is there when the next one loads it.

/// The look-ups of the maps of Diagram. An element is one diagram, or two that are blended, and its two uniform
/// numbers.
template <std::size_t size>
struct MapBlock {
  using Floats = float[size];
  HWY_ALIGN Floats target, below;  // mass before the position that is searched, before its cell
  HWY_ALIGN float
      cell[4 * size];  // phi, mass, phi, mass of the meridians, then r, r, density, density of the parallels about it
  HWY_ALIGN Floats a, b, phi, mass, r, gap, pdf;  // b = 1 - a
  HWY_ALIGN int diagram[size];                    // the first of two
  int group[size], meridian[size];
};

// What a loop reads is on its way by the end of the one before.

template <std::size_t size, class SourceOf>
HWY_INLINE void find_meridians(const BatchLayout& layout, std::size_t count, MapBlock<size>& map,
                               const SourceOf& source_of) {
  const std::ptrdiff_t length = layout.groups - 1;
  for (std::size_t k = 0; k < count; ++k) {
    const auto source = source_of(k);
    const std::ptrdiff_t i = find_meridian(layout, source, map.target[k]);
    source.row(layout.starts + i * length).prefetch();
    copy_meridians(layout, source, i, map.cell + 4 * k);
    map.below[k] = source.row(layout.before).at(i), map.meridian[k] = static_cast<int>(i);
  }
}

template <std::size_t size, class SourceOf>
HWY_INLINE void find_groups(const BatchLayout& layout, std::size_t count, MapBlock<size>& map,
                            const SourceOf& source_of) {
  for (std::size_t k = 0; k < count; ++k) {
    const auto source = source_of(k);
    const std::ptrdiff_t i = map.meridian[k];
    const Group group = find_group(layout, source, i, map.b[k], map.a[k], map.target[k]);
    source.group(group_index(layout, group.g, i), 0, 0).prefetch();
    map.group[k] = static_cast<int>(group.g), map.below[k] = group.start;
  }
}

template <std::size_t size, class SourceOf>
HWY_INLINE void find_parallels(const BatchLayout& layout, std::size_t count, MapBlock<size>& map,
                               const SourceOf& source_of) {
  for (std::size_t k = 0; k < count; ++k) {
    map.below[k] = find_in_group(layout, source_of(k), Group{map.group[k], map.below[k]}, map.meridian[k], map.b[k],
                                 map.a[k], map.target[k], map.cell + 4 * k);
  }
}

/// Diagram::sample() of `count` elements with their `diagram` and `target`, the mass before the meridian; v(k) is the
/// other uniform number of the elements from k on, rest(k) is 1 - v(k). Draws are at least `at_horizon` from there.
template <std::size_t size, class SourceOf, class V0, class V1>
HWY_INLINE void draw_map(const BatchLayout& layout, std::size_t count, MapBlock<size>& map, const SourceOf& source_of,
                         const V0& v, const V1& rest, float at_horizon) {
  const D d;
  find_meridians(layout, count, map, source_of);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    V phi0, phi1, m0, m1;
    load4(map.cell + 4 * k, phi0, m0, phi1, m1);
    const V width = hn::Sub(phi1, phi0), inside = hn::Sub(hn::Load(d, map.target + k), hn::Load(d, map.below + k));
    const V a = invert_azimuth(width, m0, m1, inside), mass = mix(a, m0, m1);
    hn::Store(a, d, map.a + k), hn::Store(hn::Sub(set(1), a), d, map.b + k), hn::Store(mass, d, map.mass + k);
    hn::Store(hn::MulAdd(a, width, phi0), d, map.phi + k);
    hn::Store(hn::Mul(v(k), mass), d, map.target + k);
  }
  find_groups(layout, count, map, source_of);
  find_parallels(layout, count, map, source_of);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    Cell c;
    V r1;
    load4(map.cell + 4 * k, c.r0, r1, c.d0, c.d1);
    c.h = hn::Sub(r1, c.r0);
    CellDraw draw(c, r1, hn::Load(d, map.below + k), hn::Load(d, map.mass + k), v(k), rest(k));
    draw.keep_off_end(at_horizon);
    hn::Store(draw.r(), d, map.r + k), hn::Store(draw.gap(), d, map.gap + k), hn::Store(draw.density(), d, map.pdf + k);
  }
}

/// Where the elements of a block fall on the disk.
struct DiskBlock {
  using Floats = float[block_size];
  HWY_ALIGN int diagram[block_size];  // that before the incident angle
  HWY_ALIGN Floats target, v,
      rest;  // the uniform numbers of the diagram, the first one times its mass, and 1 less the second
  HWY_ALIGN Floats r, gap, phi, pdf;
};

/// Of one diagram each, or, if `blended`, of the one before the incident angle and the next: Blend::sample().
template <bool blended>
HWY_INLINE void draw_single(const BatchLayout& layout, std::size_t count, const float* alpha, DiskBlock& disk) {
  const D d;
  MapBlock<block_size> map;
  std::copy_n(disk.diagram, count, map.diagram), std::copy_n(disk.target, count, map.target);
  const auto all = layout.diagrams();
  draw_map(
      layout, count, map,
      [&, all](std::size_t k) GONIO_INLINED {
        if constexpr (blended)
          return TwoSources(all, map.diagram[k], alpha[k]);
        else
          return OneSource(all, map.diagram[k]);
      },
      [&](std::size_t k) GONIO_INLINED { return hn::Load(d, disk.v + k); },
      [&](std::size_t k) GONIO_INLINED { return hn::Load(d, disk.rest + k); }, rim);
  std::copy_n(map.r, count, disk.r), std::copy_n(map.gap, count, disk.gap);
  std::copy_n(map.phi, count, disk.phi), std::copy_n(map.pdf, count, disk.pdf);
}

/// The pdf of a displaced draw from its place. Hardly ever called, and not to be inlined: a draw needs its registers.
static HWY_NOINLINE HWY_MAYBE_UNUSED V displaced_pdf(const BatchLayout& layout, VI k, V alpha, V r, V gap, V phi) {
  return DisplacementLanes(layout, k, alpha).pdf(r, gap, phi);
}

/// Displacement::sample(). Both diagrams of all elements are drawn as one block, those before the incident angles
/// first.
HWY_INLINE void draw_displacement(const BatchLayout& layout, std::size_t count, const float* alpha, DiskBlock& disk) {
  const D d;
  const DI di;
  MapBlock<2 * block_size> map;
  const V least = set(smallest_v), whole = set(layout.whole_mass());
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const V target = hn::Load(d, disk.target + k);
    hn::Store(target, d, map.target + k), hn::Store(target, d, map.target + count + k);
    const VI diagram = hn::Load(di, disk.diagram + k);
    hn::Store(diagram, di, map.diagram + k), hn::Store(hn::Add(diagram, set_int(1)), di, map.diagram + count + k);
    hn::Store(hn::Max(hn::Load(d, disk.v + k), least), d, disk.v + k);
  }
  const auto shared = [&](const float* x, std::size_t k)
                          GONIO_INLINED { return hn::Load(d, x + (k < count ? k : k - count)); };
  draw_map(
      layout, 2 * count, map,
      [&map, all = layout.diagrams()](std::size_t k) GONIO_INLINED { return OneSource(all, map.diagram[k]); },
      [&](std::size_t k) GONIO_INLINED { return shared(disk.v, k); },
      [&](std::size_t k) GONIO_INLINED { return shared(disk.rest, k); }, 0);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const V w1 = hn::Load(d, alpha + k), w0 = hn::Sub(set(1), w1);
    const auto first = [&](const float* x) GONIO_INLINED { return hn::Load(d, x + k); };
    const auto second = [&](const float* x) GONIO_INLINED { return hn::Load(d, x + count + k); };
    const auto between = [&](V a, V b) GONIO_INLINED { return hn::MulAdd(w0, a, hn::Mul(w1, b)); };
    const Displaced at0{first(map.mass), first(map.r), first(map.pdf)},
        at1{second(map.mass), second(map.r), second(map.pdf)};
    V r = between(at0.r, at1.r), gap = between(first(map.gap), second(map.gap));
    const V phi = between(first(map.phi), second(map.phi));
    V pdf = displaced_density(w0, w1, whole, at0, at1, r);
    const M beyond = hn::Or(hn::Lt(hn::Load(d, disk.rest + k), set(tail)), hn::Lt(gap, set(rim)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, beyond))) {
      r = hn::Min(r, set(1 - rim)), gap = hn::Max(gap, set(rim));
      pdf = hn::IfThenElse(beyond, displaced_pdf(layout, hn::Load(di, disk.diagram + k), w1, r, gap, phi), pdf);
    }
    hn::Store(r, d, disk.r + k), hn::Store(gap, d, disk.gap + k), hn::Store(phi, d, disk.phi + k),
        hn::Store(pdf, d, disk.pdf + k);
  }
}

/// Stack::sample() of `count` elements, at most a block of whole vectors, from their brackets.
HWY_INLINE void draw_stack(const BatchLayout& layout, std::size_t count, const Brackets& brackets, const float* theta_i,
                           const float* u, const float* v, float* x, float* y, float* z, float* pdf) {
  const D d;
  const DI di;
  DiskBlock disk;
  HWY_ALIGN float sign[block_size];  // of phi
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    hn::Store(diagram_at(layout, {hn::Load(di, brackets.k + k), hn::Load(d, brackets.alpha + k)}), di,
              disk.diagram + k);
    const Folded uv = square_to_diagram(hn::LoadU(d, u + k), hn::LoadU(d, v + k), layout.half_azimuth);
    hn::Store(hn::Mul(uv.u, set(layout.whole_mass())), d, disk.target + k), hn::Store(uv.v, d, disk.v + k),
        hn::Store(uv.rest, d, disk.rest + k);
    hn::Store(uv.sign(), d, sign + k);
  }
  if (layout.angles.count == 1 || layout.interpolation == Interpolation::nearest) {
    draw_single<false>(layout, count, brackets.alpha, disk);
  } else if (layout.interpolation == Interpolation::blend) {
    draw_single<true>(layout, count, brackets.alpha, disk);
  } else {
    draw_displacement(layout, count, brackets.alpha, disk);
  }
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const Drawn at = from_disk(layout, hn::LoadU(d, theta_i + k), hn::Load(d, disk.r + k), hn::Load(d, disk.gap + k),
                               hn::Load(d, disk.phi + k), hn::Load(d, sign + k), hn::Load(d, disk.pdf + k));
    hn::StoreU(at.wo.x, d, x + k), hn::StoreU(at.wo.y, d, y + k), hn::StoreU(at.wo.z, d, z + k),
        hn::StoreU(at.pdf, d, pdf + k);
  }
}

/// Calls body(elements, inputs, outputs) for blocks of whole vectors; the last, incomplete one by way of copies. With
/// vectors of one element for the one that there is, the compiler being told so.
#if GONIO_LANE_CAP == 1
template <int inputs, int outputs, class Body>
HWY_INLINE void for_blocks(std::size_t, const float* const (&in)[inputs], float* const (&out)[outputs],
                           const Body& body) {
  body(std::integral_constant<std::size_t, 1>(), in, out);
}
#else
template <int inputs, int outputs, class Body>
HWY_INLINE void for_blocks(std::size_t count, const float* const (&in)[inputs], float* const (&out)[outputs],
                           const Body& body) {
  const std::size_t lanes = hn::Lanes(D());
  const float* x[inputs];
  float* y[outputs];
  for (std::size_t k = 0; k < count;) {
    const std::size_t whole = std::min(block_size, (count - k) / lanes * lanes);
    if (whole > 0) {
      for (int i = 0; i < inputs; ++i) x[i] = in[i] + k;
      for (int i = 0; i < outputs; ++i) y[i] = out[i] + k;
      body(whole, x, y);
      k += whole;
      continue;
    }
    HWY_ALIGN float copies[inputs][hn::MaxLanes(D())], results[outputs][hn::MaxLanes(D())];
    for (int i = 0; i < inputs; ++i) {
      std::fill(std::copy(in[i] + k, in[i] + count, copies[i]), copies[i] + lanes, in[i][count - 1]);
      x[i] = copies[i];
    }
    for (int i = 0; i < outputs; ++i) y[i] = results[i];
    body(lanes, x, y);
    for (int i = 0; i < outputs; ++i) std::copy_n(results[i], count - k, out[i] + k);
    k = count;
  }
}
#endif

/// body(inputs, outputs) on whole vectors.
template <int inputs, int outputs, class Body>
HWY_INLINE void for_vectors(std::size_t count, const float* const (&in)[inputs], float* const (&out)[outputs],
                            const Body& body) {
  for_blocks(count, in, out,
             [&](auto elements, const float* const(&x)[inputs], float* const(&y)[outputs]) GONIO_INLINED {
               const D d;
               V from[inputs], to[outputs];
               for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
                 for (int i = 0; i < inputs; ++i) from[i] = hn::LoadU(d, x[i] + k);
                 body(from, to);
                 for (int i = 0; i < outputs; ++i) hn::StoreU(to[i], d, y[i] + k);
               }
             });
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
