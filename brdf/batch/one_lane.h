#pragma once

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/bsdf/bsdf_sample.h>

namespace gonio {

/// BatchSampler::sample() by the code that serves many, on vectors of one element: for machines without vectors of two.
bool draw_in_one_lane(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u, BsdfSample& out) noexcept;

}  // namespace gonio
