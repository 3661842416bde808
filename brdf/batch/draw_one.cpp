#include <gonio/brdf/batch/batch_bsdf.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/brdf/value/frame.h>
#include <gonio/mapping/numeric/monotone_root.h>

#define GONIO_LANE_CAP 2
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/draw_one.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/kernels/cells-inl.h>
#include <gonio/brdf/batch/kernels/frame-inl.h>
#include <gonio/brdf/batch/kernels/search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET != HWY_SCALAR
// One draw at a time. The two diagrams of a displacement are the two lanes of a vector: a draw is one long chain, and
// the shorter its code the more of the next draw is under way.

/// The diagram before an incident angle, and how far the angle is from there to the next: see Stack::Pair.
struct BracketOfOne {
  std::ptrdiff_t k;
  float alpha;
};
HWY_INLINE BracketOfOne bracket_of_one(const BatchAngles& angles, const IncidentAngle& i) {
  if (angles.count == 1) return {0, 0};
  const float r = hn::GetLane(i.r);
  const int part = static_cast<int>(r * static_cast<float>(angles.guide_parts));
  int k = angles.guide[static_cast<std::size_t>(std::min(part, angles.guide_parts - 1))];
  for (int step = 0; step < angles.guide_steps; ++step) k = std::min(k + (angles.radii[k + 1] < r), angles.count - 2);
  const V first = set(angles.values[k]), last = set(angles.values[k + 1]);
  return {k, hn::GetLane(clamp01(hn::Div(hn::Sub(i.theta, first), hn::Sub(last, first))))};
}

/// Colour::eval(): four floats.
HWY_INLINE void colour_of_one(const BatchColour& colour, const BracketOfOne& bracket, float u, float v, float* to) {
  const V side = set(static_cast<float>(colour.side)), half = set(0.5f);
  const V across = hn::MulSub(set(u), side, half), along = hn::MulSub(hn::Abs(hn::Sub(set(v), half)), side, half);
  const float x = hn::GetLane(hn::Min(hn::Max(across, zero()), hn::Sub(side, set(1))));
  const float y = hn::GetLane(hn::Min(hn::Max(along, zero()), hn::MulSub(side, half, set(1))));
  const int i = std::min(static_cast<int>(x), colour.side - 2), j = std::min(static_cast<int>(y), colour.last_row);
  const std::ptrdiff_t cell = bracket.k * colour.layer + j * colour.side + i;
  mix_cells(colour, colour.codes.data() + 3 * cell, x - static_cast<float>(i), y - static_cast<float>(j), bracket.alpha,
            to);
}

/// Numbers of two diagrams, as lanes.
HWY_INLINE V lanes(float x0, float x1) { return hn::InterleaveLower(D(), set(x0), set(x1)); }
HWY_INLINE float second_lane(V x) { return hn::ExtractLane(x, 1); }

/// Where a draw falls in one or two diagrams.
struct InDiagrams {
  V mass, phi, r, gap, pdf;
};

/// Diagram::sample(), the mass before the meridian being `target`; of the first source alone, or of both.
template <bool both, class Source>
HWY_INLINE InDiagrams draw_maps(const BatchLayout& layout, const Source& source0, const Source& source1, V target, V v,
                                V rest) {
  struct Sector {
    std::ptrdiff_t i;
    float lines[4];  // phi and mass of its meridians
    float below;
  };
  const auto sector = [&](const Source& source) GONIO_INLINED {
    Sector s;
    s.i = find_meridian(layout, source, hn::GetLane(target));
    copy_meridians(layout, source, s.i, s.lines);
    s.below = source.row(layout.before).at(s.i);
    return s;
  };
  const Sector s0 = sector(source0), s1 = both ? sector(source1) : s0;
  const V phi0 = lanes(s0.lines[0], s1.lines[0]), m0 = lanes(s0.lines[1], s1.lines[1]);
  const V width = hn::Sub(lanes(s0.lines[2], s1.lines[2]), phi0), m1 = lanes(s0.lines[3], s1.lines[3]);
  const V a = invert_azimuth(width, m0, m1, hn::Sub(target, lanes(s0.below, s1.below))), mass = mix(a, m0, m1);

  const V next = hn::Mul(v, mass), b = hn::Sub(set(1), a);
  struct Ring {
    float cell[4];  // radii and densities of its parallels
    float before;
  };
  const auto ring = [&](const Source& source, std::ptrdiff_t i, float b_of, float a_of, float before) GONIO_INLINED {
    const Group group = find_group(layout, source, i, b_of, a_of, before);
    Ring found;
    found.before = find_in_group(layout, source, group, i, b_of, a_of, before, found.cell);
    return found;
  };
  const Ring r0 = ring(source0, s0.i, hn::GetLane(b), hn::GetLane(a), hn::GetLane(next));
  const Ring r1 = both ? ring(source1, s1.i, second_lane(b), second_lane(a), second_lane(next)) : r0;
  Cell c{lanes(r0.cell[0], r1.cell[0]), zero(), lanes(r0.cell[2], r1.cell[2]), lanes(r0.cell[3], r1.cell[3])};
  const V end = lanes(r0.cell[1], r1.cell[1]);
  c.h = hn::Sub(end, c.r0);
  CellDraw draw(c, end, lanes(r0.before, r1.before), mass, v, rest);
  draw.keep_off_end(both ? 0 : rim);
  return {mass, hn::MulAdd(a, width, phi0), draw.r(), draw.gap(), draw.density()};
}

