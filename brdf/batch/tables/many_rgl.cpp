#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/mapping/numeric/monotone_root.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/tables/many_rgl.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/tables/rgl_table-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

void rgl_n(const RglTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) {
  eval_rgl(table, count, in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(rgl_n);

}  // namespace

void eval_many(const RglTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) noexcept {
  HWY_DYNAMIC_DISPATCH(rgl_n)(table, count, in, out);
}

}  // namespace gonio
#endif
