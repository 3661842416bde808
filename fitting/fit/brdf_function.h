#pragma once

#include <functional>
#include <limits>

#include <glm/vec3.hpp>

#include <gonio/brdf/table/table.h>

namespace gonio {

/// f_r(wi, wo) in 1/sr per RGB channel: a BrdfTable's eval(), a LobeModel's, or anything else with
/// the same frame. Called with both directions above the horizon, from several threads at once. NaN
/// says that the pair was not measured: it carries no weight in fits and their errors.
using BrdfFunction = std::function<glm::vec3(const glm::vec3& wi, const glm::vec3& wo)>;

/// eval() of a table where at most a thousandth of it comes from made-up cells, else NaN. Refers to
/// the table.
inline BrdfFunction measured_part(const BrdfTable& table) {
  return [&table](const glm::vec3& wi, const glm::vec3& wo) {
    if (table.measured(wi, wo) >= 0.999f) return table.eval(wi, wo);
    return glm::vec3(std::numeric_limits<float>::quiet_NaN());
  };
}

}  // namespace gonio
