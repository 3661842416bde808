// Eight numbers side by side, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_EIGHT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_EIGHT_INL_H
#undef GONIO_BATCH_EIGHT_INL_H
#else
#define GONIO_BATCH_EIGHT_INL_H
#endif

#include <gonio/brdf/batch/kernels/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

using Pass = hn::CappedTag<float, 8>;

/// Eight numbers, in as few vectors as the machine needs.
struct Eight {
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Pass())), parts = 8 / lanes;
  hn::Vec<Pass> x[parts];

  HWY_INLINE void store(float* to) const {
    for (int i = 0; i < parts; ++i) hn::StoreU(x[i], Pass(), to + i * lanes);
  }
  /// Each is the one k further on; those without one are any. (By a permutation where that is possible: what is stored
  /// as a whole is slow to load in part.)
  HWY_INLINE Eight from(int k) const {
    Eight y;
    if constexpr (parts == 1) {
      const Pass d;
      const hn::RebindToSigned<Pass> di;
      y.x[0] = hn::TableLookupLanes(
          x[0], hn::IndicesFromVec(d, hn::And(hn::Add(hn::Iota(di, 0), hn::Set(di, k)), hn::Set(di, 7))));
    } else {
      float values[16] = {};
      store(values);
      for (int i = 0; i < parts; ++i) y.x[i] = hn::LoadU(Pass(), values + k + i * lanes);
    }
    return y;
  }
  template <int count>
  HWY_INLINE void store_first(float* to) const {
    const hn::CappedTag<float, count> d;
    constexpr int length = static_cast<int>(hn::MaxLanes(hn::CappedTag<float, count>()));
    if constexpr (lanes == 1)
      for (int i = 0; i < count; ++i) to[i] = hn::GetLane(x[i]);
    else if constexpr (length == lanes)
      hn::StoreU(x[0], d, to);
    else if constexpr (2 * length == lanes)
      hn::StoreU(hn::LowerHalf(d, x[0]), d, to);
    else
      hn::StoreU(hn::LowerHalf(d, hn::LowerHalf(hn::CappedTag<float, 2 * count>(), x[0])), d, to);
  }

  /// The first `count`, and zeros.
  HWY_INLINE Eight first(int count) const {
    Eight y;
    for (int i = 0; i < parts; ++i)
      y.x[i] = hn::IfThenElseZero(hn::FirstN(Pass(), static_cast<std::size_t>(std::max(count - i * lanes, 0))), x[i]);
    return y;
  }
  /// Each is the next one; the last one is any.
  HWY_INLINE Eight next() const {
    Eight y;
#if HWY_TARGET == HWY_SCALAR
    for (int i = 0; i < 8; ++i) y.x[i] = x[std::min(i + 1, 7)];
#else
    const Pass d;
    if constexpr (parts == 1) {
      y.x[0] = hn::CombineShiftRightLanes<1>(d, hn::ConcatUpperUpper(d, x[0], x[0]), x[0]);
    } else {
      y.x[0] = hn::CombineShiftRightLanes<1>(d, x[1], x[0]);
      y.x[1] = hn::CombineShiftRightLanes<1>(d, x[1], x[1]);
    }
#endif
    return y;
  }
  /// Each is the sum of those before it.
  HWY_INLINE Eight sums_before() const {
    Eight y;
    const Pass d;
    const auto zeros = hn::Zero(d);
#if HWY_TARGET == HWY_SCALAR
    y.x[0] = zeros;
    for (int i = 1; i < 8; ++i) y.x[i] = hn::Add(y.x[i - 1], x[i - 1]);
#else
    // Moved on by one; then sums of two and of four, in halves of the eight.
    const auto sums = [d](auto v) GONIO_INLINED {
      v = hn::Add(v, hn::ShiftLeftLanes<1>(d, v));
      return hn::Add(v, hn::ShiftLeftLanes<2>(d, v));
    };
    if constexpr (parts == 1) {
      const auto moved = hn::CombineShiftRightLanes<3>(d, x[0], hn::ConcatLowerLower(d, x[0], zeros));
      const auto half = sums(moved);
      y.x[0] = hn::Add(half, hn::ConcatLowerLower(d, hn::Broadcast<3>(half), zeros));
    } else {
      const auto lower = sums(hn::CombineShiftRightLanes<3>(d, x[0], zeros));
      y.x[0] = lower;
      y.x[1] = hn::Add(sums(hn::CombineShiftRightLanes<3>(d, x[1], x[0])), hn::Broadcast<3>(lower));
    }
#endif
    return y;
  }
  /// The index of the last one that is below t and where `weight` is positive; 0 if there is none.
  HWY_INLINE int last_below(float t, const Eight& weight) const {
    const Pass d;
    unsigned bits = 1;
    for (int i = 0; i < parts; ++i) {
      std::uint8_t part[8] = {};
      hn::StoreMaskBits(d, hn::And(hn::Lt(x[i], hn::Set(d, t)), hn::Gt(weight.x[i], hn::Zero(d))), part);
      bits |= static_cast<unsigned>(part[0]) << (i * lanes);
    }
    return 31 - static_cast<int>(hwy::Num0BitsAboveMS1Bit_Nonzero32(bits));
  }
  /// The sum of those from k to the one before `end`.
  HWY_INLINE float sum(int k, int end) const {
    float values[8], total = 0;
    store(values);
    for (int i = 0; i < 8; ++i) total += i >= k && i < end ? values[i] : 0.0f;
    return total;
  }
};

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
