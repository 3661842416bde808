// The RGB cells of a table on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_TABLES_RGB_GRID_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_TABLES_RGB_GRID_INL_H
#undef GONIO_TABLES_RGB_GRID_INL_H
#else
#define GONIO_TABLES_RGB_GRID_INL_H
#endif

#include <algorithm>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/batch/kernels/draw-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// lerp_clamped(): a node and the weight of the next one. Of the last node that is 0, or the one before has weight 1.
struct Between {
  VI lo;
  V t;
};
HWY_INLINE Between between_clamped(V x, int n) {
  const V clamped = hn::Min(hn::IfThenElseZero(hn::Gt(x, zero()), x), set(static_cast<float>(n - 1)));  // NaN: 0
  const VI lo = hn::Min(truncated(clamped), set_int(std::max(n - 2, 0)));
  return {lo, hn::Sub(clamped, hn::ConvertTo(D(), lo))};
}

/// Cells [layer][row][column].
struct RgbGrid {
  const float* cells;
  std::ptrdiff_t columns, next_row, next_layer;  // the steps in floats; 0 where there is but one

  HWY_INLINE RgbGrid(const std::vector<glm::vec3>& values, int layers, int rows, int width)
      : cells(&values.front().x),
        columns(width),
        next_row(rows > 1 ? 3 * columns : 0),
        next_layer(layers > 1 ? 3 * columns * rows : 0) {}
};

/// Where a block of elements lies among the cells: between a column and the next, `a` of the way, between rows `b`,
/// between layers `c`. `row` counts those of all layers.
struct RgbBlock {
  HWY_ALIGN int row[block_size], column[block_size], next_column[block_size];
  HWY_ALIGN float a[block_size], b[block_size], c[block_size];

  HWY_INLINE void set_at(std::size_t k, VI all_rows, VI at_column, VI column_after, V x, V y, V z) {
    const D d;
    const DI i;
    hn::Store(all_rows, i, row + k), hn::Store(at_column, i, column + k), hn::Store(column_after, i, next_column + k);
    hn::Store(x, d, a + k), hn::Store(y, d, b + k), hn::Store(z, d, c + k);
  }
};

/// The value at a place: four floats, the last without meaning. The eight cells are loaded as whole RGB triples: a
/// third of the loads that gathers of single channels would make.
HWY_INLINE void mix_rgb(const RgbGrid& grid, const RgbBlock& block, std::size_t k, float* to) {
  const hn::CappedTag<float, 4> d4;  // one triple, where vectors are that long
  const float* first = grid.cells + 3 * (block.row[k] * grid.columns + block.column[k]);
  const float* next = grid.cells + 3 * (block.row[k] * grid.columns + block.next_column[k]);
  const auto mixed = [](auto tag, float t, auto p, auto q)
                         GONIO_INLINED { return hn::MulAdd(hn::Set(tag, t), hn::Sub(q, p), p); };
  // Between rows and layers, of what `load` makes of a step from the first cell.
  const auto column = [&](auto tag, const auto& load) GONIO_INLINED {
    return mixed(tag, block.c[k], mixed(tag, block.b[k], load(0), load(grid.next_row)),
                 mixed(tag, block.b[k], load(grid.next_layer), load(grid.next_layer + grid.next_row)));
  };
#if HWY_TARGET <= HWY_AVX2
  const hn::FixedTag<float, 8> d8;  // two cells side by side
  const auto both = column(d8, [&](std::ptrdiff_t step) GONIO_INLINED {
    return hn::Combine(d8, hn::LoadU(d4, next + step), hn::LoadU(d4, first + step));
  });
  hn::StoreU(mixed(d4, block.a[k], hn::LowerHalf(both), hn::UpperHalf(d4, both)), d4, to);
#else
  for (std::size_t channel = 0; channel < 4; channel += hn::Lanes(d4)) {
    const auto of = [&](const float* cell) GONIO_INLINED {
      return column(d4, [&](std::ptrdiff_t step) GONIO_INLINED { return hn::LoadU(d4, cell + step + channel); });
    };
    hn::StoreU(mixed(d4, block.a[k], of(first), of(next)), d4, to + channel);
  }
#endif
}

/// The values of `count` elements, a block of whole vectors at most, times scale(k), a vector of factors. Negative ones
/// become 0.
template <class Scale>
HWY_INLINE void find_rgb(const RgbGrid& grid, const RgbBlock& block, std::size_t count, const Scale& scale,
                         float* const (&out)[3]) {
  const D d;
  HWY_ALIGN float rgb[4 * block_size];
  for (std::size_t k = 0; k < count; ++k) mix_rgb(grid, block, k, rgb + 4 * k);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    V channel[3], unused;
    load4(rgb + 4 * k, channel[0], channel[1], channel[2], unused);
    const V factor = scale(k);
    for (int i = 0; i < 3; ++i) hn::StoreU(hn::Mul(hn::Max(channel[i], zero()), factor), d, out[i] + k);
  }
}

/// Both directions of an element.
struct Pair {
  Direction wi, wo;
  M above;  // both of them

  HWY_INLINE Pair(const float* const (&in)[6], std::size_t k)
      : wi{hn::LoadU(D(), in[0] + k), hn::LoadU(D(), in[1] + k), hn::LoadU(D(), in[2] + k)},
        wo{hn::LoadU(D(), in[3] + k), hn::LoadU(D(), in[4] + k), hn::LoadU(D(), in[5] + k)},
        above(hn::And(is_above(wi), is_above(wo))) {}
};

HWY_INLINE V length_xy(const Direction& w) { return hn::Sqrt(hn::MulAdd(w.x, w.x, hn::Mul(w.y, w.y))); }
HWY_INLINE V atan2(V y, V x) { return hn::CopySign(abs_atan2(y, x), y); }

/// The azimuth of `w` relative to that of wi, in [-pi, pi]; at the pole, where wi has none, relative to +x.
HWY_INLINE V relative_azimuth(const Direction& wi, const Direction& w) {
  const M pole = hn::And(hn::Eq(wi.x, zero()), hn::Eq(wi.y, zero()));
  const V x = hn::IfThenElse(pole, set(1), wi.x), y = hn::IfThenZeroElse(pole, wi.y);
  return atan2(hn::MulSub(x, w.y, hn::Mul(y, w.x)), hn::MulAdd(x, w.x, hn::Mul(y, w.y)));
}

/// MerlTable and MbsdfTable: fill(pair, block, k) says where among the cells a vector of pairs lies.
template <class Fill>
HWY_INLINE void eval_grid(const RgbGrid& grid, std::size_t count, const float* const (&in)[6], float* const (&out)[3],
                          const Fill& fill) {
  for_blocks(count, in, out, [&](auto elements, const float* const(&x)[6], float* const(&y)[3]) GONIO_INLINED {
    RgbBlock block;
    HWY_ALIGN float share[block_size];
    for (std::size_t k = 0; k < elements; k += hn::Lanes(D())) {
      const Pair pair(x, k);
      fill(pair, block, k);
      hn::Store(hn::IfThenElseZero(pair.above, set(1)), D(), share + k);
    }
    find_rgb(
        grid, block, elements, [&](std::size_t k) GONIO_INLINED { return hn::Load(D(), share + k); }, y);
  });
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
