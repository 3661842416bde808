#include <gonio/brdf/batch/batch_sampler.h>
#include <gonio/brdf/batch/targets.h>
#include <gonio/mapping/numeric/monotone_root.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/batch_sampler.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/sampler-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

void draw_n(const BatchLayout& layout, std::size_t count, const float* const (&in)[5], float* const (&out)[4]) {
  draw_kernel(layout, nullptr, count, in, out);
}
void draw_colour_n(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[5],
                   float* const (&out)[7]) {
  draw_kernel(layout, &colour, count, in, out);
}
void surface_pdf_n(const BatchLayout& layout, std::size_t count, const float* const (&in)[6], float* const (&out)[1]) {
  pdf_kernel(layout, count, in, out);
}
void eval_colour_n(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[6],
                   float* const (&out)[3]) {
  eval_kernel(layout, colour, count, in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(draw_n);
HWY_EXPORT(draw_colour_n);
HWY_EXPORT(surface_pdf_n);
HWY_EXPORT(eval_colour_n);

void set_at(Arrays3 a, std::size_t k, const glm::vec3& value) noexcept {
  a.x[k] = value.x, a.y[k] = value.y, a.z[k] = value.z;
}
glm::vec3 get_at(ConstArrays3 a, std::size_t k) noexcept { return {a.x[k], a.y[k], a.z[k]}; }

}  // namespace

BatchSampler::BatchSampler(const Sampler& sampler) : layout_(sampler.stack().unpacked()), colour_({}, layout_), table_(sampler.table()) {}

BatchSampler::BatchSampler(const CompactBsdf& bsdf)
    : layout_(bsdf.stack().unpacked()), colour_(bsdf.colour(), layout_) {}

void BatchSampler::sample_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                            Arrays3 weight) const noexcept {
  if (!table_) {
    HWY_DYNAMIC_DISPATCH(draw_colour_n)
    (layout_, colour_, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf, weight.x, weight.y, weight.z});
    return;
  }
  HWY_DYNAMIC_DISPATCH(draw_n)(layout_, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf});
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec3 f_r = pdf[k] > 0 ? table_->eval(get_at(wi, k), get_at(wo, k)) * (wo.z[k] / pdf[k]) : glm::vec3(0);
    set_at(weight, k, f_r);
  }
}

void BatchSampler::pdf_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, float* pdf) const noexcept {
  HWY_DYNAMIC_DISPATCH(surface_pdf_n)(layout_, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {pdf});
}

void BatchSampler::eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept {
  if (!table_) {
    HWY_DYNAMIC_DISPATCH(eval_colour_n)
    (layout_, colour_, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {f_r.x, f_r.y, f_r.z});
    return;
  }
  for (std::size_t k = 0; k < count; ++k) set_at(f_r, k, table_->eval(get_at(wi, k), get_at(wo, k)));
}

}  // namespace gonio
#endif
