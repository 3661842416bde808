// RglTable on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_TABLES_RGL_TABLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_TABLES_RGL_TABLE_INL_H
#undef GONIO_TABLES_RGL_TABLE_INL_H
#else
#define GONIO_TABLES_RGL_TABLE_INL_H
#endif

#include <limits>

#include <gonio/brdf/batch/tables/rgb_grid-inl.h>
#include <gonio/brdf/formats/rgl/rgl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// The incident angle of the file before theta, and how far theta is from there to the next.
HWY_INLINE Between slice_at(const std::vector<float>& theta_i, V theta) {
  const auto n = static_cast<int>(theta_i.size());
  if (n == 1) return {hn::Zero(DI()), zero()};
  VI lo = hn::Zero(DI());
  for (int i = 1; i + 1 < n; ++i)
    lo = hn::IfThenElse(hn::RebindMask(DI(), hn::Le(set(theta_i[static_cast<std::size_t>(i)]), theta)), set_int(i), lo);
  const Two around = two_at(theta_i.data(), lo);
  return {lo, clamp01(hn::Div(hn::Sub(theta, around.first), hn::Sub(around.second, around.first)))};
}

HWY_INLINE Between between_evenly(V x, int n) { return between_clamped(hn::Mul(x, set(static_cast<float>(n - 1))), n); }

/// Along the line of nodes that starts at `row`.
HWY_INLINE V on_line(const float* values, VI row, const Between& x) {
  const Two around = two_at(values, hn::Add(row, x.lo));
  return mix(x.t, around.first, around.second);
}

/// integrate_linear() of warp2d.cpp.
HWY_INLINE V integrate_linear(V a, V b, V t) { return hn::Mul(t, hn::MulAdd(hn::Mul(set(0.5f), t), hn::Sub(b, a), a)); }

/// Warp2d::invert() of a block of elements.
struct WarpBlock {
  HWY_ALIGN int slice[block_size], i[block_size], j[block_size];
  HWY_ALIGN float t[block_size], x[block_size], y[block_size];
  HWY_ALIGN float nodes[4 * block_size], lines[4 * block_size];

  HWY_INLINE void set_at(std::size_t k, const Warp2d& warp, const Between& of_slice, V u_theta, V u_phi) {
    const D d;
    const DI di;
    const Between px = between_evenly(u_theta, warp.width()), py = between_evenly(u_phi, warp.height());
    hn::Store(of_slice.lo, di, slice + k), hn::Store(px.lo, di, i + k), hn::Store(py.lo, di, j + k);
    hn::Store(of_slice.t, d, t + k), hn::Store(px.t, d, x + k), hn::Store(py.t, d, y + k);
  }

  /// What the nodes and lines around a place have, mixed between slices and, for nodes, between lines.
  HWY_INLINE void load(std::size_t k, const Warp2d& warp, std::ptrdiff_t next_slice) {
    const hn::CappedTag<float, 4> d;
    const std::ptrdiff_t line = slice[k] * static_cast<std::ptrdiff_t>(warp.height()) + j[k], width = warp.width();
    const float* first_line = &warp.lines()[line].before;
    const float* first_node = &warp.nodes()[line * width + i[k]].density;
    const auto mixed = [&](float part, auto p, auto q)
                           GONIO_INLINED { return hn::MulAdd(hn::Set(d, part), hn::Sub(q, p), p); };
    for (std::size_t n = 0; n < 4; n += hn::Lanes(d)) {
      const auto between_lines = [&](const float* node) GONIO_INLINED {
        return mixed(y[k], hn::LoadU(d, node + n), hn::LoadU(d, node + 2 * width + n));
      };
      hn::StoreU(mixed(t[k], between_lines(first_node), between_lines(first_node + 2 * width * next_slice)), d,
                 nodes + 4 * k + n);
      hn::StoreU(mixed(t[k], hn::LoadU(d, first_line + n), hn::LoadU(d, first_line + 2 * next_slice + n)), d,
                 lines + 4 * k + n);
    }
  }

