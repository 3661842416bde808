// The cells of a colour, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_CELLS_INL_H
#undef GONIO_BATCH_CELLS_INL_H
#else
#define GONIO_BATCH_CELLS_INL_H
#endif

#include <gonio/brdf/batch/kernels/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// Of the eight cells from `first` on: a of the way to the next column, b to the next row, c to the next layer. Four
/// floats.
HWY_INLINE void mix_cells(const BatchColour& colour, const float* first, float a, float b, float c, float* to) {
  const hn::CappedTag<float, 4> d4;  // one triple, where vectors are that long
  const std::ptrdiff_t below = 4 * colour.next_row, behind = 4 * colour.next_layer;
  const auto mixed = [](auto tag, float t, auto p, auto q)
                         GONIO_INLINED { return hn::MulAdd(hn::Set(tag, t), hn::Sub(q, p), p); };
  // Between rows and layers, from `channel` of the cell on.
  const auto column = [&](auto tag, std::size_t channel) GONIO_INLINED {
    const auto row = [&](const float* x)
                         GONIO_INLINED { return mixed(tag, b, hn::LoadU(tag, x), hn::LoadU(tag, x + below)); };
    return mixed(tag, c, row(first + channel), row(first + channel + behind));
  };
#if HWY_TARGET <= HWY_AVX2
  const hn::FixedTag<float, 8> d8;  // two cells side by side
  const auto both = column(d8, 0);
  hn::StoreU(mixed(d4, a, hn::LowerHalf(both), hn::UpperHalf(d4, both)), d4, to);
#else
  for (std::size_t channel = 0; channel < 4; channel += hn::Lanes(d4))
    hn::StoreU(mixed(d4, a, column(d4, channel), column(d4, channel + 4)), d4, to + channel);
#endif
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
