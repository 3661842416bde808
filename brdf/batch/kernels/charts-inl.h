// The square, the hemisphere and the half-vector chart on vectors, once per instruction set: included by the kernels'
// own files alone.
#if defined(GONIO_BATCH_CHARTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_CHARTS_INL_H
#undef GONIO_BATCH_CHARTS_INL_H
#else
#define GONIO_BATCH_CHARTS_INL_H
#endif

#include <gonio/brdf/batch/kernels/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

struct Direction {
  V x, y, z;
};

/// square_to_disk() and its fold onto a half diagram: the two numbers of the diagram.
struct Folded {
  V u, v, rest;  // 1 - v
  M mirrored;

  HWY_INLINE V sign() const { return hn::IfThenElse(mirrored, set(-1), set(1)); }  // of phi
};
HWY_INLINE Folded square_to_diagram(V u, V v, bool half) {
  const V x = hn::Sub(hn::Add(u, u), set(1)), y = hn::Sub(hn::Add(v, v), set(1));
  const V ax = hn::Abs(x), ay = hn::Abs(y), radius = hn::Max(ax, ay);
  const V part = hn::Mul(set(0.125f), hn::Div(hn::Min(ax, ay), hn::Max(radius, set(1.17549435e-38f))));
  V turn = hn::IfThenElse(hn::Gt(ax, ay), part, hn::Sub(set(0.25f), part));  // in the first quadrant
  turn = hn::IfThenElse(hn::Lt(x, zero()), hn::Sub(set(0.5f), turn), turn);
  const M lower = hn::Lt(y, zero());
  const V r2 = hn::Min(hn::Mul(radius, radius), set(1));
  const V nearest_side = hn::Min(hn::Min(u, hn::Sub(set(1), u)), hn::Min(v, hn::Sub(set(1), v)));
  const V to_rim = hn::Add(nearest_side, nearest_side), rest = hn::Mul(to_rim, hn::Sub(set(2), to_rim));
  if (half) return {hn::Add(turn, turn), r2, rest, lower};
  turn = hn::IfThenElse(lower, hn::Sub(set(1), turn), turn);
  return {hn::IfThenElseZero(hn::Lt(turn, set(1)), turn), r2, rest, hn::MaskFromVec(zero())};
}

/// The inverse of square_to_diagram().
struct Square {
  V u, v;
};
HWY_INLINE Square diagram_to_square(V u, V r2, M mirrored, bool half) {
  V turn = u;
  if (half) {
    turn = hn::Mul(set(0.5f), u);
    turn = hn::IfThenElse(hn::And(mirrored, hn::Gt(u, zero())), hn::Sub(set(1), turn), turn);
  }
  turn = hn::IfThenElseZero(hn::Lt(turn, set(1)), turn);
  const V radius = hn::Sqrt(hn::Min(r2, set(1)));
  // A triangle wave of period 1 and slope 8, cut at one: cosine and sine of the square.
  const V octant = hn::Mul(set(8), turn);
  const V from4 = hn::Abs(hn::Sub(octant, set(4)));                       // 4 ... 0 ... 4
  const V x = hn::Min(hn::Max(hn::Sub(from4, set(2)), set(-1)), set(1));  // 1 at 0, -1 at 4
  const V from6 = hn::Abs(hn::Sub(octant, set(6)));
  const V from2 = hn::Sub(set(2), hn::Abs(hn::Sub(octant, set(2))));
  const V wave = hn::IfThenElse(hn::Gt(octant, set(4)), hn::Sub(from6, set(2)), from2);
  const V y = hn::Min(hn::Max(wave, set(-1)), set(1));
  return {clamp01(hn::Mul(set(0.5f), hn::MulAdd(radius, x, set(1)))),
          clamp01(hn::Mul(set(0.5f), hn::MulAdd(radius, y, set(1))))};
}

/// polar_to_direction() from sine and cosine of phi.
HWY_INLINE Direction to_hemisphere(V r, V gap, SinCos phi) {
  const V sin_theta = hn::Mul(r, hn::Sqrt(hn::NegMulAdd(r, r, set(2))));
  return {hn::Mul(sin_theta, phi.cos), hn::Mul(sin_theta, phi.sin), hn::Mul(gap, hn::Add(set(1), r))};
}

/// A point of the disk, phi as its distance from 0, and HalfVectorChart's Jacobian. The gap is at least `rim`, the
/// least_gap of float.
struct OnDisk {
  V r, gap, phi, jacobian;
};
constexpr float rim = 0.5f * 1.1920929e-7f;

/// direction_to_polar().
HWY_INLINE OnDisk from_hemisphere(const Direction& w) {
  const V across = hn::MulAdd(w.x, w.x, hn::Mul(w.y, w.y));
  const V r2 = hn::IfThenElse(hn::Lt(w.z, set(0.5f)), hn::Sub(set(1), w.z), hn::Div(across, hn::Add(set(1), w.z)));
  const V r = hn::Min(hn::Sqrt(r2), set(1));
  return {r, hn::Max(hn::Div(w.z, hn::Add(set(1), r)), set(rim)), abs_atan2(w.y, w.x), set(1)};
}

/// HalfVectorChart.
struct HalfChart {
  V sin, cos, scale;

  explicit HWY_INLINE HalfChart(V theta_i) {
    const auto [s, c] = sin_cos(hn::Min(hn::Max(theta_i, zero()), set(HalfVectorChart<float>::largest_theta_i)));
    sin = s, cos = c;
    scale = hn::Div(hn::Mul(set(1.41421356f), hn::Add(hn::Sqrt(hn::Add(set(1), c)), set(1))), c);
  }

