#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>
#include <gonio/brdf/formats/rgl/rgl.h>

namespace gonio {

/// eval() of measured tables, compiled for every instruction set; the best that the machine has is called. 0 for
/// directions at or below the horizon and for those that are not finite. What BrdfTable::eval_n() says of exactness
/// holds.

/// `count` of them: inputs are the components of wi and of wo, outputs R, G, B.
void eval_many(const MerlTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) noexcept;
void eval_many(const MbsdfTable& table, std::size_t count, const float* const (&in)[6],
               float* const (&out)[3]) noexcept;
void eval_many(const RglTable& table, std::size_t count, const float* const (&in)[6], float* const (&out)[3]) noexcept;

/// One of them.
glm::vec3 eval_one(const MerlTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept;
glm::vec3 eval_one(const MbsdfTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept;
glm::vec3 eval_one(const RglTable& table, const glm::vec3& wi, const glm::vec3& wo) noexcept;

}  // namespace gonio
