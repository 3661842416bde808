#include <gonio/brdf/batch/batch_bsdf.h>
#include <gonio/brdf/batch/kernels/targets.h>
#include <gonio/mapping/numeric/monotone_root.h>

#define GONIO_LANE_CAP 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gonio/brdf/batch/one_lane.cpp"
#include <hwy/foreach_target.h>

#include <gonio/brdf/batch/kernels/bsdf-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
namespace {

// One element, by the kernels of batches: what they compute costs no branch and no library call.

bool draw(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
          BsdfSample& out) {
  const float* const in[] = {&wi.x, &wi.y, &wi.z, &u.x, &u.y};
  if (colour != nullptr)
    draw_kernel(layout, colour, 1, in,
                {&out.wo.x, &out.wo.y, &out.wo.z, &out.pdf, &out.weight.x, &out.weight.y, &out.weight.z});
  else
    draw_kernel(layout, colour, 1, in, {&out.wo.x, &out.wo.y, &out.wo.z, &out.pdf});
  return out.pdf > 0;
}
float pdf(const BatchLayout& layout, const glm::vec3& wi, const glm::vec3& wo) {
  float result;
  pdf_kernel(layout, 1, {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z}, {&result});
  return result;
}
glm::vec3 eval(const BatchLayout& layout, const BatchColour& colour, const glm::vec3& wi, const glm::vec3& wo) {
  glm::vec3 f_r;
  eval_kernel(layout, colour, 1, {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z}, {&f_r.x, &f_r.y, &f_r.z});
  return f_r;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gonio {
namespace {

HWY_EXPORT(draw);
HWY_EXPORT(pdf);
HWY_EXPORT(eval);

}  // namespace

bool draw_in_one_lane(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
                      BsdfSample& out) noexcept {
  return HWY_DYNAMIC_DISPATCH(draw)(layout, colour, wi, u, out);
}

float pdf_one(const BatchLayout& layout, const glm::vec3& wi, const glm::vec3& wo) noexcept {
  return HWY_DYNAMIC_DISPATCH(pdf)(layout, wi, wo);
}

glm::vec3 eval_one(const BatchLayout& layout, const BatchColour& colour, const glm::vec3& wi,
                   const glm::vec3& wo) noexcept {
  return HWY_DYNAMIC_DISPATCH(eval)(layout, colour, wi, wo);
}

}  // namespace gonio
#endif
