#include "tools/render/trace/sobol.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace gonio {
namespace {

/// The pairs of one decision, for samples first ... first + count - 1.
std::vector<glm::vec2> pairs(int decision, std::uint32_t first, std::uint32_t count, std::uint32_t pixel = 5) {
  std::vector<glm::vec2> result;
  for (std::uint32_t s = first; s < first + count; ++s) {
    PathSequence random(1, pixel, s);
    for (int k = 0; k < decision; ++k) random.next();
    result.push_back(random.next());
  }
  return result;
}

// A (0,2)-sequence: aligned blocks of 64 have one point in every elementary interval.
TEST(PathSequence, EveryBlockIsStratifiedInAllElementaryIntervals) {
  for (const std::uint32_t first : {0u, 64u, 1024u, 65536u})
    for (const int decision : {0, 3, 20})
      for (int bits = 0; bits <= 6; ++bits) {
        std::set<std::pair<int, int>> cells;
        for (const glm::vec2 u : pairs(decision, first, 64))
          cells.insert({static_cast<int>(u.x * static_cast<float>(1 << bits)),
                        static_cast<int>(u.y * static_cast<float>(1 << (6 - bits)))});
        EXPECT_EQ(cells.size(), 64u) << first << " " << decision << " " << bits;
      }
}

TEST(PathSequence, DecisionsAndPixelsAreNotCorrelated) {
  const auto correlation = [](const std::vector<glm::vec2>& a, const std::vector<glm::vec2>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += static_cast<double>((a[k].x - 0.5f) * (b[k].x - 0.5f)) * 12;
    return std::abs(sum) / static_cast<double>(a.size());
  };
  const auto a = pairs(0, 0, 4096);
  EXPECT_LT(correlation(a, pairs(1, 0, 4096)), 0.06);
  EXPECT_LT(correlation(a, pairs(0, 0, 4096, 6)), 0.06);
  EXPECT_GT(correlation(a, pairs(0, 0, 4096)), 0.9);  // the test sees a correlation
}

}  // namespace
}  // namespace gonio
