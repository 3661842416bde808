#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/build/budget/incidence_profile.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/concentric.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

float cosine(double degrees) { return static_cast<float>(std::cos(degrees * degree)); }

TEST(IncidenceProfile, EveryDegreeHasItsBin) {
  IncidenceProfile profile;
  for (std::size_t k = 0; k < IncidenceProfile::bins; ++k)
    for (std::size_t n = 0; n <= k; ++n) profile.record(cosine(static_cast<double>(k) + 0.5));
  const std::vector<std::uint64_t> counts = profile.counts();
  ASSERT_EQ(counts.size(), IncidenceProfile::bins);
  for (std::size_t k = 0; k < counts.size(); ++k) EXPECT_EQ(counts[k], k + 1) << k;
  EXPECT_EQ(profile.count(), 90u * 91 / 2);
}

TEST(IncidenceProfile, NormalAndHorizon) {
  IncidenceProfile profile;
  profile.record(1);
  profile.record(std::nextafter(1.0f, 2.0f));  // a dot product of rounded vectors
  EXPECT_EQ(profile.counts().front(), 2u);
  profile.record(std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(profile.counts().back(), 1u);
  profile.record(0);
  profile.record(-0.5f);
  profile.record(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(profile.count(), 3u);
}

TEST(IncidenceProfile, TheHistogramSumsToOne) {
  IncidenceProfile profile;
  EXPECT_TRUE(profile.histogram().empty());
  for (int n = 0; n < 3; ++n) profile.record(cosine(10.5));
  profile.record(cosine(80.5));
  const std::vector<double> histogram = profile.histogram();
  ASSERT_EQ(histogram.size(), IncidenceProfile::bins);
  EXPECT_DOUBLE_EQ(histogram[10], 0.75);
  EXPECT_DOUBLE_EQ(histogram[80], 0.25);
  EXPECT_DOUBLE_EQ(std::accumulate(histogram.begin(), histogram.end(), 0.0), 1);
}

TEST(IncidenceProfile, MergesAndContinues) {
  IncidenceProfile a, b;
  a.record(cosine(3.5));
  b.record(cosine(3.5));
  b.record(cosine(70.5));
  a.merge(b);
  EXPECT_EQ(a.counts()[3], 2u);
  EXPECT_EQ(a.counts()[70], 1u);
  EXPECT_EQ(b.count(), 2u);
  const IncidenceProfile again(a.counts());
  EXPECT_EQ(again.counts(), a.counts());
  try {
    const IncidenceProfile bad(std::vector<std::uint64_t>(89));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("found 89, expected 90"));
  }
}

// Matched by the tests that run under ThreadSanitizer.
TEST(ConcurrencyOfIncidenceProfile, LosesNoCount) {
  constexpr std::size_t threads = 8;
  constexpr int points = 50000;
  IncidenceProfile shared;
  std::vector<IncidenceProfile> own(threads);  // as a renderer has them
  std::vector<std::thread> pool;
  for (std::size_t t = 0; t < threads; ++t) {
    pool.emplace_back([&, t] {
      for (int n = 0; n < points; ++n) {
        const float c = cosine(static_cast<double>((n + 13 * static_cast<int>(t)) % 7) + 0.5);
        shared.record(c);
        own[t].record(c);
      }
    });
  }
  while (shared.count() < points) std::this_thread::yield();  // reading meanwhile is allowed
  for (std::thread& thread : pool) thread.join();
  IncidenceProfile merged;
  for (const IncidenceProfile& profile : own) merged.merge(profile);
  EXPECT_EQ(shared.count(), threads * points);
  EXPECT_EQ(merged.counts(), shared.counts());
}

TEST(ConcurrencyOfIncidenceProfile, MergesWhileOthersRecord) {
  constexpr int points = 50000;
  IncidenceProfile total;
  std::vector<std::thread> pool;
  for (int t = 0; t < 4; ++t) {
    pool.emplace_back([&, t] {
      for (int round = 0; round < 10; ++round) {
        IncidenceProfile part;
        for (int n = 0; n < points / 10; ++n) part.record(cosine(t + 0.5));
        total.merge(part);
      }
    });
  }
  for (std::thread& thread : pool) thread.join();
  for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(total.counts()[t], static_cast<std::uint64_t>(points));
}

}  // namespace
}  // namespace gonio
