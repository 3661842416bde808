// What Stack answers, on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_STACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_STACK_INL_H
#undef GONIO_BATCH_STACK_INL_H
#else
#define GONIO_BATCH_STACK_INL_H
#endif

#include <algorithm>

#include <gonio/brdf/batch/charts-inl.h>
#include <gonio/brdf/batch/maps-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

/// The diagram before an incident angle, and how far the angle is from there to the next: Stack::Place.
struct Place {
  VI k;
  V alpha;
};
HWY_INLINE Place place_among(const float* angles, int count, V theta_i) {
  if (count == 1) return {hn::Zero(DI()), zero()};
  const VI k = find(angles, hn::Zero(DI()), count, theta_i);
  const V first = at(angles, k);
  return {k, clamp01(hn::Div(hn::Sub(theta_i, first), hn::Sub(at(angles + 1, k), first)))};
}

HWY_INLINE Place place_of(const BatchLayout& layout, V theta_i) {
  if (layout.angles == 1) return {hn::Zero(DI()), zero()};
  const float* angles = layout.values.data();
  const V part = hn::Mul(theta_i, set(BatchLayout::guide_parts / (pi<float> / 2)));
  const VI entry = hn::Min(hn::ConvertTo(DI(), hn::Max(part, zero())), set_int(BatchLayout::guide_parts - 1));
  VI k = hn::GatherIndex(DI(), layout.guide.data(), entry);
  Two around = two_at(angles, k);
  for (int step = 0; step < layout.guide_steps; ++step) {
    const M before = hn::Lt(around.second, theta_i);
    const VI next = hn::IfThenElse(hn::RebindMask(DI(), before), hn::Add(k, set_int(1)), k);
    k = hn::Min(next, set_int(layout.angles - 2));
    around = two_at(angles, k);
  }
  return {k, clamp01(hn::Div(hn::Sub(theta_i, around.first), hn::Sub(around.second, around.first)))};
}

/// Calls maps(lanes) with what serves a place: one diagram, a blend or a displacement.
template <class Call>
HWY_INLINE auto with_lanes(const BatchLayout& layout, const Place& place, const Call& call) {
  const float* blocks = layout.values.data() + layout.angles;
  const VI block = hn::Mul(place.k, set_int(layout.stride));
  if (layout.angles == 1) return call(OneDiagram{layout, blocks, block});
  if (layout.interpolation == Interpolation::nearest) {
    const VI next = hn::Add(block, set_int(layout.stride));
    const auto first_is_closer = hn::RebindMask(DI(), hn::Lt(place.alpha, set(0.5f)));
    return call(OneDiagram{layout, blocks, hn::IfThenElse(first_is_closer, block, next)});
  }
  if (layout.interpolation == Interpolation::blend) return call(BlendLanes{layout, blocks, block, place.alpha});
  return call(DisplacementLanes(layout, blocks, block, place.alpha));
}

struct Draw {
  Direction wo;
  V pdf;
};
/// Stack::sample().
HWY_INLINE Draw sample_stack(const BatchLayout& layout, const Place& place, V theta_i, V u, V v) {
  const Folded uv = square_to_diagram(u, v, layout.half_azimuth);
  const OnDisk s = with_lanes(layout, place, [&](const auto& lanes) HWY_ATTR { return lanes.sample(uv.u, uv.v); });
  const V r = hn::Min(s.r, set(1 - 0.5f * 1.1920929e-7f));
  SinCos phi = sin_cos(s.phi);
  phi.sin = hn::IfThenElse(uv.mirrored, hn::Neg(phi.sin), phi.sin);
  if (!layout.half_chart) return {to_hemisphere(r, phi), s.pdf};
  const HalfChart::Image image = HalfChart(theta_i).direction(r, phi);
  return {image.wo, hn::Div(s.pdf, image.jacobian)};
}

HWY_INLINE DiskPlace to_disk(const BatchLayout& layout, V theta_i, const Direction& wo) {
  DiskPlace place = layout.half_chart ? HalfChart(theta_i).disk(wo) : from_hemisphere(wo);
  if (!layout.half_azimuth)
    place.phi = hn::IfThenElse(hn::Lt(wo.y, zero()), hn::Sub(set(2 * pi<float>), place.phi), place.phi);
  return place;
}

/// Stack::pdf().
HWY_INLINE V pdf_stack(const BatchLayout& layout, const Place& place, V theta_i, const Direction& wo) {
  const DiskPlace disk = to_disk(layout, theta_i, {wo.x, wo.y, hn::Max(wo.z, zero())});
  const V density = with_lanes(layout, place, [&](const auto& lanes) HWY_ATTR { return lanes.pdf(disk.r, disk.phi); });
  return hn::IfThenElseZero(hn::Ge(wo.z, zero()), hn::Div(density, disk.jacobian));
}

/// Stack::invert(); all zero where that is empty.
struct Inverted {
  V u, v, pdf;
};
HWY_INLINE Inverted invert_stack(const BatchLayout& layout, const Place& place, V theta_i, const Direction& wo) {
  const DiskPlace disk = to_disk(layout, theta_i, {wo.x, wo.y, hn::Max(wo.z, zero())});
  const Uniform at = with_lanes(layout, place, [&](const auto& lanes) HWY_ATTR { return lanes.invert(disk.r, disk.phi); });
  const Square square = diagram_to_square(at.u, at.v, hn::Lt(wo.y, zero()), layout.half_azimuth);
  const M found = hn::And(hn::Ge(wo.z, zero()), hn::Gt(at.pdf, zero()));
  return {hn::IfThenElseZero(found, square.u), hn::IfThenElseZero(found, square.v),
          hn::IfThenElseZero(found, hn::Div(at.pdf, disk.jacobian))};
}

/// Runs body(inputs, outputs) on whole vectors; the last, incomplete one by way of copies.
template <int inputs, int outputs, class Body>
HWY_INLINE void for_vectors(std::size_t count, const float* const (&in)[inputs], float* const (&out)[outputs],
                            const Body& body) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  V x[inputs], y[outputs];
  std::size_t k = 0;
  for (; k + lanes <= count; k += lanes) {
    for (int i = 0; i < inputs; ++i) x[i] = hn::LoadU(d, in[i] + k);
    body(x, y);
    for (int i = 0; i < outputs; ++i) hn::StoreU(y[i], d, out[i] + k);
  }
  const std::size_t rest = count - k;
  if (rest == 0) return;
  HWY_ALIGN float copy[hn::MaxLanes(d)] = {};
  for (int i = 0; i < inputs; ++i) {
    std::copy_n(in[i] + k, rest, copy);
    std::fill(copy + rest, copy + lanes, in[i][count - 1]);
    x[i] = hn::Load(d, copy);
  }
  body(x, y);
  for (int i = 0; i < outputs; ++i) {
    hn::Store(y[i], d, copy);
    std::copy_n(copy, rest, out[i] + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
