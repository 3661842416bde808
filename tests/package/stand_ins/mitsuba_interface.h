#pragma once

// What docs/examples/mitsuba_bsdf.h uses of Mitsuba 3, as little as compiles: names and meanings of
// mitsuba/render/bsdf.h in a scalar RGB variant, no code of theirs.

#include <array>
#include <cstdint>
#include <utility>

namespace mitsuba {

using Float = float;

struct Vector3f {
  Float x = 0, y = 0, z = 0;
};
struct Point2f {
  Float x, y;
};
struct Spectrum {
  std::array<Float, 3> values{};
  Float operator[](int c) const { return values[static_cast<std::size_t>(c)]; }
};

enum BSDFFlags : std::uint32_t { GlossyReflection = 1, FrontSide = 2, BackSide = 4 };

struct SurfaceInteraction {
  Vector3f wi;  ///< local, away from the surface
};
struct BSDFSample {
  Vector3f wo;
  Float pdf = 0;
  Float eta = 1;
  std::uint32_t sampled_type = 0;
};

/// Values and weights contain the cosine.
class BSDF {
 public:
  virtual ~BSDF() = default;
  virtual std::pair<BSDFSample, Spectrum> sample(const SurfaceInteraction& si, Float sample1,
                                                 const Point2f& sample2) const = 0;
  virtual Spectrum eval(const SurfaceInteraction& si, const Vector3f& wo) const = 0;
  virtual Float pdf(const SurfaceInteraction& si, const Vector3f& wo) const = 0;
  virtual Spectrum eval_diffuse_reflectance(const SurfaceInteraction& si) const = 0;
  std::uint32_t flags() const { return m_flags; }

 protected:
  std::uint32_t m_flags = 0;
};

}  // namespace mitsuba
