// Searches among the lines of a diagram, one element at a time, once per instruction set: included by the kernels' own
// files alone.
#if defined(GONIO_BATCH_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_SEARCH_INL_H
#undef GONIO_BATCH_SEARCH_INL_H
#else
#define GONIO_BATCH_SEARCH_INL_H
#endif

#include <hwy/cache_control.h>

#include <gonio/brdf/batch/kernels/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

// A search is a pass of vectors that count what is below, one element at a time. Bisection in all lanes at once waits
// for a gather at each of its steps.
using Pass = hn::CappedTag<float, 8>;     // among groups and in them
using LongPass = hn::ScalableTag<float>;  // among all lines

struct Row {
  const float* x;
  HWY_INLINE void prefetch() const { hwy::Prefetch(x); }
  HWY_INLINE float at(std::ptrdiff_t k) const { return x[k]; }
  template <class Tag>
  HWY_INLINE hn::Vec<Tag> mixed(Tag d, std::ptrdiff_t k) const {
    return hn::LoadU(d, x + k);
  }
};
/// The weighted sum of rows.
template <int count>
struct MixedRow {
  const float* x[count];
  float weight[count];

  HWY_INLINE void prefetch() const {
    for (const float* values : x) hwy::Prefetch(values);
  }
  HWY_INLINE float at(std::ptrdiff_t k) const {
    float sum = weight[0] * x[0][k];
    for (int i = 1; i < count; ++i) sum += weight[i] * x[i][k];
    return sum;
  }
  template <class Tag>
  HWY_INLINE hn::Vec<Tag> mixed(Tag d, std::ptrdiff_t k) const {
    auto sum = hn::Mul(hn::Set(d, weight[0]), hn::LoadU(d, x[0] + k));
    for (int i = 1; i < count; ++i) sum = hn::MulAdd(hn::Set(d, weight[i]), hn::LoadU(d, x[i] + k), sum);
    return sum;
  }
};

/// `count` values from k on, stored.
template <std::size_t count, class Values>
HWY_INLINE void copy_values(const Values& values, std::ptrdiff_t k, float* to) {
  const hn::CappedTag<float, count> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(values.mixed(d, k + static_cast<std::ptrdiff_t>(i)), d, to + i);
}

/// How many of the values k .. k + count - 1, which ascend, are below the target. `whole`: up to the end of a vector
/// none of those behind is.
template <bool whole, class Tag = Pass, class Values>
HWY_INLINE std::ptrdiff_t count_below(const Values& values, std::ptrdiff_t k, std::ptrdiff_t count, float target) {
  const Tag d;
  const auto length = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto t = hn::Set(d, target);
  std::size_t below = 0;
  for (; count > 0; k += length, count -= length) {
    const auto is_below = hn::Lt(values.mixed(d, k), t);
    below += hn::CountTrue(d, whole ? is_below : hn::And(is_below, hn::FirstN(d, static_cast<std::size_t>(count))));
  }
  return static_cast<std::ptrdiff_t>(below);
}
/// The place in its group of the cell where the mass before it reaches the target.
template <class Values>
HWY_INLINE std::ptrdiff_t find_in_group(const Values& group, float target) {
  return count_below<false>(group, 1, BatchLayout::group - 1, target);
}

/// One diagram.
struct OneSource {
  const float* block;

  HWY_INLINE Row row(std::ptrdiff_t start) const { return {block + start}; }
  /// Between a row and the one that is `next` behind it.
  HWY_INLINE MixedRow<2> row(std::ptrdiff_t start, std::ptrdiff_t next, float b, float a) const {
    return {{block + start, block + start + next}, {b, a}};
  }
};
/// A blend of two.
struct TwoSources {
  const float* block;
  std::ptrdiff_t stride;
  float w0, w1;

  HWY_INLINE MixedRow<2> row(std::ptrdiff_t start) const { return {{block + start, block + stride + start}, {w0, w1}}; }
  HWY_INLINE MixedRow<4> row(std::ptrdiff_t start, std::ptrdiff_t next, float b, float a) const {
    const float *first = block + start, *second = first + stride;
    return {{first, first + next, second, second + next}, {w0 * b, w0 * a, w1 * b, w1 * a}};
  }
};

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
