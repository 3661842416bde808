#include <gonio/brdf/batch/batch_sampler.h>
#include <gonio/mapping/monotone_root.h>

// Instruction sets that bring these kernels nothing over the next lower one.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/batch_sampler.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/colour-inl.h>
#include <gonio/brdf/batch/stack-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

/// IncidentFrame.
struct Frame {
  V theta_i, cos_phi, sin_phi;
  M above;

  explicit HWY_INLINE Frame(const Direction& wi) : above(hn::Gt(wi.z, zero())) {
    const V sine = hn::Sqrt(hn::MulAdd(wi.x, wi.x, hn::Mul(wi.y, wi.y)));
    theta_i = abs_atan2(sine, wi.z);
    const M tilted = hn::Gt(sine, zero());
    const V inverse = hn::Div(set(1), sine);
    cos_phi = hn::IfThenElse(tilted, hn::Mul(wi.x, inverse), set(1));
    sin_phi = hn::IfThenElseZero(tilted, hn::Mul(wi.y, inverse));
  }
  HWY_INLINE Direction to_surface(const Direction& w) const {
    return {hn::MulSub(cos_phi, w.x, hn::Mul(sin_phi, w.y)), hn::MulAdd(sin_phi, w.x, hn::Mul(cos_phi, w.y)), w.z};
  }
  HWY_INLINE Direction to_diagram(const Direction& w) const {
    return {hn::MulAdd(cos_phi, w.x, hn::Mul(sin_phi, w.y)), hn::MulSub(cos_phi, w.y, hn::Mul(sin_phi, w.x)), w.z};
  }
};

HWY_INLINE Draw sample_above(const BatchLayout& layout, const Frame& frame, const Place& place, V u, V v) {
  const Draw s = sample_stack(layout, place, frame.theta_i, u, v);
  const M valid = hn::And(frame.above, hn::And(hn::Gt(s.pdf, zero()), hn::Gt(s.wo.z, zero())));
  const Direction wo = frame.to_surface(s.wo);
  return {{hn::IfThenElseZero(valid, wo.x), hn::IfThenElseZero(valid, wo.y), hn::IfThenElseZero(valid, wo.z)},
          hn::IfThenElseZero(valid, s.pdf)};
}

void draw_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[5], float* const (&out)[4]) {
  for_vectors<5, 4>(count, in, out, [&](const V(&x)[5], V(&y)[4]) HWY_ATTR {
    const Frame frame({x[0], x[1], x[2]});
    const Draw s = sample_above(layout, frame, place_of(layout, frame.theta_i), x[3], x[4]);
    y[0] = s.wo.x, y[1] = s.wo.y, y[2] = s.wo.z, y[3] = s.pdf;
  });
}

void draw_colour_kernel(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[5],
                        float* const (&out)[7]) {
  for_vectors<5, 7>(count, in, out, [&](const V(&x)[5], V(&y)[7]) HWY_ATTR {
    const Frame frame({x[0], x[1], x[2]});
    const Draw s = sample_above(layout, frame, place_of(layout, frame.theta_i), x[3], x[4]);
    const Rgb w = colour_at(colour, frame.theta_i, x[3], x[4]);
    const M valid = hn::Gt(s.pdf, zero());
    y[0] = s.wo.x, y[1] = s.wo.y, y[2] = s.wo.z, y[3] = s.pdf;
    y[4] = hn::IfThenElseZero(valid, w.r), y[5] = hn::IfThenElseZero(valid, w.g), y[6] = hn::IfThenElseZero(valid, w.b);
  });
}

void surface_pdf_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[6], float* const (&out)[1]) {
  for_vectors<6, 1>(count, in, out, [&](const V(&x)[6], V(&y)[1]) HWY_ATTR {
    const Frame frame({x[0], x[1], x[2]});
    const V pdf = pdf_stack(layout, place_of(layout, frame.theta_i), frame.theta_i, frame.to_diagram({x[3], x[4], x[5]}));
    y[0] = hn::IfThenElseZero(hn::And(frame.above, hn::Gt(x[5], zero())), pdf);
  });
}

void eval_kernel(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[6],
                 float* const (&out)[3]) {
  for_vectors<6, 3>(count, in, out, [&](const V(&x)[6], V(&y)[3]) HWY_ATTR {
    const Frame frame({x[0], x[1], x[2]});
    const Inverted at = invert_stack(layout, place_of(layout, frame.theta_i), frame.theta_i, frame.to_diagram({x[3], x[4], x[5]}));
    const Rgb w = colour_at(colour, frame.theta_i, at.u, at.v);
    const M valid = hn::And(hn::And(frame.above, hn::Gt(x[5], zero())), hn::Gt(at.pdf, zero()));
    const V scale = hn::IfThenElseZero(valid, hn::Div(at.pdf, x[5]));
    y[0] = hn::Mul(w.r, scale), y[1] = hn::Mul(w.g, scale), y[2] = hn::Mul(w.b, scale);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(draw_kernel);
HWY_EXPORT(draw_colour_kernel);
HWY_EXPORT(surface_pdf_kernel);
HWY_EXPORT(eval_kernel);

void set_at(Arrays3 a, std::size_t k, const glm::vec3& value) noexcept {
  a.x[k] = value.x, a.y[k] = value.y, a.z[k] = value.z;
}
glm::vec3 get_at(ConstArrays3 a, std::size_t k) noexcept { return {a.x[k], a.y[k], a.z[k]}; }

}  // namespace

BatchSampler::BatchSampler(const Sampler& sampler) : layout_(sampler.stack().unpacked()), colour_({}), table_(sampler.table()) {}

BatchSampler::BatchSampler(const CompactBsdf& bsdf)
    : layout_(bsdf.stack().unpacked()), colour_(bsdf.colour()) {}

void BatchSampler::sample_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                            Arrays3 weight) const noexcept {
  if (!table_) {
    HWY_DYNAMIC_DISPATCH(draw_colour_kernel)
    (layout_, colour_, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf, weight.x, weight.y, weight.z});
    return;
  }
  HWY_DYNAMIC_DISPATCH(draw_kernel)(layout_, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf});
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec3 f_r = pdf[k] > 0 ? table_->eval(get_at(wi, k), get_at(wo, k)) * (wo.z[k] / pdf[k]) : glm::vec3(0);
    set_at(weight, k, f_r);
  }
}

void BatchSampler::pdf_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, float* pdf) const noexcept {
  HWY_DYNAMIC_DISPATCH(surface_pdf_kernel)(layout_, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {pdf});
}

void BatchSampler::eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept {
  if (!table_) {
    HWY_DYNAMIC_DISPATCH(eval_kernel)
    (layout_, colour_, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {f_r.x, f_r.y, f_r.z});
    return;
  }
  for (std::size_t k = 0; k < count; ++k) set_at(f_r, k, table_->eval(get_at(wi, k), get_at(wo, k)));
}

}  // namespace gonio
#endif
