#pragma once

// What docs/examples/pbrt_bxdf.h uses of pbrt-v4, as little as compiles: names and meanings of
// pbrt/base/bxdf.h and pbrt/util/vecmath.h, no code of theirs. Colours have three values here.

#include <array>
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

inline Float AbsCosTheta(Vector3f w) { return w.z < 0 ? -w.z : w.z; }

}  // namespace pbrt
