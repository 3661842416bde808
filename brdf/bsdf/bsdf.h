#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/value/arrays3.h>
#include <gonio/brdf/value/bsdf_data.h>
#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

class BrdfTable;

/// A measured material as a renderer holds it: importance sampling, its pdf, and f_r, one direction at a time or many
/// at once. Loaded from a stack file by load_bsdf() in milliseconds, or made from a table by make_bsdf() in seconds.
///
/// Densities and colours are held in 16 bits each (rounded16(), Colour), in the order in which they are read.
///
/// f_r is either colours of its own, so that sample(), pdf() and eval() agree to rounding however far the table is, or
/// the table's.
///
/// Frame: local, the surface normal is +z; wi and wo are unit vectors that point away from the surface; wi is the known
/// direction, wo the sampled one. One-sided: for wi.z <= 0 or wo.z <= 0 there is no sample, pdf() and eval() are 0. A
/// two-sided material flips both directions first. NaN and infinities give no sample, and 0.
///
/// The code runs on vectors, on the best instruction set that the machine has. Its results are those of StackBsdf,
/// plain scalar code, but for rounding:
///
/// | result | within |
/// |---|---|
/// | wo of sample() | 1e-4, wherever the map is no steeper than that lets floats |
/// | pdf | 2e-3, relative, besides 1e-4 of the largest density |
/// | weight | 1e-5, relative: of the colour at (u, v), or of f_r cos / pdf of what is returned, f_r being eval()'s |
/// | f_r of a colour | as exact as the pdf that it is computed from |
/// | f_r of a table | that of BrdfTable::eval(), as BrdfTable::eval_n() says: mostly 2e-7, relative |
///
/// Copies share everything and are cheap. Thread safety: immutable; every member may be called concurrently. No member
/// but the constructor allocates or locks.
class Bsdf {
 public:
  /// With the table's f_r, or without a table with that of data.colour. Takes milliseconds.
  /// @throws Error for diagrams that cannot be sampled (see Stack), for Interpolation::mixture, for stacks of 2^29
  /// values or more, and where there is neither a table nor a colour.
  explicit Bsdf(const BsdfData& data, std::shared_ptr<const BrdfTable> table = nullptr);

  /// Draws wo for `wi` from two uniform numbers in [0, 1). Empty for wi.z <= 0, and for a draw that falls on a
  /// direction without density (an event of measure zero).
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;

  /// The density with which sample() draws wo [1/sr].
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// f_r(wi, wo) per RGB channel [1/sr], linear Rec. 709, without the cosine.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// These three are sample(), pdf() and eval() of `count` elements, each with its own wi. Arrays hold `count` floats,
  /// in any alignment; an output must not overlap an input. Where sample() is empty, all outputs are 0.
  void sample_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                Arrays3 weight) const noexcept;
  void pdf_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, float* pdf) const noexcept;
  void eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept;

  /// Directional albedo per RGB channel, the integral of f_r cos(theta_o), at an incident angle [rad]: for denoisers,
  /// light selection and Russian roulette. Within about 1 % of that of f_r; linear between angles 2 degrees apart,
  /// constant beyond 88 degrees, and 0 from pi/2 on.
  glm::vec3 albedo(float theta_i) const noexcept;

  /// An equivalent GGX alpha in [0, 1], for path guiding and regularisation: tan(theta_h) that half of what is
  /// reflected at normal incidence stays below, by luminance. Of a smooth GGX alone it is its alpha; rough ones lose
  /// their steepest facets to the horizon and to shadowing (0.32 of alpha 0.4); of a Lambertian it is 0.414. A lobe
  /// over a diffuse base has something between.
  float roughness() const noexcept;

  Chart chart() const noexcept;
  Interpolation interpolation() const noexcept;
  std::size_t incident_angles() const noexcept;  ///< diagrams held
  bool self_contained() const noexcept;          ///< with colours of its own
  /// All memory held, the shared table apart.
  std::size_t bytes() const noexcept;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace gonio
