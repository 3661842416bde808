#pragma once

#include <functional>
#include <glm/vec3.hpp>

namespace gonio {

/// f_r(wi, wo) in 1/sr per RGB channel: a BrdfTable's eval(), a LobeModel's, or anything else with
/// the same frame. Called with both directions above the horizon, from several threads at once.
using BrdfFunction = std::function<glm::vec3(const glm::vec3& wi, const glm::vec3& wo)>;

}  // namespace gonio