/// Displacement::sample().
HWY_INLINE InDiagrams draw_displaced(const BatchLayout& layout, std::ptrdiff_t k, float alpha, V target, V v, V rest) {
  const auto all = layout.diagrams();
  const OneSource first(all, k), second(all, k + 1);
  const InDiagrams x = draw_maps<true>(layout, first, second, target, hn::Max(v, set(smallest_v)), rest);
  const auto other = [](V lane) HWY_ATTR { return hn::Reverse2(D(), lane); };
  const V w1 = set(alpha), w0 = hn::Sub(set(1), w1);
  const auto between = [&](V lane) HWY_ATTR { return hn::MulAdd(w0, lane, hn::Mul(w1, other(lane))); };
  const V r = between(x.r), whole = set(layout.whole_mass());
  return {x.mass, between(x.phi), r, between(x.gap),
          displaced_density(w0, w1, whole, {x.mass, x.r, x.pdf}, {other(x.mass), other(x.r), other(x.pdf)}, r)};
}

/// Bsdf::sample(), of direction and pdf alone where there is no colour.
bool draw(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
          BsdfSample& out) {
  if (!(gonio::is_above(wi) && std::isfinite(u.x + u.y))) return false;
  const Frame frame({set(wi.x), set(wi.y), set(wi.z)});
  const BracketOfOne bracket = bracket_of_one(layout.angles, frame.i);
  if (colour != nullptr) {
    float rgb[4];
    colour_of_one(*colour, colour->same_angles ? bracket : bracket_of_one(colour->angles, frame.i), u.x, u.y, rgb);
    out.weight = {rgb[0], rgb[1], rgb[2]};
  }
  const Folded uv = square_to_diagram(set(u.x), set(u.y), layout.half_azimuth);
  const V target = hn::Mul(uv.u, set(layout.whole_mass()));
  InDiagrams at;
  if (layout.angles.count > 1 && layout.interpolation == Interpolation::displacement) {
    at = draw_displaced(layout, bracket.k, bracket.alpha, target, uv.v, uv.rest);
    // What takes the pdf from the direction, which vectors of two do not.
    if (HWY_UNLIKELY(hn::GetLane(uv.rest) < tail || hn::GetLane(at.gap) < rim))
      return draw_in_one_lane(layout, colour, wi, u, out);
  } else if (layout.angles.count > 1 && layout.interpolation == Interpolation::blend) {
    const TwoSources source(layout.diagrams(), bracket.k, bracket.alpha);
    at = draw_maps<false>(layout, source, source, target, uv.v, uv.rest);
  } else {
    const OneSource source(layout.diagrams(), bracket.k + (layout.angles.count > 1 && !(bracket.alpha < 0.5f) ? 1 : 0));
    at = draw_maps<false>(layout, source, source, target, uv.v, uv.rest);
  }
  const Drawn drawn = from_disk(layout, frame.i.theta, at.r, at.gap, at.phi, uv.sign(), at.pdf);
  const Direction wo = to_surface(frame.cos_phi, frame.sin_phi, drawn.wo);
  out.wo = {hn::GetLane(wo.x), hn::GetLane(wo.y), hn::GetLane(wo.z)}, out.pdf = hn::GetLane(drawn.pdf);
  if (colour != nullptr) out.weight *= std::min(out.wo.z * (1 / Colour::min_cosine), 1.0f);
  return out.pdf > 0 && out.wo.z > 0;
}
#else
bool draw(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
          BsdfSample& out) {
  return draw_in_one_lane(layout, colour, wi, u, out);
}
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(draw);

}  // namespace

bool draw_one(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
              BsdfSample& out) noexcept {
  return HWY_DYNAMIC_DISPATCH(draw)(layout, colour, wi, u, out);
}

}  // namespace gonio
#endif
