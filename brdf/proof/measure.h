#pragma once

#include <functional>
#include <optional>

#include <glm/vec3.hpp>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio::proof {

/// A sampler under test, whatever its type: what Bsdf offers, as functions. Frames and measures
/// are those of Bsdf. `f_r` is the BRDF that the weights ought to represent.
struct Subject {
  std::function<std::optional<BsdfSample>(const glm::vec3& wi, const glm::vec2& u)> sample;
  std::function<double(const glm::vec3& wi, const glm::vec3& wo)> pdf;
  std::function<glm::vec3(const glm::vec3& wi, const glm::vec3& wo)> f_r;
  /// Optional: the direction that sample() draws, without the weight, which costs as much.
  std::function<std::optional<glm::vec3>(const glm::vec3& wi, const glm::vec2& u)> direction = nullptr;
  /// Optional: the numbers that sample() maps to wo; nothing where no draw falls.
  std::function<std::optional<glm::vec2>(const glm::vec3& wi, const glm::vec3& wo)> invert = nullptr;
};

/// A subject of anything with Bsdf's sample(), pdf() and eval(). It must outlive the subject.
template <class S>
Subject subject_of(const S& sampler) {
  return {[&](const glm::vec3& wi, const glm::vec2& u) { return sampler.sample(wi, u); },
          [&](const glm::vec3& wi, const glm::vec3& wo) { return static_cast<double>(sampler.pdf(wi, wo)); },
          [&](const glm::vec3& wi, const glm::vec3& wo) { return sampler.eval(wi, wo); }};
}

/// The same with directions from the stack and the inverse of it.
Subject subject_of(const StackBsdf& bsdf);

/// A stack alone, without a BRDF: weights are 1, and `f_r` is empty. measure() cannot take it,
/// check_invariants() can. The stack must outlive it.
Subject subject_of(const Stack<float>& stack);

struct MeasureOptions {
  int grid = 256;                       ///< relvar is measured on grid x grid jittered points of the square
  std::uint64_t chi2_draws = 1u << 18;  ///< independent draws of the goodness-of-fit test
  std::uint32_t seed = 1;
  std::optional<glm::dvec3> albedo_table;  ///< where albedo() is known already: subjects of one table share it
};

/// How well a sampler does at one incident angle.
struct Quality {
  double theta_i;               ///< [rad]
  double relvar;                ///< Var[w] / E[w]^2 of the luminance weight w; 0 is perfect; empty draws count as 0
  double max_weight;            ///< the largest luminance weight of the draws over the mean one
  double max_direction_weight;  ///< the same of any direction: what light sampling meets; see scan_directions()
  double invalid_fraction;      ///< share of empty draws
  double pdf_integral;          ///< by quadrature of pdf(), no draw involved
  glm::dvec3 albedo;            ///< mean weight: the albedo as the sampler estimates it
  glm::dvec3 albedo_table;      ///< the integral of f_r cos theta_o by quadrature, no sampler involved
  ChiSquare chi2;               ///< of sample() against pdf()
};

/// The integral of f_r cos theta_o at theta_i [rad] in [0, pi/2), by quadrature adapted to it.
glm::dvec3 albedo(const Subject& subject, double theta_i);

/// Measures a sampler at theta_i [rad] in [0, pi/2). Deterministic for a seed. The bins and the
/// quadrature are adapted to both the pdf and f_r cos theta_o.
Quality measure(const Subject& subject, double theta_i, const MeasureOptions& options = {});

}  // namespace gonio::proof
