// Colour on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_COLOUR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_COLOUR_INL_H
#undef GONIO_BATCH_COLOUR_INL_H
#else
#define GONIO_BATCH_COLOUR_INL_H
#endif

#include <gonio/brdf/batch/stack-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

struct Rgb {
  V r, g, b;
};

/// Colour::eval(). Each lane loads its eight cells as whole RGB triples and mixes them: a third of the loads that
/// gathers of single channels would make.
HWY_INLINE Rgb colour_at(const BatchColour& colour, V theta_i, V u, V v) {
  const Place place = place_among(colour.theta_i.data(), static_cast<int>(colour.theta_i.size()), theta_i);
  const D d;
  const hn::CappedTag<float, 4> d4;  // one triple, where vectors are that long
  const V side = set(static_cast<float>(colour.side)), half = set(0.5f);
  const V x = hn::Min(hn::Max(hn::MulSub(u, side, half), zero()), set(static_cast<float>(colour.side - 1)));
  const V y = hn::Min(hn::Max(hn::MulSub(hn::Abs(hn::Sub(v, half)), side, half), zero()),
                      set(static_cast<float>(colour.side / 2 - 1)));
  const VI i = hn::Min(hn::ConvertTo(DI(), x), set_int(colour.side - 2));
  const VI j = hn::Min(hn::ConvertTo(DI(), y), set_int(colour.last_row()));
  const VI cell = hn::Add(hn::Mul(place.k, set_int(colour.layer())), hn::Add(hn::Mul(j, set_int(colour.side)), i));

  HWY_ALIGN int cells[hn::MaxLanes(d)];
  HWY_ALIGN float a[hn::MaxLanes(d)], b[hn::MaxLanes(d)], c[hn::MaxLanes(d)], rgb[4 * hn::MaxLanes(d)];
  hn::Store(hn::ShiftLeft<2>(cell), DI(), cells);
  hn::Store(hn::Sub(x, hn::ConvertTo(d, i)), d, a);
  hn::Store(hn::Sub(y, hn::ConvertTo(d, j)), d, b);
  hn::Store(place.alpha, d, c);
  const int below = 4 * colour.next_row(), behind = 4 * colour.next_layer();
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    const auto across = hn::Set(d4, a[lane]), down = hn::Set(d4, b[lane]), between = hn::Set(d4, c[lane]);
    const auto mix4 = [&](auto t, auto p, auto q) HWY_ATTR { return hn::MulAdd(t, hn::Sub(q, p), p); };
    const auto layer = [&](const float* top) HWY_ATTR {
      const float* bottom = top + below;
      return mix4(down, mix4(across, hn::LoadU(d4, top), hn::LoadU(d4, top + 4)),
                  mix4(across, hn::LoadU(d4, bottom), hn::LoadU(d4, bottom + 4)));
    };
    for (std::size_t channel = 0; channel < 4; channel += hn::Lanes(d4)) {
      const float* first = colour.values.data() + cells[lane] + channel;
      hn::Store(mix4(between, layer(first), layer(first + behind)), d4, rgb + 4 * lane + channel);
    }
  }
  V unused;
  Rgb w;
  hn::LoadInterleaved4(d, rgb, w.r, w.g, w.b, unused);
  return w;
}

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