  struct Meridian {
    V m, cos_max, sin_max, norm;
  };
  HWY_INLINE Meridian meridian(V c) const {
    const V along = hn::Mul(sin, c), norm = hn::Sqrt(hn::MulAdd(cos, cos, hn::Mul(along, along)));
    const V inverse = hn::Div(set(1), norm);
    const V cos2 = hn::Neg(hn::Mul(along, inverse)), sin2 = hn::Mul(cos, inverse);
    const V large = hn::MulAdd(set(0.5f), hn::Abs(cos2), set(0.5f));
    const V small = hn::Div(hn::Mul(sin2, sin2), hn::Mul(set(4), large));
    const M low = hn::Gt(cos2, zero());
    const V cos_max = hn::Sqrt(hn::IfThenElse(low, large, small)), sin_max2 = hn::IfThenElse(low, small, large);
    return {hn::Div(sin_max2, hn::Add(set(1), cos_max)), cos_max, hn::Sqrt(sin_max2), norm};
  }

  struct Image {
    Direction wo;
    V jacobian;
  };
  HWY_INLINE Image direction(V r, V gap, SinCos phi) const {
    const Meridian h = meridian(phi.cos);
    const V one = set(1), q = hn::Mul(r, r), rest = hn::Mul(gap, hn::Add(one, r));
    const V d = hn::MulAdd(scale, rest, hn::Div(q, h.m)), inverse_d = hn::Div(one, d);
    const V below = hn::Mul(hn::Mul(scale, h.m), hn::Mul(rest, inverse_d));
    const V cos_h = hn::Add(h.cos_max, below);
    const V sin_h = hn::Sqrt(hn::Mul(hn::Mul(q, inverse_d), hn::Add(one, cos_h)));
    const V sin_left =
        hn::Div(hn::Mul(below, hn::Add(cos_h, h.cos_max)), hn::MulAdd(h.sin_max, cos_h, hn::Mul(h.cos_max, sin_h)));
    const V z =
        hn::Mul(hn::Mul(hn::Add(h.norm, h.norm), sin_left), hn::MulAdd(h.cos_max, cos_h, hn::Mul(h.sin_max, sin_h)));
    const V cos_d = hn::Div(hn::Add(cos, z), hn::Add(cos_h, cos_h));
    const V along = hn::Mul(hn::Add(cos_d, cos_d), sin_h);
    return {{hn::MulSub(along, phi.cos, sin), hn::Mul(along, phi.sin), z},
            hn::Mul(hn::Mul(hn::Mul(set(4), cos_d), scale), hn::Mul(inverse_d, inverse_d))};
  }

  HWY_INLINE OnDisk disk(const Direction& wo) const {
    const V one = set(1);
    const V x = hn::Add(sin, wo.x), y = wo.y, z = hn::Add(cos, wo.z);
    const V across2 = hn::MulAdd(x, x, hn::Mul(y, y)), across = hn::Sqrt(across2);
    const V length = hn::Sqrt(hn::MulAdd(z, z, across2));
    const V rise = hn::Div(across2, hn::Mul(length, hn::Add(length, z)));  // 1 - cos theta_h
    const M off_pole = hn::Gt(across, zero());
    const Meridian h = meridian(hn::IfThenElse(off_pole, hn::Div(x, across), one));
    const V sin2 = hn::Min(hn::Div(wo.z, h.norm), one), inverse = hn::Div(one, length), cos_h = hn::Mul(z, inverse);
    const V root = hn::Sqrt(hn::Mul(hn::Sub(one, sin2), hn::Add(one, sin2)));
    const V sin_left = hn::Div(sin2, hn::Sqrt(hn::MulAdd(set(2), root, set(2))));
    const V near =
        hn::Div(hn::Mul(sin_left, hn::MulAdd(h.sin_max, cos_h, hn::Mul(h.cos_max, hn::Mul(across, inverse)))),
                hn::Add(cos_h, h.cos_max));
    const V below = hn::IfThenElse(hn::Gt(hn::Add(rise, rise), h.m), near, hn::Sub(h.m, rise));
    const V steep = hn::Mul(scale, rise);
    const V outside = hn::Max(hn::Div(below, h.m), zero()), inverse_sum = hn::Div(one, hn::Add(outside, steep));
    const V q = hn::Min(hn::Mul(steep, inverse_sum), one), rest = hn::Mul(outside, inverse_sum);  // 1 - q
    const V d = hn::MulAdd(scale, rest, hn::Div(q, h.m)), r = hn::Sqrt(q);
    return {r, hn::Max(hn::Div(rest, hn::Add(one, r)), set(rim)), hn::IfThenElseZero(off_pole, abs_atan2(y, x)),
            hn::Div(hn::Mul(hn::Mul(set(2), length), scale), hn::Mul(d, d))};
  }
};

/// from_disk() of folded_disk.h: the direction of a draw of a diagram.
struct Drawn {
  Direction wo;
  V pdf;
};
HWY_INLINE Drawn from_disk(const BatchLayout& layout, V theta_i, V r, V gap, V angle, V sign, V pdf) {
  SinCos phi = sin_cos(angle);
  phi.sin = hn::Mul(phi.sin, sign);
  if (!layout.half_chart) return {to_hemisphere(r, gap, phi), pdf};
  const HalfChart::Image image = HalfChart(theta_i).direction(r, gap, phi);
  return {image.wo, hn::Div(pdf, image.jacobian)};
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
