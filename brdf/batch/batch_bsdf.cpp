#include <gonio/brdf/batch/batch_bsdf.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/mapping/numeric/monotone_root.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/batch_bsdf.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/kernels/bsdf-inl.h>

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

}  // namespace

void draw_many(const BatchLayout& layout, std::size_t count, const float* const (&in)[5],
               float* const (&out)[4]) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_n)(layout, count, in, out);
}
void draw_many(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[5],
               float* const (&out)[7]) noexcept {
  HWY_DYNAMIC_DISPATCH(draw_colour_n)(layout, colour, count, in, out);
}
void pdf_many(const BatchLayout& layout, std::size_t count, const float* const (&in)[6],
              float* const (&out)[1]) noexcept {
  HWY_DYNAMIC_DISPATCH(surface_pdf_n)(layout, count, in, out);
}
void eval_many(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[6],
               float* const (&out)[3]) noexcept {
  HWY_DYNAMIC_DISPATCH(eval_colour_n)(layout, colour, count, in, out);
}

}  // namespace gonio
#endif
