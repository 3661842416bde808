// The kernels of Bsdf, once per instruction set: included by their own files alone.
#if defined(GONIO_BATCH_BSDF_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIO_BATCH_BSDF_INL_H
#undef GONIO_BATCH_BSDF_INL_H
#else
#define GONIO_BATCH_BSDF_INL_H
#endif

#include <gonio/brdf/batch/kernels/colour-inl.h>
#include <gonio/brdf/batch/kernels/draw-inl.h>
#include <gonio/brdf/batch/kernels/frame-inl.h>

HWY_BEFORE_NAMESPACE();
namespace gonio {
namespace HWY_NAMESPACE {
inline namespace GONIO_LANES {

/// Draws, with their colours if there are outputs for them. Outputs are x, y, z, pdf and then R, G, B.
template <int outputs>
HWY_INLINE void draw_kernel(const BatchLayout& layout, const BatchColour* colour, std::size_t count,
                            const float* const (&in)[5], float* const (&out)[outputs]) {
  for_blocks(count, in, out, [&](auto elements, const float* const(&x)[5], float* const(&y)[outputs]) GONIO_INLINED {
    const D d;
    HWY_ALIGN float theta_i[block_size], r[block_size], cos_phi[block_size], sin_phi[block_size];
    for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
      const Frame frame({hn::LoadU(d, x[0] + k), hn::LoadU(d, x[1] + k), hn::LoadU(d, x[2] + k)});
      hn::Store(frame.i.theta, d, theta_i + k), hn::Store(frame.i.r, d, r + k);
      hn::Store(frame.cos_phi, d, cos_phi + k), hn::Store(frame.sin_phi, d, sin_phi + k);
    }
    const Brackets brackets(layout.angles, elements, theta_i, r);
    if constexpr (outputs == 7)
      find_colours(*colour, elements, colour->same_angles ? brackets : Brackets(colour->angles, elements, theta_i, r),
                   x[3], x[4], y[4], y[5], y[6]);
    draw_stack(layout, elements, brackets, theta_i, x[3], x[4], y[0], y[1], y[2], y[3]);
    for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
      const V pdf = hn::LoadU(d, y[3] + k), z = hn::LoadU(d, y[2] + k);
      const M asked = hn::And(is_above({hn::LoadU(d, x[0] + k), hn::LoadU(d, x[1] + k), hn::LoadU(d, x[2] + k)}),
                              hn::IsFinite(hn::Add(hn::LoadU(d, x[3] + k), hn::LoadU(d, x[4] + k))));
      const M valid = hn::And(asked, hn::And(hn::Gt(pdf, zero()), hn::Gt(z, zero())));
      const Direction wo = to_surface(hn::Load(d, cos_phi + k), hn::Load(d, sin_phi + k),
                                      {hn::LoadU(d, y[0] + k), hn::LoadU(d, y[1] + k), z});
      hn::StoreU(hn::IfThenElseZero(valid, wo.x), d, y[0] + k),
          hn::StoreU(hn::IfThenElseZero(valid, wo.y), d, y[1] + k);
      hn::StoreU(hn::IfThenElseZero(valid, z), d, y[2] + k), hn::StoreU(hn::IfThenElseZero(valid, pdf), d, y[3] + k);
      const V share = hn::IfThenElseZero(valid, hn::Min(hn::Mul(z, set(1 / Colour::min_cosine)), set(1)));
      for (int i = 4; i < outputs; ++i)
        hn::StoreU(hn::IfThenElseZero(valid, hn::Mul(hn::LoadU(d, y[i] + k), share)), d, y[i] + k);
    }
  });
}

HWY_INLINE void pdf_kernel(const BatchLayout& layout, std::size_t count, const float* const (&in)[6],
                           float* const (&out)[1]) {
  for_vectors<6, 1>(count, in, out, [&](const V(&x)[6], V(&y)[1]) GONIO_INLINED {
    const Frame frame({x[0], x[1], x[2]});
    const V pdf =
        pdf_stack(layout, bracket_of(layout.angles, frame.i), frame.i.theta, frame.to_diagram({x[3], x[4], x[5]}));
    y[0] = hn::IfThenElseZero(hn::And(frame.above, is_above({x[3], x[4], x[5]})), pdf);
  });
}

HWY_INLINE void eval_kernel(const BatchLayout& layout, const BatchColour& colour, std::size_t count,
                            const float* const (&in)[6], float* const (&out)[3]) {
  for_blocks(count, in, out, [&](auto elements, const float* const(&x)[6], float* const(&y)[3]) GONIO_INLINED {
    const D d;
    HWY_ALIGN float theta_i[block_size], r[block_size], u[block_size], v[block_size], scale[block_size];
    for (std::size_t k = 0; k < elements; k += hn::Lanes(d)) {
      const Frame frame({hn::LoadU(d, x[0] + k), hn::LoadU(d, x[1] + k), hn::LoadU(d, x[2] + k)});
      const Direction wo = frame.to_diagram({hn::LoadU(d, x[3] + k), hn::LoadU(d, x[4] + k), hn::LoadU(d, x[5] + k)});
      const Inverted at = invert_stack(layout, bracket_of(layout.angles, frame.i), frame.i.theta, wo);
      const M valid = hn::And(hn::And(frame.above, is_above(wo)), hn::Gt(at.pdf, zero()));
      hn::Store(frame.i.theta, d, theta_i + k), hn::Store(frame.i.r, d, r + k), hn::Store(at.u, d, u + k),
          hn::Store(at.v, d, v + k);
      hn::Store(hn::IfThenElseZero(valid, hn::Div(at.pdf, hn::Max(wo.z, set(Colour::min_cosine)))), d, scale + k);
    }
    find_colours(colour, elements, Brackets(colour.angles, elements, theta_i, r), u, v, y[0], y[1], y[2]);
    for (float* channel : y)
      for (std::size_t k = 0; k < elements; k += hn::Lanes(d))
        hn::StoreU(hn::Mul(hn::LoadU(d, channel + k), hn::Load(d, scale + k)), d, channel + k);
  });
}

}  // namespace GONIO_LANES
}  // namespace HWY_NAMESPACE
}  // namespace gonio
HWY_AFTER_NAMESPACE();

#endif
