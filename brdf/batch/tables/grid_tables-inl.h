// MerlTable and MbsdfTable on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_TABLES_GRID_TABLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_TABLES_GRID_TABLES_INL_H
#undef GONIO_TABLES_GRID_TABLES_INL_H
#else
#define GONIO_TABLES_GRID_TABLES_INL_H
#endif

#include <gonio/brdf/batch/tables/rgb_grid-inl.h>
#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// half_difference().
struct HalfDifferenceAngles {
  V theta_h, theta_d, phi_d;

  explicit HWY_INLINE HalfDifferenceAngles(const Pair& pair) {
    const Direction h{hn::Add(pair.wi.x, pair.wo.x), hn::Add(pair.wi.y, pair.wo.y), hn::Add(pair.wi.z, pair.wo.z)};
    const Direction e{hn::Sub(pair.wi.x, pair.wo.x), hn::Sub(pair.wi.y, pair.wo.y), hn::Sub(pair.wi.z, pair.wo.z)};
    const V across = length_xy(h), length = hn::Sqrt(hn::MulAdd(h.z, h.z, hn::Mul(across, across)));
    theta_h = abs_atan2(across, h.z);
    const V e_length = hn::Sqrt(hn::MulAdd(e.x, e.x, hn::MulAdd(e.y, e.y, hn::Mul(e.z, e.z))));
    theta_d = abs_atan2(e_length, length);
    const M tilted = hn::Gt(across, zero());
    const V inverse = hn::Div(set(1), across);
    const V x = hn::IfThenElse(tilted, hn::Mul(h.x, inverse), set(1));
    const V y = hn::IfThenElseZero(tilted, hn::Mul(h.y, inverse));
    const V along_tangent = hn::NegMulAdd(across, e.z, hn::Mul(h.z, hn::MulAdd(x, e.x, hn::Mul(y, e.y))));
    phi_d = atan2(hn::Mul(length, hn::MulSub(x, e.y, hn::Mul(y, e.x))), along_tangent);
  }
};

HWY_INLINE void eval_table(const MerlTable& table, std::size_t count, const float* const (&in)[6],
                           float* const (&out)[3]) {
  const int n_h = MerlFile::n_theta_h, n_d = MerlFile::n_theta_d, n_phi = table.n_phi_d();
  const RgbGrid grid(table.values(), n_h, n_d, n_phi);
  eval_grid(grid, count, in, out, [&](const Pair& pair, RgbBlock& block, std::size_t k) GONIO_INLINED {
    const V per_degree = set(static_cast<float>(180 / pi<double>)), half = set(0.5f),
            period = set(static_cast<float>(n_phi));
    const HalfDifferenceAngles angles(pair);
    const V root = hn::Sqrt(hn::Mul(angles.theta_h, set(static_cast<float>(2 / pi<double>))));
    const Between h = between_clamped(hn::MulSub(set(90), root, half), n_h);
    const Between d = between_clamped(hn::MulSub(angles.theta_d, per_degree, half), n_d);
    const V bin = hn::Mul(angles.phi_d, per_degree);
    V x = hn::Sub(hn::IfThenElse(hn::Lt(bin, zero()), hn::Add(bin, period), bin), half);
    // lerp_periodic(): from the last cell over the end to the first one. Of a NaN, cell 0.
    x = hn::IfThenElseZero(hn::And(hn::Ge(x, set(-1)), hn::Lt(x, period)), x);
    const V base = hn::Floor(x);
    const VI last = set_int(n_phi - 1), before = truncated(base);
    const VI lo = hn::IfThenElse(hn::Lt(before, hn::Zero(DI())), last, before);
    const VI hi = hn::IfThenZeroElse(hn::Eq(lo, last), hn::Add(lo, set_int(1)));
    block.set_at(k, hn::Add(hn::Mul(h.lo, set_int(n_d)), d.lo), lo, hi, hn::Sub(x, base), d.t, h.t);
  });
}

HWY_INLINE void eval_table(const MbsdfTable& table, std::size_t count, const float* const (&in)[6],
                           float* const (&out)[3]) {
  const int n_in = table.n_theta_in(), n_out = table.n_theta_out(), n_phi = table.n_phi();
  const RgbGrid grid(table.values(), n_in, n_out, n_phi);
  eval_grid(grid, count, in, out, [&](const Pair& pair, RgbBlock& block, std::size_t k) GONIO_INLINED {
    const auto place = [](V angle, float range, int n) GONIO_INLINED {
      return between_clamped(hn::MulSub(angle, set(static_cast<float>(n) / range), set(0.5f)), n);
    };
    const Between i = place(abs_atan2(length_xy(pair.wi), pair.wi.z), pi<float> / 2, n_in);
    const Between o = place(abs_atan2(length_xy(pair.wo), pair.wo.z), pi<float> / 2, n_out);
    const Between p = place(hn::Abs(relative_azimuth(pair.wi, pair.wo)), pi<float>, n_phi);
    const VI next = n_phi > 1 ? hn::Add(p.lo, set_int(1)) : p.lo;
    block.set_at(k, hn::Add(hn::Mul(i.lo, set_int(n_out)), o.lo), p.lo, next, p.t, o.t, i.t);
  });
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
