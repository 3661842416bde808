// Arithmetic on vectors of floats, once per instruction set: included by the kernels' own files alone. They
// may define GONIO_LANE_CAP as 1 or 2: then vectors have no more elements, else as many as the machine allows.
#if defined(GONIO_BATCH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_LANES_INL_H
#undef GONIO_BATCH_LANES_INL_H
#else
#define GONIO_BATCH_LANES_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

// Names of its own for each: what is not inlined would be taken for the same function.
#undef GONIO_LANES
#ifndef GONIO_LANE_CAP
#define GONIO_LANES many
#elif GONIO_LANE_CAP == 1
#define GONIO_LANES one
#else
#define GONIO_LANES pairs
#endif

// Of a lambda. Sizes of 1 that the compiler knows leave nothing of the loops over elements.
#undef GONIO_INLINED
#define GONIO_INLINED HWY_ATTR __attribute__((always_inline))

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

namespace hn = hwy::HWY_NAMESPACE;

#ifdef GONIO_LANE_CAP
using D = hn::CappedTag<float, GONIO_LANE_CAP>;
#else
using D = hn::ScalableTag<float>;
#endif
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

HWY_INLINE V set(float x) { return hn::Set(D(), x); }
HWY_INLINE VI set_int(int x) { return hn::Set(DI(), x); }
HWY_INLINE V zero() { return hn::Zero(D()); }
HWY_INLINE V clamp01(V x) { return hn::Min(hn::Max(x, zero()), set(1)); }
// Gathers. (Those of vectors of two would read four.)
#ifndef GONIO_LANE_CAP
HWY_INLINE V at(const float* base, VI index) { return hn::GatherIndex(D(), base, index); }
HWY_INLINE VI at(const int* base, VI index) { return hn::GatherIndex(DI(), base, index); }
#elif GONIO_LANE_CAP == 1
HWY_INLINE V at(const float* base, VI index) { return set(base[hn::GetLane(index)]); }
HWY_INLINE VI at(const int* base, VI index) { return set_int(base[hn::GetLane(index)]); }
#endif
/// Towards 0, of what an int holds.
HWY_INLINE VI truncated(V x) {
#if GONIO_LANE_CAP == 1
  return set_int(static_cast<int>(hn::GetLane(x)));
#else
  return hn::ConvertTo(DI(), x);
#endif
}
/// The lanes of a vector one by one.
template <class Vector>
struct Lanes {
  using Tag = hn::DFromV<Vector>;
  HWY_ALIGN hn::TFromD<Tag> x[hn::MaxLanes(Tag())];

  explicit HWY_INLINE Lanes(Vector v) { hn::Store(v, Tag(), x); }
  HWY_INLINE Vector vector() const { return hn::Load(Tag(), x); }
};
#if !(GONIO_LANE_CAP == 2)
/// The values at index, and in the upper half of each lane those at index + 1.
HWY_INLINE VI two_shorts(const std::uint16_t* base, VI index) {
#if !defined(GONIO_LANE_CAP) && (HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2)
  return hn::GatherOffset(DI(), reinterpret_cast<const int*>(base), hn::Add(index, index));
#else
  Lanes<VI> lanes(index);
  for (std::size_t k = 0; k < hn::Lanes(D()); ++k) {
    const std::uint16_t* pair = base + lanes.x[k];
    lanes.x[k] = static_cast<int>(pair[0] | static_cast<std::uint32_t>(pair[1]) << 16);
  }
  return lanes.vector();
#endif
}
/// The values at index and index + 1. Where gathers are instructions, one of 64 bits is half as dear as two of 32.
struct Two {
  V first, second;
};
HWY_INLINE Two two_at(const float* base, VI index) {
#if !defined(GONIO_LANE_CAP) && (HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2)
  const hn::Repartition<std::int64_t, D> wide;
  const hn::Half<DI> half;
  const auto* pairs = reinterpret_cast<const std::int64_t*>(base);
  const VI bytes = hn::ShiftLeft<2>(index);
  const V lower = hn::BitCast(D(), hn::GatherOffset(wide, pairs, hn::PromoteTo(wide, hn::LowerHalf(half, bytes))));
  const V upper = hn::BitCast(D(), hn::GatherOffset(wide, pairs, hn::PromoteTo(wide, hn::UpperHalf(half, bytes))));
  return {hn::ConcatEven(D(), upper, lower), hn::ConcatOdd(D(), upper, lower)};
#else
  return {at(base, index), at(base + 1, index)};
#endif
}
/// Four arrays with their values in turn.
HWY_INLINE void load4(const float* x, V& a, V& b, V& c, V& d) {
#if GONIO_LANE_CAP == 1
  a = set(x[0]), b = set(x[1]), c = set(x[2]), d = set(x[3]);
#else
  hn::LoadInterleaved4(D(), x, a, b, c, d);
#endif
}
#endif

