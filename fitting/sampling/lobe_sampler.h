#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <gonio/brdf/table/table.h>
#include <gonio/brdf/value/bsdf_sample.h>
#include <gonio/fitting/model/model.h>
#include <gonio/fitting/sampling/sheared_ggx.h>

namespace gonio {

/// How the lobes of a LobeSampler follow the incident angle.
enum class Adaption {
  albedo,   ///< weights by the lobes' albedos, widths of the model
  weights,  ///< weights by least variance, widths of the model
  shapes    ///< weights, widths and lean by least variance
};

struct LobeSamplerOptions {
  Adaption adaption = Adaption::shapes;
  int angles = 31;  ///< incident angles at which weights and shapes are kept, 0 to 89 degrees, >= 2
  /// Least share of draws by the cosine, so that a table's value is never met with a vanishing pdf:
  /// no weight is above pi f_r / cosine_share.
  float cosine_share = 0.01f;
};

/// Fitted lobes propose directions for a table: a mixture of a cosine part (for the diffuse lobes)
/// and, per specular lobe, of a GGX sampled by visible normals, with weights and shapes that depend
/// on the incident angle. The value is always the table's, so that a poor fit costs variance and
/// nothing else.
///
/// Least variance: at each incident angle the chi-square divergence of the mixture from L(f_r)
/// cos_o, which is the relative variance of one draw, is minimised by Ceres; shapes are those of
/// ShearedGgx.
///
/// Frame and one-sidedness as in Bsdf. Thread safety: immutable; every const member may be
/// called concurrently. No member but the constructor allocates or locks.
class LobeSampler {
 public:
  static constexpr int max_lobes = 4;  ///< specular ones

  /// Takes up to a few seconds with Adaption::shapes.
  /// @throws Error if `table` is null, if the model has more than max_lobes specular lobes or an option is out of
  /// range.
  LobeSampler(std::shared_ptr<const BrdfTable> table, const LobeModel& model, const LobeSamplerOptions& options = {});

  /// Draws wo from two uniform numbers in [0, 1): u.x also chooses the part, and what is left of it
  /// is stretched to [0, 1) again. Empty for wi.z <= 0 and, with probability 0, for wo on the
  /// horizon.
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;

  /// The density with which sample() draws wo [1/sr]: the whole mixture, > 0 above the horizon.
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The table's f_r [1/sr].
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// All memory held, the shared table apart.
  std::size_t bytes() const noexcept { return sizeof(*this) + nodes_.size() * sizeof(Node); }

 private:
  // Weight and shape of every part; the weights sum to 1. Part 0 is the cosine.
  struct Node {
    std::array<float, 1 + max_lobes> weight{};
    std::array<ShearedGgx<float>, max_lobes> shape{};
  };
  Node at(float theta_i) const noexcept;
  // Both in the frame of the diagram.
  float density(const Node& node, const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  std::shared_ptr<const BrdfTable> table_;
  int lobes_ = 0;
  float nodes_per_radian_ = 0;
  std::vector<Node> nodes_;
};

}  // namespace gonio
