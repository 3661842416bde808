#include "tools/render/trace/sobol.h"

#include <array>
#include <cstddef>
#include <vector>

#include <boost/random/sobol.hpp>

namespace gonio {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t table_bits = 16;  // longer sequences are several of this length

/// The first 2^16 points of the two-dimensional Sobol' sequence.
const std::vector<Pair>& sobol_points() {
  static const std::vector<Pair> points = [] {
    std::vector<Pair> result(std::size_t{1} << table_bits);  // the first is (0, 0), which Boost skips
    boost::random::sobol_engine<std::uint32_t, 32> engine(2);
    for (std::size_t k = 1; k < result.size(); ++k)
      for (std::uint32_t& x : result[k]) x = engine();
    return result;
  }();
  return points;
}

/// Bijective; every bit of the result depends on all of x ("lowbias32" of Wellons' hash-prospector).
std::uint32_t mix(std::uint32_t x) noexcept {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

std::uint32_t combine(std::uint32_t hash, std::uint32_t value) noexcept { return mix(hash + 0x9e3779b9u + mix(value)); }

std::uint32_t reverse_bits(std::uint32_t x) noexcept {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

/// Owen's scrambling: whether a bit is flipped depends on the bits above it and the seed.
std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) noexcept {
  x = reverse_bits(x) + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

}  // namespace

PathSequence::PathSequence(std::uint32_t seed, std::uint32_t pixel, std::uint32_t sample) noexcept
    : hash_(combine(combine(mix(seed + 1), pixel), sample >> table_bits)), sample_(sample) {}

glm::vec2 PathSequence::next() noexcept {
  hash_ = mix(hash_ + 0x9e3779b9u);
  // The order is shuffled for each decision, so that the pairs of two decisions are not correlated.
  const std::uint32_t index = scramble(sample_, hash_) & ((1u << table_bits) - 1);
  const Pair& point = sobol_points()[index];
  const auto uniform = [](std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; };
  return {uniform(scramble(point[0], combine(hash_, 1))), uniform(scramble(point[1], combine(hash_, 2)))};
}

}  // namespace gonio
