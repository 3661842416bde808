#include <gonio/brdf/batch/batch_stack.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/mapping/numeric/monotone_root.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/batch_stack.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/kernels/draw-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

void sample_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[3], float* const (&out)[4]) {
  for_blocks(count, in, out, [&](auto elements, const float* const(&x)[3], float* const(&y)[4]) GONIO_INLINED {
    HWY_ALIGN float r[block_size];
    for (std::size_t k = 0; k < elements; k += hn::Lanes(D()))
      hn::Store(incident_angle(hn::LoadU(D(), x[0] + k)).r, D(), r + k);
    draw_stack(layout, elements, Brackets(layout.angles, elements, x[0], r), x[0], x[1], x[2], y[0], y[1], y[2], y[3]);
  });
}

void pdf_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[4], float* const (&out)[1]) {
  for_vectors<4, 1>(count, in, out, [&](const V(&x)[4], V(&y)[1]) GONIO_INLINED {
    y[0] = pdf_stack(layout, bracket_of(layout.angles, incident_angle(x[0])), x[0], {x[1], x[2], x[3]});
  });
}

void invert_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[4], float* const (&out)[3]) {
  for_vectors<4, 3>(count, in, out, [&](const V(&x)[4], V(&y)[3]) GONIO_INLINED {
    const Inverted s = invert_stack(layout, bracket_of(layout.angles, incident_angle(x[0])), x[0], {x[1], x[2], x[3]});
    y[0] = s.u, y[1] = s.v, y[2] = s.pdf;
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