  struct Point {
    V x, y;
  };
  HWY_INLINE Point point(std::size_t k, const Warp2d& warp) const {
    const D d;
    const V tx = hn::Load(d, x + k), ty = hn::Load(d, y + k), one = set(1);
    const V dx = set(1 / static_cast<float>(warp.width() - 1)), dy = set(1 / static_cast<float>(warp.height() - 1));
    V density_0, before, density_1, unused, below, mass_0, mass_1;
    load4(nodes + 4 * k, density_0, before, density_1, unused);
    before = hn::MulAdd(integrate_linear(density_0, density_1, tx), dx, before);
    load4(lines + 4 * k, below, mass_0, unused, mass_1);
    const V mass = mix(ty, mass_0, mass_1), v = hn::MulAdd(integrate_linear(mass_0, mass_1, ty), dy, below);
    const V alone = hn::Mul(hn::Add(hn::ConvertTo(d, hn::Load(DI(), i + k)), tx), dx);  // where there is no mass
    return {hn::IfThenElse(hn::Gt(mass, zero()), hn::Min(hn::Div(before, mass), one), alone), hn::Min(v, one)};
  }
};

HWY_INLINE void eval_table(const RglTable& table, std::size_t count, const float* const (&in)[6],
                           float* const (&out)[3]) {
  const auto slices = static_cast<int>(table.theta_i().size());
  const int height = table.colour_height(), width = table.colour_width();
  const RgbGrid grid(table.colour(), slices, height, width);
  const Warp2d& warp = table.vndf();
  const RglFile::Grid& ndf = table.ndf_grid();
  const std::vector<float>& sigma = table.sigma_line();
  const std::ptrdiff_t next_slice = slices > 1 ? warp.height() : 0;
  for_blocks(count, in, out, [&](auto elements, const float* const(&x)[6], float* const(&y)[3]) GONIO_INLINED {
    const D d;
    WarpBlock warps;
    RgbBlock block;
    HWY_ALIGN float factor[block_size];
    for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
      const Pair pair(x, k);
      const Direction m{hn::Add(pair.wi.x, pair.wo.x), hn::Add(pair.wi.y, pair.wo.y), hn::Add(pair.wi.z, pair.wo.z)};
      const auto u_theta_of = [](const Direction& w) GONIO_INLINED {
        return hn::Sqrt(hn::Mul(abs_atan2(length_xy(w), w.z), set(2 / pi<float>)));
      };
      const V theta_i = abs_atan2(length_xy(pair.wi), pair.wi.z);
      const V u_theta = u_theta_of(m),
              u_phi = hn::MulAdd(relative_azimuth(pair.wi, m), set(0.5f / pi<float>), set(0.5f));
      warps.set_at(k, warp, slice_at(table.theta_i(), theta_i), u_theta, u_phi);
      V scale = hn::Div(set(1), hn::Max(pair.wo.z, set(RglTable::min_cosine)));
      if (table.jacobian()) {
        const Between across = between_evenly(u_theta, ndf.width), along = between_evenly(u_phi, ndf.height);
        const VI row = hn::Mul(along.lo, set_int(ndf.width));
        const VI next_row = ndf.height > 1 ? hn::Add(row, set_int(ndf.width)) : row;
        const V density =
            mix(along.t, on_line(ndf.values.data(), row, across), on_line(ndf.values.data(), next_row, across));
        const V angle = hn::Sqrt(hn::Mul(theta_i, set(2 / pi<float>)));
        const V area = on_line(sigma.data(), hn::Zero(DI()), between_evenly(angle, static_cast<int>(sigma.size())));
        // A damaged file may hold an ndf and a sigma whose quotient no float holds.
        scale =
            hn::Min(hn::Mul(scale, quotient(density, hn::Mul(set(4), area))), set(std::numeric_limits<float>::max()));
      }
      hn::Store(hn::IfThenElseZero(pair.above, scale), d, factor + k);
    }
    for (std::size_t k = 0; k < elements; ++k) warps.load(k, warp, next_slice);
    for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
      const WarpBlock::Point at = warps.point(k, warp);
      const Between across = between_evenly(at.x, width), along = between_evenly(at.y, height);
      const VI row = hn::Add(hn::Mul(hn::Load(DI(), warps.slice + k), set_int(height)), along.lo);
      block.set_at(k, row, across.lo, hn::Add(across.lo, set_int(1)), across.t, along.t, hn::Load(d, warps.t + k));
    }
    find_rgb(
        grid, block, elements, [&](std::size_t k) GONIO_INLINED { return hn::Load(D(), factor + k); }, y);
  });
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
