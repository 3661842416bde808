// The incident direction on vectors, once per instruction set: included by the kernels' own files alone.
#if defined(GONIO_BATCH_FRAME_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_FRAME_INL_H
#undef GONIO_BATCH_FRAME_INL_H
#else
#define GONIO_BATCH_FRAME_INL_H
#endif

#include <gonio/brdf/batch/kernels/charts-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// An incident angle, and as a radius of the disk.
struct IncidentAngle {
  V theta, r;
};
/// theta_to_radius(); beyond pi/2 and below 0 as at the ends.
HWY_INLINE IncidentAngle incident_angle(V theta_i) {
  const V theta = hn::Min(hn::Max(theta_i, zero()), set(1.57079633f));
  return {theta, hn::Mul(set(1.41421356f), sin_cos(hn::Mul(set(0.5f), theta)).sin)};
}

/// is_above() of frame.h.
HWY_INLINE M is_above(const Direction& w) {
  return hn::And(hn::Gt(w.z, zero()), hn::IsFinite(hn::Add(hn::Add(w.x, w.y), w.z)));
}

/// IncidentFrame, and its to_surface(). The angle by way of the radius, as radius_to_theta(): sooner at hand than an
/// arc tangent.
struct Frame {
  IncidentAngle i;
  V cos_phi, sin_phi;
  M above;

  explicit HWY_INLINE Frame(const Direction& wi) : above(is_above(wi)) {
    const V one = set(1), sine2 = hn::MulAdd(wi.x, wi.x, hn::Mul(wi.y, wi.y));
    const V steep = hn::Div(sine2, hn::Add(one, hn::Max(wi.z, zero())));  // direction_to_polar()
    const V r2 = hn::IfThenElse(hn::Lt(wi.z, set(0.5f)), hn::Sub(one, wi.z), steep);
    i.r = hn::IfThenElseZero(above, hn::Min(hn::Sqrt(r2), one));  // a number whatever wi is: places are found by it
    i.theta =
        hn::Mul(i.r, polynomial(hn::Mul(i.r, i.r), 1.414213546f, 1.178531667e-1f, 2.647448250e-2f, 8.216730964e-3f,
                                1.478859820e-3f, 3.338417016e-3f, -1.990642964e-3f, 1.211737771e-3f));
    const M tilted = hn::Gt(sine2, zero());
    const V inverse = hn::Div(one, hn::Sqrt(sine2));
    cos_phi = hn::IfThenElse(tilted, hn::Mul(wi.x, inverse), one);
    sin_phi = hn::IfThenElseZero(tilted, hn::Mul(wi.y, inverse));
  }
  HWY_INLINE Direction to_diagram(const Direction& w) const {
    return {hn::MulAdd(cos_phi, w.x, hn::Mul(sin_phi, w.y)), hn::MulSub(cos_phi, w.y, hn::Mul(sin_phi, w.x)), w.z};
  }
};

HWY_INLINE Direction to_surface(V cos_phi, V sin_phi, const Direction& w) {
  return {hn::MulSub(cos_phi, w.x, hn::Mul(sin_phi, w.y)), hn::MulAdd(sin_phi, w.x, hn::Mul(cos_phi, w.y)), w.z};
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
