#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace gonio {

/// The random numbers of one path: Owen-scrambled Sobol' points, a fresh pair for every decision of
/// the path. For a given pixel and decision the pairs of the samples 0, 1, 2 ... are one scrambled
/// (0,2)-sequence; those of different decisions, pixels and seeds are independent of each other.
///
/// Scrambling and shuffling by hashing after Burley, "Practical Hash-based Owen Scrambling", Journal
/// of Computer Graphics Techniques 9(4), 2020, with the permutation of Laine and Karras, "Stratified
/// Sampling for Stochastic Transparency", 2011. The points themselves are Boost.Random's.
class PathSequence {
 public:
  PathSequence(std::uint32_t seed, std::uint32_t pixel, std::uint32_t sample) noexcept;

  /// Two numbers in [0, 1).
  glm::vec2 next() noexcept;

 private:
  std::uint32_t hash_, sample_;
};

}  // namespace gonio
