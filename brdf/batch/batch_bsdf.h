#pragma once

#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

/// The look-ups of Bsdf, compiled for every instruction set; the best that the machine has is called. Where `colour` is
/// null the value is the caller's affair.

/// One draw at a time, on the lanes of a vector of two. False: no draw.
bool draw_one(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
              BsdfSample& out) noexcept;
/// The same by the code that serves many, on vectors of one element: for machines without vectors of two, and next to
/// the horizon.
bool draw_in_one_lane(const BatchLayout& layout, const BatchColour* colour, const glm::vec3& wi, const glm::vec2& u,
                      BsdfSample& out) noexcept;
float pdf_one(const BatchLayout& layout, const glm::vec3& wi, const glm::vec3& wo) noexcept;
glm::vec3 eval_one(const BatchLayout& layout, const BatchColour& colour, const glm::vec3& wi,
                   const glm::vec3& wo) noexcept;

/// `count` of them. Inputs are the components of wi, then u and v or the components of wo; outputs x, y, z, pdf and
/// with a colour R, G, B. Where there is no draw, all outputs are 0.
void draw_many(const BatchLayout& layout, std::size_t count, const float* const (&in)[5],
               float* const (&out)[4]) noexcept;
void draw_many(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[5],
               float* const (&out)[7]) noexcept;
void pdf_many(const BatchLayout& layout, std::size_t count, const float* const (&in)[6],
              float* const (&out)[1]) noexcept;
void eval_many(const BatchLayout& layout, const BatchColour& colour, std::size_t count, const float* const (&in)[6],
               float* const (&out)[3]) noexcept;

}  // namespace gonio
