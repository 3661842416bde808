// Arithmetic on vectors of floats, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_LANES_INL_H
#undef GONIO_BATCH_LANES_INL_H
#else
#define GONIO_BATCH_LANES_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

HWY_INLINE V set(float x) { return hn::Set(D(), x); }
HWY_INLINE VI set_int(int x) { return hn::Set(DI(), x); }
HWY_INLINE V zero() { return hn::Zero(D()); }
HWY_INLINE V clamp01(V x) { return hn::Min(hn::Max(x, zero()), set(1)); }
HWY_INLINE V at(const float* base, VI index) { return hn::GatherIndex(D(), base, index); }
/// The values at index and index + 1. Where gathers are instructions, one of 64 bits is half as dear as two of 32.
struct Two {
  V first, second;
};
HWY_INLINE Two two_at(const float* base, VI index) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2
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
HWY_INLINE V mix(V a, V x, V y) { return hn::MulAdd(a, y, hn::NegMulAdd(a, x, x)); }  // (1 - a) x + a y

/// x / y, 0 where y is not positive.
HWY_INLINE V quotient(V x, V y) { return hn::IfThenElseZero(hn::Gt(y, zero()), hn::Div(x, y)); }

HWY_INLINE V polynomial(V, float c0) { return set(c0); }
template <class... C>
HWY_INLINE V polynomial(V x, float c0, C... c) {
  return hn::MulAdd(polynomial(x, c...), x, set(c0));
}

/// sin and cos for |x| <= 8: error 1e-7, absolute. Cephes' polynomials (sinf.c) over an eighth of a turn either side of the axes.
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
  const V c = hn::MulAdd(polynomial(z, -0.5f, 4.166664568298827e-2f, -1.388731625493765e-3f, 2.443315711809948e-5f), z,
                         set(1));
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

/// The cube root of x >= 0, 4e-7 relative where x is a normal number: a third of the exponent, then two of Halley's steps.
/// Others are kept from making numbers so small that the machine computes them in microcode.
HWY_INLINE V cube_root(V value) {
  const V x = hn::Max(value, set(1e-30f));
  const V bits = hn::ConvertTo(D(), hn::BitCast(DI(), x));
  V t = hn::BitCast(D(), hn::Add(hn::ConvertTo(DI(), hn::Mul(bits, set(1.0f / 3))), set_int(0x2a514067)));
  for (int step = 0; step < 2; ++step) {
    const V cube = hn::Mul(hn::Mul(t, t), t);
    t = hn::Mul(t, hn::Div(hn::MulAdd(set(2), x, cube), hn::MulAdd(set(2), cube, x)));
  }
  return hn::IfThenElseZero(hn::Gt(value, zero()), t);
}

/// cos(acos(x) / 3) for x in [-1, 1]. Its square root at x = -1 taken out, it is analytic: a polynomial through 9
/// Chebyshev nodes of sqrt((1 + x) / 2), whose own relative error is 7e-9.
HWY_INLINE V cos_third(V x) {
  const V y = hn::Sqrt(hn::Max(hn::MulAdd(set(0.5f), x, set(0.5f)), zero()));
  return polynomial(y, 0.5000000037f, 0.5773496614f, -0.1110944928f, 0.05327935085f, -0.03192541214f, 0.01960032094f,
                    -0.01023750833f, 0.003654119569f, -0.0006260453235f);
}

/// find_cell(): from `first`, the last of `count` - 1 ascending values that is below t. Returns its index.
HWY_INLINE VI find(const float* base, VI first, int count, V t) {
  for (int length = count - 1; length > 1;) {
    const int half = length / 2;
    const VI probe = hn::Add(first, set_int(half));
    first = hn::IfThenElse(hn::RebindMask(DI(), hn::Lt(at(base, probe), t)), probe, first);
    length -= half;
  }
  return first;
}

/// RadialCell.
struct Cell {
  V r0, h, d0, d1;

  HWY_INLINE V density(V s) const { return mix(s, d0, d1); }
  HWY_INLINE V mass(V s) const {
    const V ds = density(s), sh = hn::Mul(s, h);
    const V third = hn::Mul(hn::Mul(sh, set(1.0f / 3)), hn::MulAdd(set(2), ds, d0));
    return hn::Mul(sh, hn::MulAdd(r0, hn::Add(d0, ds), third));
  }

  /// RadialCell::invert() of the mass `inside`; 0 where the cell or `inside` has none.
  HWY_INLINE V invert(V inside) const {
    const V one = set(1), third = set(1.0f / 3);
    const V sum = hn::MulAdd(r0, hn::Add(d0, d1), hn::Mul(hn::Mul(h, third), hn::MulAdd(set(2), d1, d0)));
    const V scale = hn::Div(one, sum);
    const V tau = hn::Min(hn::Div(hn::Mul(inside, scale), h), one);
    const V delta = hn::Sub(d1, d0);
    const V c3 = hn::Mul(hn::Mul(set(2.0f / 3), hn::Mul(r0, d0)), scale);  // c / 3
    const V b = hn::Mul(hn::MulAdd(r0, delta, hn::Mul(h, d0)), scale);
    const V a = hn::Mul(hn::Mul(set(2.0f / 3), hn::Mul(h, delta)), scale);
    const V c3_2 = hn::Mul(c3, c3);
    const V p3 = hn::Max(hn::MulAdd(hn::Mul(b, tau), third, c3_2), zero());
    const V q2 = hn::MulAdd(hn::MulAdd(b, c3, hn::Mul(a, tau)), hn::Mul(tau, set(0.5f)), hn::Mul(c3_2, c3));
    const V root_p3 = hn::Sqrt(p3), cube = hn::Mul(p3, root_p3);
    const V t = cube_root(hn::Add(q2, hn::Mul(hn::Sqrt(hn::Max(hn::Sub(q2, cube), zero())),
                                              hn::Sqrt(hn::Max(hn::Add(q2, cube), zero())))));
    const V one_root = hn::Add(t, quotient(p3, t));
    const V three_roots = hn::Mul(hn::Add(root_p3, root_p3), cos_third(hn::Max(hn::Div(q2, cube), set(-1))));
    const V denominator = hn::Add(hn::IfThenElse(hn::Ge(q2, cube), one_root, three_roots), c3);
    const V s = hn::IfThenElse(hn::Gt(denominator, tau), hn::Div(tau, denominator), one);
    return hn::IfThenElseZero(hn::And(hn::Gt(inside, zero()), hn::Gt(hn::Mul(sum, h), zero())), s);
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

}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
