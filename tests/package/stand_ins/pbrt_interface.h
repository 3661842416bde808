#pragma once

// What docs/examples/pbrt_bxdf.h uses of pbrt-v4, as little as compiles: names and meanings of
// pbrt/base/bxdf.h, pbrt/materials.h and pbrt/util, no code of theirs. Colours have three values
// here.

#include <array>
#include <cstddef>
#include <new>
#include <optional>

namespace pbrt {

using Float = float;

struct Vector3f {
  Float x, y, z;
  Vector3f operator-() const { return {-x, -y, -z}; }
};
struct Point2f {
  Float x, y;
};

struct SampledSpectrum {
  std::array<Float, 3> values{};
  Float operator[](int c) const { return values[static_cast<std::size_t>(c)]; }
};

enum class TransportMode { Radiance, Importance };
enum class BxDFReflTransFlags { Unset = 0, Reflection = 1, Transmission = 2, All = 3 };
enum class BxDFFlags { Unset = 0, Reflection = 1, Transmission = 2, Diffuse = 4, Glossy = 8, GlossyReflection = 9 };

/// f without the cosine; wi is the direction that was drawn.
struct BSDFSample {
  SampledSpectrum f;
  Vector3f wi;
  Float pdf;
  BxDFFlags flags;
};

struct MaterialEvalContext {};
struct SampledWavelengths {};
struct TextureEvaluator {};

/// Memory for the BxDF of a hit: used again for the next one, without a destructor in between.
class ScratchBuffer {
 public:
  template <class T>
  T* Alloc() {
    static_assert(sizeof(T) <= size && alignof(T) <= alignof(std::max_align_t));
    return new (bytes_) T();
  }

 private:
  static constexpr std::size_t size = 64;
  alignas(std::max_align_t) std::byte bytes_[size];
};

/// What Material::GetBSDF() does at a hit, the frame apart.
template <class ConcreteMaterial>
const typename ConcreteMaterial::BxDF& GetBSDF(const ConcreteMaterial& material, ScratchBuffer& buffer) {
  auto* bxdf = buffer.Alloc<typename ConcreteMaterial::BxDF>();
  SampledWavelengths lambda;
  *bxdf = material.GetBxDF(TextureEvaluator{}, MaterialEvalContext{}, lambda);
  return *bxdf;
}

inline Float AbsCosTheta(Vector3f w) { return w.z < 0 ? -w.z : w.z; }

}  // namespace pbrt