HWY_INLINE V mix(V a, V x, V y) { return hn::MulAdd(a, y, hn::NegMulAdd(a, x, x)); }  // (1 - a) x + a y

/// x / y, 0 where y is not positive.
HWY_INLINE V quotient(V x, V y) { return hn::IfThenElseZero(hn::Gt(y, zero()), hn::Div(x, y)); }

/// c0 + c1 x + ... in steps of x^2: half the waiting of Horner's steps.
HWY_INLINE V in_pairs(V, V, float c0) { return set(c0); }
HWY_INLINE V in_pairs(V x, V, float c0, float c1) { return hn::MulAdd(set(c1), x, set(c0)); }
template <class... C>
HWY_INLINE V in_pairs(V x, V x2, float c0, float c1, C... c) {
  return hn::MulAdd(in_pairs(x, x2, c...), x2, hn::MulAdd(set(c1), x, set(c0)));
}
template <class... C>
HWY_INLINE V polynomial(V x, C... c) {
  return in_pairs(x, hn::Mul(x, x), c...);
}

/// sin and cos for |x| <= 8: error 1e-7, absolute. Cephes' polynomials (sinf.c) over an eighth of a turn either side of
/// the axes.
struct SinCos {
  V sin, cos;
};
HWY_INLINE SinCos sin_cos(V x) {
  const V quarter = hn::Round(hn::Mul(x, set(0.636619772f)));
  const VI k = hn::ConvertTo(DI(), quarter);
  // pi / 2 in two floats.
  const V t = hn::NegMulAdd(quarter, set(-4.37113883e-8f), hn::NegMulAdd(quarter, set(1.57079637f), x));
  const V z = hn::Mul(t, t);
  const V s = hn::MulAdd(hn::Mul(polynomial(z, -1.6666654611e-1f, 8.3321608736e-3f, -1.9515295891e-4f), z), t, t);
  const V c =
      hn::MulAdd(polynomial(z, -0.5f, 4.166664568298827e-2f, -1.388731625493765e-3f, 2.443315711809948e-5f), z, set(1));
  const auto odd = hn::RebindMask(D(), hn::Ne(hn::And(k, set_int(1)), hn::Zero(DI())));
  const V sin_sign = hn::BitCast(D(), hn::ShiftLeft<30>(hn::And(k, set_int(2))));
  const V cos_sign = hn::BitCast(D(), hn::ShiftLeft<30>(hn::And(hn::Add(k, set_int(1)), set_int(2))));
  return {hn::Xor(hn::IfThenElse(odd, c, s), sin_sign), hn::Xor(hn::IfThenElse(odd, s, c), cos_sign)};
}

/// |atan2(y, x)| in [0, pi]; the polynomial of fast_atan2().
HWY_INLINE V abs_atan2(V y, V x) {
  const V ax = hn::Abs(x), ay = hn::Abs(y);
  const V a = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), set(1.17549435e-38f)));
  V p = hn::Mul(a, polynomial(hn::Mul(a, a), 9.999999818e-1f, -3.333303671e-1f, 1.999187203e-1f, -1.419779779e-1f,
                              1.061837064e-1f, -7.456854825e-2f, 4.213762358e-2f, -1.573124912e-2f, 2.766283500e-3f));
  p = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(set(1.57079633f), p), p);
  return hn::IfThenElse(hn::Lt(x, zero()), hn::Sub(set(3.14159265f), p), p);
}

/// cube_root() of fast_math.h: inputs are kept from making numbers so small that the machine computes them in
/// microcode.
struct CubeRoot {
  V root, inverse;
};
HWY_INLINE CubeRoot cube_root(V value) {
  const V x = hn::Max(value, set(1e-30f));
  const V bits = hn::ConvertTo(D(), hn::BitCast(DI(), x));
  V y = hn::BitCast(D(), hn::ConvertTo(DI(), hn::NegMulAdd(bits, set(1.0f / 3), set(1418657792.0f))));  // 0x548f0000
  const V c = hn::Mul(hn::Mul(x, y), hn::Mul(y, y));
  y = hn::Mul(y, hn::NegMulAdd(hn::NegMulAdd(c, set(0.451924025f), set(1.16826499f)), c, set(1.72261893f)));
  const V root = hn::Mul(hn::Mul(x, y), y), rest = hn::NegMulAdd(root, y, set(1));
  return {hn::MulAdd(hn::Mul(root, rest), set(2.0f / 3), root), hn::MulAdd(hn::Mul(y, rest), set(1.0f / 3), y)};
}

/// cos_third() of fast_math.h.
HWY_INLINE V cos_third(V x) {
  const V y = hn::Sqrt(hn::Max(hn::MulAdd(set(0.5f), x, set(0.5f)), zero()));
  return polynomial(y, 0.5000000037f, 0.5773496614f, -0.1110944928f, 0.05327935085f, -0.03192541214f, 0.01960032094f,
                    -0.01023750833f, 0.003654119569f, -0.0006260453235f);
}

