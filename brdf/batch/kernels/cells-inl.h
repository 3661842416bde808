// The cells of a colour, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_CELLS_INL_H
#undef GONIO_BATCH_CELLS_INL_H
#else
#define GONIO_BATCH_CELLS_INL_H
#endif

#include <gonio/brdf/batch/kernels/search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// Of the eight cells from `first` on: a of the way to the next column, b to the next row, c to the next layer. Four
/// floats, of which the last one is any.
HWY_INLINE void mix_cells(const BatchColour& colour, const std::uint16_t* first, float a, float b, float c, float* to) {
  const std::ptrdiff_t below = 3 * colour.next_row, behind = 3 * colour.next_layer;
  const Pass d;
  const float layer0 = colour.unit * (1 - c), layer1 = colour.unit * c;
  Eight left;  // the two cells of a row side by side, RGB each
  for (int part = 0; part < Eight::parts; ++part) {
    const int k = part * Eight::lanes;
    const auto row = [&](float weight, const std::uint16_t* codes)
                         GONIO_INLINED { return hn::Mul(hn::Set(d, weight), load_codes(d, codes + k)); };
    left.x[part] = hn::Add(hn::Add(row(layer0 * (1 - b), first), row(layer0 * b, first + below)),
                           hn::Add(row(layer1 * (1 - b), first + behind), row(layer1 * b, first + behind + below)));
  }
  Eight mixed = left.from(3);
  for (int part = 0; part < Eight::parts; ++part)
    mixed.x[part] = hn::MulAdd(hn::Set(d, a), hn::Sub(mixed.x[part], left.x[part]), left.x[part]);
  mixed.store_first<4>(to);
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
