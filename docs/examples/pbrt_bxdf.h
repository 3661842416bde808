#pragma once

#include <cmath>
#include <utility>

#include <gonio/brdf/bsdf/bsdf.h>

#include "pbrt_interface.h"  // in pbrt: <pbrt/materials.h>

// A material of gonio as a BxDF of pbrt-v4. There, wo is the known direction and wi the drawn one:
// the other way round than in gonio. Made at every hit and never destroyed: a pointer, nothing
// more.
class GonioBxDF {
 public:
  GonioBxDF() = default;  // pbrt allocates first and assigns then
  explicit GonioBxDF(const gonio::Bsdf* bsdf) : bsdf_(bsdf) {}

  pbrt::BxDFFlags Flags() const { return pbrt::BxDFFlags::GlossyReflection; }

  // Two-sided: below the surface both directions are turned over. Nothing is transmitted.
  pbrt::SampledSpectrum f(pbrt::Vector3f wo, pbrt::Vector3f wi, pbrt::TransportMode) const {
    return spectrum(bsdf_->eval(up(wo, wo), up(wi, wo)));  // 0 if one is below
  }

  std::optional<pbrt::BSDFSample> Sample_f(pbrt::Vector3f wo, pbrt::Float, pbrt::Point2f u, pbrt::TransportMode,
                                           pbrt::BxDFReflTransFlags what = pbrt::BxDFReflTransFlags::All) const {
    if (!reflects(what)) return {};
    const auto s = bsdf_->sample(up(wo, wo), {u.x, u.y});
    if (!s) return {};
    const pbrt::Vector3f wi{s->wo.x, s->wo.y, s->wo.z};
    return pbrt::BSDFSample{spectrum(s->weight * s->pdf / s->wo.z), wo.z < 0 ? -wi : wi, s->pdf,
                            pbrt::BxDFFlags::GlossyReflection};
  }

  pbrt::Float PDF(pbrt::Vector3f wo, pbrt::Vector3f wi, pbrt::TransportMode,
                  pbrt::BxDFReflTransFlags what = pbrt::BxDFReflTransFlags::All) const {
    return reflects(what) ? bsdf_->pdf(up(wo, wo), up(wi, wo)) : 0;
  }

  // Without random numbers, where BxDF::rho of pbrt averages draws.
  pbrt::SampledSpectrum rho(pbrt::Vector3f wo) const {
    return spectrum(bsdf_->albedo(std::acos(std::fmin(pbrt::AbsCosTheta(wo), 1.0f))));
  }

  pbrt::Float Roughness() const { return bsdf_->roughness(); }  // as alpha
  void Regularize() {}                                          // measured: wider lobes would be another material

 private:
  static bool reflects(pbrt::BxDFReflTransFlags what) {
    return (static_cast<int>(what) & static_cast<int>(pbrt::BxDFReflTransFlags::Reflection)) != 0;
  }
  // `w` mirrored to the side that `known` is above.
  static glm::vec3 up(pbrt::Vector3f w, pbrt::Vector3f known) {
    return known.z < 0 ? glm::vec3(-w.x, -w.y, -w.z) : glm::vec3(w.x, w.y, w.z);
  }
  // In pbrt: RGBAlbedoSpectrum or, where f_r is above 1, RGBUnboundedSpectrum at the wavelengths.
  static pbrt::SampledSpectrum spectrum(const glm::vec3& rgb) { return {{rgb.r, rgb.g, rgb.b}}; }

  const gonio::Bsdf* bsdf_ = nullptr;
};

// Lives as long as the scene, and the Bsdf with it.
class GonioMaterial {
 public:
  using BxDF = GonioBxDF;
  explicit GonioMaterial(gonio::Bsdf bsdf) : bsdf_(std::move(bsdf)) {}

  template <class TextureEvaluator>
  GonioBxDF GetBxDF(TextureEvaluator, pbrt::MaterialEvalContext, pbrt::SampledWavelengths&) const {
    return GonioBxDF(&bsdf_);
  }

 private:
  gonio::Bsdf bsdf_;
};
