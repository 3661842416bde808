// What Stack answers, on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_STACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_STACK_INL_H
#undef GONIO_BATCH_STACK_INL_H
#else
#define GONIO_BATCH_STACK_INL_H
#endif

#include <algorithm>

#include <gonio/brdf/batch/kernels/charts-inl.h>
#include <gonio/brdf/batch/kernels/frame-inl.h>
#include <gonio/brdf/batch/kernels/maps-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// Elements that are looked up together, a multiple of the lanes of a vector.
#if GONIO_LANE_CAP == 1
constexpr std::size_t block_size = 1;
#else
constexpr std::size_t block_size = 128;
#endif

/// The diagram before an incident angle, and how far the angle is from there to the next: see Stack::Pair.
struct Bracket {
  VI k;
  V alpha;
};
HWY_INLINE Bracket bracket_of(const BatchAngles& angles, const IncidentAngle& i) {
  if (angles.count == 1) return {hn::Zero(DI()), zero()};
  const V part = hn::Mul(i.r, set(static_cast<float>(angles.guide_parts)));
  VI k = hn::And(two_shorts(angles.guide.data(), hn::Min(truncated(part), set_int(angles.guide_parts - 1))),
                 set_int(0xffff));
  for (int step = 0; step < angles.guide_steps; ++step) {
    const M before = hn::Lt(at(angles.radii.data() + 1, k), i.r);
    const VI next = hn::IfThenElse(hn::RebindMask(DI(), before), hn::Add(k, set_int(1)), k);
    k = hn::Min(next, set_int(angles.count - 2));
  }
  const Two around = two_at(angles.values.data(), k);
  return {k, clamp01(hn::Div(hn::Sub(i.theta, around.first), hn::Sub(around.second, around.first)))};
}

/// Those of `count` elements.
struct Brackets {
  HWY_ALIGN int k[block_size];
  HWY_ALIGN float alpha[block_size];

  HWY_INLINE Brackets(const BatchAngles& angles, std::size_t count, const float* theta_i, const float* r) {
    const D d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const Bracket bracket = bracket_of(angles, {hn::LoadU(d, theta_i + i), hn::LoadU(d, r + i)});
      hn::Store(bracket.k, DI(), k + i), hn::Store(bracket.alpha, d, alpha + i);
    }
  }
};

/// The diagram before an incident angle, or, for `nearest`, the closer one.
HWY_INLINE VI diagram_at(const BatchLayout& layout, const Bracket& bracket) {
  if (layout.interpolation != Interpolation::nearest) return bracket.k;
  const auto first_is_closer = hn::RebindMask(DI(), hn::Lt(bracket.alpha, set(0.5f)));
  return hn::IfThenElse(first_is_closer, bracket.k, hn::Add(bracket.k, set_int(layout.angles.count > 1 ? 1 : 0)));
}

/// Calls maps(lanes) with what serves a place: one diagram, a blend or a displacement.
template <class Call>
HWY_INLINE auto with_lanes(const BatchLayout& layout, const Bracket& bracket, const Call& call) {
  const VI k = diagram_at(layout, bracket);
  if (layout.angles.count == 1 || layout.interpolation == Interpolation::nearest)
    return call(OneDiagram{layout, One(layout, k)});
  if (layout.interpolation == Interpolation::blend)
    return call(DiagramLanes<Blended>{layout, Blended(layout, k, bracket.alpha)});
  return call(DisplacementLanes(layout, k, bracket.alpha));
}

HWY_INLINE OnDisk to_disk(const BatchLayout& layout, V theta_i, const Direction& wo) {
  OnDisk disk = layout.half_chart ? HalfChart(theta_i).disk(wo) : from_hemisphere(wo);
  if (!layout.half_azimuth)
    disk.phi = hn::IfThenElse(hn::Lt(wo.y, zero()), hn::Sub(set(2 * pi<float>), disk.phi), disk.phi);
  return disk;
}

/// Stack::pdf().
HWY_INLINE V pdf_stack(const BatchLayout& layout, const Bracket& bracket, V theta_i, const Direction& wo) {
  const OnDisk disk = to_disk(layout, theta_i, {wo.x, wo.y, hn::Max(wo.z, zero())});
  const V density =
      with_lanes(layout, bracket, [&](const auto& lanes) HWY_ATTR { return lanes.pdf(disk.r, disk.gap, disk.phi); });
  return hn::IfThenElseZero(hn::Ge(wo.z, zero()), hn::Div(density, disk.jacobian));
}

/// Stack::invert(); all zero where that is empty.
struct Inverted {
  V u, v, pdf;
};
HWY_INLINE Inverted invert_stack(const BatchLayout& layout, const Bracket& bracket, V theta_i, const Direction& wo) {
  const OnDisk disk = to_disk(layout, theta_i, {wo.x, wo.y, hn::Max(wo.z, zero())});
  const Uniform at =
      with_lanes(layout, bracket, [&](const auto& lanes) HWY_ATTR { return lanes.invert(disk.r, disk.gap, disk.phi); });
  const Square square = diagram_to_square(at.u, at.v, hn::Lt(wo.y, zero()), layout.half_azimuth);
  const M found = hn::And(hn::Ge(wo.z, zero()), hn::Gt(at.pdf, zero()));
  return {hn::IfThenElseZero(found, square.u), hn::IfThenElseZero(found, square.v),
          hn::IfThenElseZero(found, hn::Div(at.pdf, disk.jacobian))};
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
