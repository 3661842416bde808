#pragma once

#include <optional>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/proof/measure.h>

namespace gonio {

/// A Bsdf's batches of one element, as the harness asks for them. It must outlive the subject.
inline proof::Subject batch_subject(const Bsdf& bsdf) {
  return {[&](const glm::vec3& wi, const glm::vec2& u) -> std::optional<BsdfSample> {
            BsdfSample s;
            bsdf.sample_n(1, {&wi.x, &wi.y, &wi.z}, &u.x, &u.y, {&s.wo.x, &s.wo.y, &s.wo.z}, &s.pdf,
                          {&s.weight.x, &s.weight.y, &s.weight.z});
            if (!(s.pdf > 0)) return std::nullopt;
            return s;
          },
          [&](const glm::vec3& wi, const glm::vec3& wo) {
            float pdf;
            bsdf.pdf_n(1, {&wi.x, &wi.y, &wi.z}, {&wo.x, &wo.y, &wo.z}, &pdf);
            return static_cast<double>(pdf);
          },
          [&](const glm::vec3& wi, const glm::vec3& wo) {
            glm::vec3 f_r;
            bsdf.eval_n(1, {&wi.x, &wi.y, &wi.z}, {&wo.x, &wo.y, &wo.z}, {&f_r.x, &f_r.y, &f_r.z});
            return f_r;
          }};
}

}  // namespace gonio