/// RadialCell.
struct Cell {
  V r0, h, d0, d1;

  HWY_INLINE V density(V s) const { return mix(s, d0, d1); }
  HWY_INLINE V place(V r) const { return clamp01(hn::Div(hn::Sub(r, r0), h)); }
  HWY_INLINE V radius(V s) const { return hn::MulAdd(s, h, r0); }
  HWY_INLINE V gap(V s) const { return hn::NegMulAdd(s, h, hn::Sub(set(1), r0)); }
  /// from_end() in the lanes of `ends`, this cell in the others.
  HWY_INLINE Cell from_end(M ends, V r1) const {
    return {hn::IfThenElse(ends, r1, r0), hn::IfThenElse(ends, hn::Neg(h), h), hn::IfThenElse(ends, d1, d0),
            hn::IfThenElse(ends, d0, d1)};
  }
  HWY_INLINE V density_at(V r, V to_horizon, V r1) const {
    const V t = clamp01(hn::Div(hn::IfThenElse(hn::Lt(r1, set(1)), hn::Sub(r1, r), to_horizon), h));
    return hn::IfThenElse(hn::Lt(t, set(0.5f)), mix(t, d1, d0), density(place(r)));
  }
  HWY_INLINE V mass(V s) const {
    const V ds = density(s), sh = hn::Mul(s, h);
    const V third = hn::Mul(hn::Mul(sh, set(1.0f / 3)), hn::MulAdd(set(2), ds, d0));
    return hn::Mul(sh, hn::MulAdd(r0, hn::Add(d0, ds), third));
  }

  /// The mass over h.
  HWY_INLINE V mean() const {
    return hn::MulAdd(r0, hn::Add(d0, d1), hn::Mul(hn::Mul(h, set(1.0f / 3)), hn::MulAdd(set(2), d1, d0)));
  }
  /// RadialCell::invert() of the mass `inside`, `sum` being mean() and `whole` the mass; 0 where the cell or `inside`
  /// has none.
  HWY_INLINE V invert(V inside, V sum, V whole) const {
    const V one = set(1), third = set(1.0f / 3);
    const V scale = hn::Div(one, sum);
    const V tau = hn::Min(hn::Div(inside, whole), one);
    const V delta = hn::Sub(d1, d0);
    const V c3 = hn::Mul(hn::Mul(set(2.0f / 3), hn::Mul(r0, d0)), scale);  // c / 3
    const V b = hn::Mul(hn::MulAdd(r0, delta, hn::Mul(h, d0)), scale);
    const V a = hn::Mul(hn::Mul(set(2.0f / 3), hn::Mul(h, delta)), scale);
    const V c3_2 = hn::Mul(c3, c3);
    const V p3 = hn::Max(hn::MulAdd(hn::Mul(b, tau), third, c3_2), zero());
    const V q2 = hn::MulAdd(hn::MulAdd(b, c3, hn::Mul(a, tau)), hn::Mul(tau, set(0.5f)), hn::Mul(c3_2, c3));
    const V root_p3 = hn::Sqrt(p3), cube = hn::Mul(p3, root_p3), larger = hn::Max(q2, cube);
    const CubeRoot t = cube_root(hn::MulAdd(hn::Sqrt(hn::Sub(larger, cube)), hn::Sqrt(hn::Add(larger, cube)), larger));
    const V trigonometric = cos_third(hn::Max(hn::Div(q2, hn::Max(larger, set(1e-30f))), set(-1)));
    const V one_root = hn::MulAdd(p3, t.inverse, t.root);
    const V denominator = hn::Add(hn::MulAdd(hn::Add(root_p3, root_p3), hn::Sub(trigonometric, one), one_root), c3);
    const V s = hn::IfThenElse(hn::Gt(denominator, tau), hn::Div(tau, denominator), one);
    return hn::IfThenElseZero(hn::And(hn::Gt(inside, zero()), hn::Gt(whole, zero())), s);
  }
};

/// RadialPlace.
struct CellDraw {
  Cell cell;
  V s;

