#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gonio {

/// Counts the incident angles at which a material is shaded: what a path tracer records, so that the
/// material's stack is built for the angles that occur.
///
/// Thread safety: all members may be called concurrently, on one profile too. They are lock-free, and
/// no count is lost. Threads that record into one profile wait for each other's cache lines: give each
/// thread its own and merge() them when the picture is done. What counts(), count() and histogram()
/// return while others record holds some of what is being recorded.
class alignas(64) IncidenceProfile {  // a cache line: profiles side by side do not disturb each other
 public:
  /// Equal bins over theta_i in [0, pi/2]: one degree each.
  static constexpr std::size_t bins = 90;

  IncidenceProfile() = default;

  /// Continues from what counts() returned, perhaps in another process.
  /// @throws Error if there are not `bins` counts.
  explicit IncidenceProfile(const std::vector<std::uint64_t>& counts);

  /// One shaded point. `cos_theta_i` is wi.z; up to rounding in (0, 1]. One that is not above the
  /// horizon, or NaN, reflects nothing and is not counted; one above 1 counts as 1.
  void record(float cos_theta_i) noexcept;

  /// Adds what `other` has counted.
  void merge(const IncidenceProfile& other) noexcept;

  /// Points counted. After 2^64 in one bin its count begins again at 0.
  std::uint64_t count() const noexcept;

  /// Points in each bin, those nearest to the normal first.
  std::vector<std::uint64_t> counts() const;

  /// Share of the points in each bin; the sum is 1. Empty, that is unknown, if nothing was counted.
  std::vector<double> histogram() const;

 private:
  std::array<std::atomic<std::uint64_t>, bins> counts_{};
};

}  // namespace gonio
