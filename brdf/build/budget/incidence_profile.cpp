#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <gonio/brdf/build/budget/incidence_profile.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

IncidenceProfile::IncidenceProfile(const std::vector<std::uint64_t>& counts) {
  if (counts.size() != bins) {
    throw Error("incidence profile: counts: found " + std::to_string(counts.size()) + ", expected " +
                std::to_string(bins));
  }
  for (std::size_t k = 0; k < bins; ++k) counts_[k].store(counts[k], std::memory_order_relaxed);
}

void IncidenceProfile::record(float cos_theta_i) noexcept {
  if (!(cos_theta_i > 0)) return;
  const float theta = std::acos(std::min(cos_theta_i, 1.0f));
  const auto bin = static_cast<std::size_t>(theta * (2 / pi<float> * static_cast<float>(bins)));
  // Relaxed: only the sums matter, no other data is published by them.
  counts_[std::min(bin, bins - 1)].fetch_add(1, std::memory_order_relaxed);
}

void IncidenceProfile::merge(const IncidenceProfile& other) noexcept {
  for (std::size_t k = 0; k < bins; ++k)
    counts_[k].fetch_add(other.counts_[k].load(std::memory_order_relaxed), std::memory_order_relaxed);
}

std::uint64_t IncidenceProfile::count() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& c : counts_) sum += c.load(std::memory_order_relaxed);
  return sum;
}

std::vector<std::uint64_t> IncidenceProfile::counts() const {
  std::vector<std::uint64_t> result(bins);
  for (std::size_t k = 0; k < bins; ++k) result[k] = counts_[k].load(std::memory_order_relaxed);
  return result;
}

std::vector<double> IncidenceProfile::histogram() const {
  const std::vector<std::uint64_t> now = counts();  // once: others may be recording
  std::vector<double> result(now.begin(), now.end());
  const double sum = std::accumulate(result.begin(), result.end(), 0.0);
  if (sum == 0) return {};
  for (double& share : result) share /= sum;
  return result;
}

}  // namespace gonio