  /// RadialPlace::of() from the mass before the cell, that of the meridian, and v and 1 - v of the draw.
  HWY_INLINE CellDraw(const Cell& c, V r1, V before, V meridian, V v, V rest) {
    const V sum = c.mean(), whole = hn::Mul(sum, c.h);
    const V most = hn::Mul(meridian, set(1 - 4 * 1.1920929e-7f));
    const V beyond = hn::Mul(rest, meridian);
    const M last = hn::Or(hn::Ge(r1, set(1)), hn::Ge(hn::Add(before, whole), most));
    const M ends = hn::And(last, hn::Lt(hn::Add(beyond, beyond), whole));
    cell = c.from_end(ends, r1);
    s = cell.invert(hn::IfThenElse(ends, beyond, hn::MulSub(v, meridian, before)), sum, whole);
  }
  HWY_INLINE V r() const { return cell.radius(s); }
  HWY_INLINE V gap() const { return cell.gap(s); }
  HWY_INLINE V density() const { return cell.density(s); }
  /// RadialPlace::off_end().
  HWY_INLINE void keep_off_end(float at_horizon) {
    constexpr float inside = 256 * 1.1920929e-7f;
    const M beyond = hn::Lt(gap(), set(at_horizon));
    const M at_end = hn::And(hn::And(hn::Lt(cell.h, zero()), hn::Lt(cell.r0, set(1))),
                             hn::Lt(hn::Neg(hn::Mul(s, cell.h)), set(inside)));
    if (HWY_LIKELY(hn::AllFalse(D(), hn::Or(beyond, at_end)))) return;
    const V way = hn::IfThenElse(beyond, hn::Sub(hn::Sub(set(1), cell.r0), set(at_horizon)), set(-inside));
    s = hn::IfThenElse(hn::Or(beyond, at_end), clamp01(hn::Div(way, cell.h)), s);
  }
};

/// AzimuthCell::invert().
HWY_INLINE V invert_azimuth(V width, V m0, V m1, V inside) {
  const V sum = hn::Add(m0, m1);
  const V x = clamp01(quotient(hn::Add(inside, inside), hn::Mul(width, sum)));
  const V n0 = quotient(m0, sum);
  const V root = hn::Sqrt(hn::Max(hn::MulAdd(hn::NegMulAdd(set(2), n0, set(1)), x, hn::Mul(n0, n0)), zero()));
  return hn::Min(quotient(x, hn::Add(n0, root)), set(1));
}

/// Displacement::smallest_v and tail.
constexpr float smallest_v = 1.1920929e-7f * 1.1920929e-7f, tail = 128 * 1.1920929e-7f;
/// A position in one of two diagrams: the mass along its meridian, and the density there.
struct Displaced {
  V mass, r, pdf;
};
/// Displacement::density() of two positions, at the radius between them.
HWY_INLINE V displaced_density(V w0, V w1, V whole_mass, const Displaced& a, const Displaced& b, V r) {
  // w0 x0 / y0 + w1 x1 / y1 over the terms with weight; 0 if one of these has y = 0: the sum is infinite.
  const M use0 = hn::Gt(w0, zero()), use1 = hn::Gt(w1, zero());
  const auto quotients = [&](V x0, V y0, V x1, V y1) HWY_ATTR {
    const M infinite = hn::Or(hn::AndNot(hn::Gt(y0, zero()), use0), hn::AndNot(hn::Gt(y1, zero()), use1));
    const V sum = hn::Add(hn::IfThenElseZero(use0, hn::Mul(w0, hn::Div(x0, y0))),
                          hn::IfThenElseZero(use1, hn::Mul(w1, hn::Div(x1, y1))));
    return hn::IfThenZeroElse(infinite, sum);
  };
  const V slope_phi = quotients(whole_mass, a.mass, whole_mass, b.mass);
  const V slope_r2 = quotients(a.mass, hn::Mul(a.pdf, a.r), b.mass, hn::Mul(b.pdf, b.r));
  return quotient(whole_mass, hn::Mul(hn::Mul(slope_phi, slope_r2), r));
}

/// monotone_root() in every lane, until all are done.
template <class Function>
HWY_INLINE V root(const Function& function, V x, V lo, V hi) {
  M active = hn::Le(lo, hi);
  V last = hn::Sub(hi, lo), before_last = last;
  for (int step = 0; step < max_root_steps; ++step) {
    const auto [value, derivative] = function(x);
    active = hn::And(active, hn::Ne(value, zero()));
    const M above = hn::Gt(value, zero());
    hi = hn::IfThenElse(above, x, hi);
    lo = hn::IfThenElse(above, lo, x);
    V next = hn::Sub(x, hn::Div(value, derivative));
    const M inside = hn::And(hn::Ge(next, lo), hn::Le(next, hi));
    const M short_enough = hn::Le(hn::Abs(hn::Sub(next, x)), hn::Mul(set(0.5f), before_last));
    next = hn::IfThenElse(hn::And(inside, short_enough), next, hn::MulAdd(set(0.5f), hn::Sub(hi, lo), lo));
    before_last = last, last = hn::Abs(hn::Sub(next, x));
    x = hn::IfThenElse(active, next, x);
    active = hn::And(active, hn::Gt(last, hn::Mul(set(2 * 1.1920929e-7f), x)));
    if (hn::AllFalse(D(), active)) break;
  }
  return x;
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
