// Colour on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_COLOUR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_COLOUR_INL_H
#undef GONIO_BATCH_COLOUR_INL_H
#else
#define GONIO_BATCH_COLOUR_INL_H
#endif

#include <gonio/brdf/batch/kernels/cells-inl.h>
#include <gonio/brdf/batch/kernels/draw-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// Colour::eval() of `count` elements, at most a block of whole vectors, from their brackets among its angles. Each
/// loads its eight cells as whole RGB triples and mixes them: a third of the loads that gathers of single channels
/// would make.
HWY_INLINE void find_colours(const BatchColour& colour, std::size_t count, const Brackets& brackets, const float* u,
                             const float* v, float* red, float* green, float* blue) {
  const D d;
  HWY_ALIGN int cells[block_size];
  HWY_ALIGN float a[block_size], b[block_size], rgb[4 * block_size];
  const V side = set(static_cast<float>(colour.side)), half = set(0.5f);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const V across = hn::MulSub(hn::LoadU(d, u + k), side, half);
    const V along = hn::MulSub(hn::Abs(hn::Sub(hn::LoadU(d, v + k), half)), side, half);
    const V x = hn::Min(hn::Max(across, zero()), set(static_cast<float>(colour.side - 1)));
    const V y = hn::Min(hn::Max(along, zero()), set(static_cast<float>(colour.side / 2 - 1)));
    const VI i = hn::Min(truncated(x), set_int(colour.side - 2));
    const VI j = hn::Min(truncated(y), set_int(colour.last_row));
    const VI cell = hn::Add(hn::Mul(hn::Load(DI(), brackets.k + k), set_int(colour.layer)),
                            hn::Add(hn::Mul(j, set_int(colour.side)), i));
    hn::Store(hn::Mul(cell, set_int(3)), DI(), cells + k);
    hn::Store(hn::Sub(x, hn::ConvertTo(d, i)), d, a + k);
    hn::Store(hn::Sub(y, hn::ConvertTo(d, j)), d, b + k);
  }
  for (std::size_t k = 0; k < count; ++k)
    mix_cells(colour, colour.codes.data() + cells[k], a[k], b[k], brackets.alpha[k], rgb + 4 * k);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    V r, g, w, unused;
    load4(rgb + 4 * k, r, g, w, unused);
    hn::StoreU(r, d, red + k), hn::StoreU(g, d, green + k), hn::StoreU(w, d, blue + k);
  }
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
