#pragma once

#include <cmath>
#include <utility>

#include <gonio/brdf/bsdf/bsdf.h>

#include "mitsuba_interface.h"  // in Mitsuba: <mitsuba/render/bsdf.h>

// A material of gonio as a BSDF of Mitsuba 3 (scalar variants). Directions have the same names: wi is
// known, wo drawn. Values contain the cosine.
class GonioBSDF final : public mitsuba::BSDF {
 public:
  GonioBSDF(gonio::Bsdf bsdf, bool two_sided) : bsdf_(std::move(bsdf)), two_sided_(two_sided) {
    m_flags = mitsuba::GlossyReflection | mitsuba::FrontSide | (two_sided ? mitsuba::BackSide : 0u);
  }

  std::pair<mitsuba::BSDFSample, mitsuba::Spectrum> sample(const mitsuba::SurfaceInteraction& si, mitsuba::Float,
                                                           const mitsuba::Point2f& u) const override {
    const bool below = si.wi.z < 0;
    if (below && !two_sided_) return {};
    const auto s = bsdf_.sample(up(si.wi, below), {u.x, u.y});
    if (!s) return {};  // weight and pdf 0: the path ends
    const float sign = below ? -1.0f : 1.0f;
    mitsuba::BSDFSample bs;
    bs.wo = {sign * s->wo.x, sign * s->wo.y, sign * s->wo.z};
    bs.pdf = s->pdf;
    bs.sampled_type = mitsuba::GlossyReflection;
    return {bs, spectrum(s->weight)};
  }

  mitsuba::Spectrum eval(const mitsuba::SurfaceInteraction& si, const mitsuba::Vector3f& wo) const override {
    const bool below = si.wi.z < 0;
    if (below && !two_sided_) return {};
    return spectrum(bsdf_.eval(up(si.wi, below), up(wo, below)) * std::abs(wo.z));
  }

  mitsuba::Float pdf(const mitsuba::SurfaceInteraction& si, const mitsuba::Vector3f& wo) const override {
    const bool below = si.wi.z < 0;
    return below && !two_sided_ ? 0.0f : bsdf_.pdf(up(si.wi, below), up(wo, below));
  }

  // What Mitsuba's integrators write as albedo: all that is reflected, not the diffuse part alone.
  mitsuba::Spectrum eval_diffuse_reflectance(const mitsuba::SurfaceInteraction& si) const override {
    if (si.wi.z < 0 && !two_sided_) return {};
    return spectrum(bsdf_.albedo(std::acos(std::fmin(std::abs(si.wi.z), 1.0f))));
  }

  mitsuba::Float roughness() const { return bsdf_.roughness(); }  // as alpha

 private:
  static glm::vec3 up(const mitsuba::Vector3f& w, bool below) {
    return below ? glm::vec3(-w.x, -w.y, -w.z) : glm::vec3(w.x, w.y, w.z);
  }
  static mitsuba::Spectrum spectrum(const glm::vec3& rgb) { return {{rgb.r, rgb.g, rgb.b}}; }

  gonio::Bsdf bsdf_;
  bool two_sided_;
};
