#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/mapping/numeric/monotone_root.h>

#define GONIO_LANE_CAP 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/tables/eval_one.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/tables/grid_tables-inl.h>
#include <gonio/brdf/batch/tables/rgl_table-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
namespace {

// One pair, by the code that serves many, on vectors of one element.
template <class Table>
HWY_INLINE glm::vec3 one(const Table& table, const glm::vec3& wi, const glm::vec3& wo) {
  glm::vec3 f_r;
  eval_table(table, 1, {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z}, {&f_r.x, &f_r.y, &f_r.z});
  return f_r;
}
glm::vec3 merl(const MerlTable& table, const glm::vec3& wi, const glm::vec3& wo) { return one(table, wi, wo); }
glm::vec3 mbsdf(const MbsdfTable& table, const glm::vec3& wi, const glm::vec3& wo) { return one(table, wi, wo); }
glm::vec3 rgl(const RglTable& table, const glm::vec3& wi, const glm::vec3& wo) { return one(table, wi, wo); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(merl);
HWY_EXPORT(mbsdf);
HWY_EXPORT(rgl);

}  // namespace

glm::vec3 eval_one(const MerlTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept {
  return HWY_DYNAMIC_DISPATCH(merl)(table, wi, wo);
}
glm::vec3 eval_one(const MbsdfTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept {
  return HWY_DYNAMIC_DISPATCH(mbsdf)(table, wi, wo);
}
glm::vec3 eval_one(const RglTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept {
  return HWY_DYNAMIC_DISPATCH(rgl)(table, wi, wo);
}

}  // namespace gonio
#endif
