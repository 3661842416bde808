#pragma once

#include <cstdint>
#include <random>

#include <glm/vec2.hpp>

namespace gonio::proof {

/// Uniform numbers in [0, 1) with 24 bits, the same on every platform (which the distributions of the
/// standard library do not promise, nor that a float stays below 1).
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
  glm::vec2 pair() {
    const float u = (*this)();
    return {u, (*this)()};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace gonio::proof
