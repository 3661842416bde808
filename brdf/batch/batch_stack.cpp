#include <algorithm>

#include <gonio/brdf/batch/batch_stack.h>
#include <gonio/mapping/monotone_root.h>

// Instruction sets that bring these kernels nothing over the next lower one.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/batch_stack.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/charts-inl.h>
#include <gonio/brdf/batch/maps-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

/// Calls maps(lanes) with what serves the incident angles: one diagram, a blend or a displacement.
template <class Call>
HWY_INLINE auto with_lanes(const BatchLayout& layout, V theta_i, const Call& call) {
  const float *angles = layout.values.data(), *blocks = angles + layout.angles;
  const VI k = find(angles, hn::Zero(DI()), layout.angles, theta_i);
  const VI block = hn::Mul(k, set_int(layout.stride));
  if (layout.angles == 1) return call(OneDiagram{layout, blocks, block});
  const V first = at(angles, k);
  const V alpha = clamp01(hn::Div(hn::Sub(theta_i, first), hn::Sub(at(angles + 1, k), first)));
  if (layout.interpolation == Interpolation::nearest) {
    const VI next = hn::Add(block, set_int(layout.stride));
    const auto first_is_closer = hn::RebindMask(DI(), hn::Lt(alpha, set(0.5f)));
    return call(OneDiagram{layout, blocks, hn::IfThenElse(first_is_closer, block, next)});
  }
  if (layout.interpolation == Interpolation::blend) return call(BlendLanes{layout, blocks, block, alpha});
  return call(DisplacementLanes(layout, blocks, block, alpha));
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

void sample_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[3], float* const (&out)[4]) {
  for_vectors<3, 4>(count, in, out, [&](const V(&x)[3], V(&y)[4]) HWY_ATTR {
    const Folded uv = square_to_diagram(x[1], x[2], layout.half_azimuth);
    const OnDisk s = with_lanes(layout, x[0], [&](const auto& lanes) HWY_ATTR { return lanes.sample(uv.u, uv.v); });
    const V r = hn::Min(s.r, set(1 - 0.5f * 1.1920929e-7f));
    SinCos phi = sin_cos(s.phi);
    phi.sin = hn::IfThenElse(uv.mirrored, hn::Neg(phi.sin), phi.sin);
    Direction wo;
    y[3] = s.pdf;
    if (layout.half_chart) {
      const HalfChart::Image image = HalfChart(x[0]).direction(r, phi);
      wo = image.wo;
      y[3] = hn::Div(s.pdf, image.jacobian);
    } else {
      wo = to_hemisphere(r, phi);
    }
    y[0] = wo.x, y[1] = wo.y, y[2] = wo.z;
  });
}

HWY_INLINE DiskPlace to_disk(const BatchLayout& layout, V theta_i, const Direction& wo) {
  DiskPlace place = layout.half_chart ? HalfChart(theta_i).disk(wo) : from_hemisphere(wo);
  if (!layout.half_azimuth)
    place.phi = hn::IfThenElse(hn::Lt(wo.y, zero()), hn::Sub(set(2 * pi<float>), place.phi), place.phi);
  return place;
}

void pdf_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[4], float* const (&out)[1]) {
  for_vectors<4, 1>(count, in, out, [&](const V(&x)[4], V(&y)[1]) HWY_ATTR {
    const DiskPlace place = to_disk(layout, x[0], {x[1], x[2], hn::Max(x[3], zero())});
    const V density = with_lanes(layout, x[0], [&](const auto& lanes) HWY_ATTR { return lanes.pdf(place.r, place.phi); });
    y[0] = hn::IfThenElseZero(hn::Ge(x[3], zero()), hn::Div(density, place.jacobian));
  });
}

void invert_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[4], float* const (&out)[3]) {
  for_vectors<4, 3>(count, in, out, [&](const V(&x)[4], V(&y)[3]) HWY_ATTR {
    const DiskPlace place = to_disk(layout, x[0], {x[1], x[2], hn::Max(x[3], zero())});
    const Uniform at = with_lanes(layout, x[0], [&](const auto& lanes) HWY_ATTR { return lanes.invert(place.r, place.phi); });
    const Square square = diagram_to_square(at.u, at.v, hn::Lt(x[2], zero()), layout.half_azimuth);
    const M found = hn::And(hn::Ge(x[3], zero()), hn::Gt(at.pdf, zero()));
    y[0] = hn::IfThenElseZero(found, square.u);
    y[1] = hn::IfThenElseZero(found, square.v);
    y[2] = hn::IfThenElseZero(found, hn::Div(at.pdf, place.jacobian));
  });
}

const char* target() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(sample_kernel);
HWY_EXPORT(pdf_kernel);
HWY_EXPORT(invert_kernel);
HWY_EXPORT(target);

}  // namespace

BatchStack::BatchStack(const Stack<float>& stack) : layout_(stack) {}

void BatchStack::sample_n(std::size_t count, const float* theta_i, const float* u, const float* v, float* wo_x,
                          float* wo_y, float* wo_z, float* pdf) const noexcept {
  HWY_DYNAMIC_DISPATCH(sample_kernel)(layout_, count, {theta_i, u, v}, {wo_x, wo_y, wo_z, pdf});
}

void BatchStack::pdf_n(std::size_t count, const float* theta_i, const float* wo_x, const float* wo_y, const float* wo_z,
                       float* pdf) const noexcept {
  HWY_DYNAMIC_DISPATCH(pdf_kernel)(layout_, count, {theta_i, wo_x, wo_y, wo_z}, {pdf});
}

void BatchStack::invert_n(std::size_t count, const float* theta_i, const float* wo_x, const float* wo_y,
                          const float* wo_z, float* u, float* v, float* pdf) const noexcept {
  HWY_DYNAMIC_DISPATCH(invert_kernel)(layout_, count, {theta_i, wo_x, wo_y, wo_z}, {u, v, pdf});
}

const char* batch_target() noexcept { return HWY_DYNAMIC_DISPATCH(target)(); }

}  // namespace gonio
#endif
