#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/mapping/numeric/monotone_root.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/tables/eval_many.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/tables/grid_tables-inl.h>
#include <gonio/brdf/batch/tables/rgl_table-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

void merl_n(const MerlTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) {
  eval_table(table, count, in, out);
}
void mbsdf_n(const MbsdfTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) {
  eval_table(table, count, in, out);
}
void rgl_n(const RglTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) {
  eval_table(table, count, in, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(merl_n);
HWY_EXPORT(mbsdf_n);
HWY_EXPORT(rgl_n);

}  // namespace

void eval_many(const MerlTable& table, std::size_t count, const float* const (&in)[6],
               float* const (&out)[3]) noexcept {
  HWY_DYNAMIC_DISPATCH(merl_n)(table, count, in, out);
}
void eval_many(const MbsdfTable& table, std::size_t count, const float* const (&in)[6],
               float* const (&out)[3]) noexcept {
  HWY_DYNAMIC_DISPATCH(mbsdf_n)(table, count, in, out);
}
void eval_many(const RglTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) noexcept {
  HWY_DYNAMIC_DISPATCH(rgl_n)(table, count, in, out);
}

}  // namespace gonio
#endif
