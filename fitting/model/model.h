#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/fitting/lobes/fresnel.h>
#include <gonio/fitting/lobes/visit.h>

namespace gonio {

/// How the reflectance of a specular lobe depends on the angle.
enum class Fresnel {
  schlick,   ///< color = {F0, F90}
  conductor  ///< color = {eta, k}
};

/// One parameter of a lobe: its name in descriptions and files, and the range a fit keeps it in.
struct Parameter {
  const char* name;
  const char* unit;
  double initial, min, max;
  bool logarithmic;  ///< searched on a logarithmic scale
};

/// What is known of a kind of lobe.
struct LobeInfo {
  const char* id;                ///< name in descriptions and files, for example "ggx"
  const char* source;            ///< paper and equation
  std::vector<Parameter> shape;  ///< at most max_shape
};

const LobeInfo& lobe_info(LobeKind kind) noexcept;

/// All kinds, in the order of the enumeration.
const std::vector<LobeKind>& lobe_kinds() noexcept;

/// The colour parameters: {albedo} for a diffuse lobe, {F0, F90} or {eta, k} for a specular one.
const std::vector<Parameter>& color_parameters(LobeKind kind, Fresnel fresnel) noexcept;

/// One lobe with its parameters, each per RGB channel (equal in all three where a fit shares them).
struct Lobe {
  LobeKind kind = LobeKind::lambert;
  Fresnel fresnel = Fresnel::schlick;
  std::array<glm::dvec3, max_shape> shape{};
  std::array<glm::dvec3, 2> color{};

  /// The lobe with every parameter at its initial value.
  static Lobe initial(LobeKind kind, Fresnel fresnel = Fresnel::schlick);

  bool specular() const noexcept { return is_specular(kind); }
  /// True if a shape parameter differs between channels.
  bool separate() const noexcept;
};

/// A sum of analytic lobes: f_r(wi, wo) = sum of albedo x diffuse lobe and F(cos_d) x specular
/// lobe.
///
/// Frame and f_r as in BrdfTable. Isotropic and reciprocal. The sum may reflect more than it
/// receives: a fit of a measurement that does must be able to follow it. Thread safety: const
/// members may be called concurrently.
struct LobeModel {
  std::string name;
  std::vector<Lobe> lobes;

  /// f_r in 1/sr per channel; 0 if either direction is at or below the horizon. No allocation.
  template <class S>
  glm::vec<3, S> eval(const glm::vec<3, S>& wi, const glm::vec<3, S>& wo) const noexcept;

  int specular_count() const noexcept;
};

/// Reads a description: lobes joined by `+`, each with optional parameters after a colon, as in
/// `ggx:alpha=0.2,F0=0.04+lambert:albedo=0.5/0.3/0.1`. A parameter that the lobe before the colon
/// does not have goes to the only lobe that has it, so `ggx+lambert:alpha=0.2,albedo=0.5` means the
/// same. Values are one number or red/green/blue; what is not given takes its initial value; `eta`
/// or `k` makes the lobe a conductor. Names are not case-sensitive. `default` is the project's own
/// material: a warm red-orange glossy paint.
/// @throws Error naming the part of the text that was not understood, and what was expected there.
LobeModel parse_model(std::string_view text);

/// The same model as a description that parse_model() reads back to the same bits.
std::string describe(const LobeModel& model);

/// The model as JSON: every parameter by name with its unit, the conventions, and the snippets of
/// pbrt_snippet() and mitsuba_snippet() where they exist.
std::string to_json(const LobeModel& model);

/// Reads what to_json() wrote; unknown members are ignored.
/// @param where file name for messages
/// @throws Error naming the member that is missing or out of range.
LobeModel model_from_json(std::string_view text, const std::string& where);

/// Reads a JSON file, such as the fit.json of `gonio fit`.
LobeModel load_model(const std::filesystem::path& path);

/// The nearest material of pbrt-v4, with what it does not reproduce in comments; empty if a lobe
/// has no counterpart there. Roughness is alpha itself ("remaproughness" false).
std::string pbrt_snippet(const LobeModel& model);

/// The nearest BSDF of Mitsuba 3 in its XML; empty if a lobe has no counterpart there. Roughness is
/// alpha.
std::string mitsuba_snippet(const LobeModel& model);

template <class S>
glm::vec<3, S> LobeModel::eval(const glm::vec<3, S>& wi, const glm::vec<3, S>& wo) const noexcept {
  glm::vec<3, S> sum(S(0));
  if (!(wi.z > S(0) && wo.z > S(0))) return sum;
  const Angles<S> angles(wi, wo);
  for (const Lobe& lobe : lobes) {
    const bool specular = lobe.specular();
    const bool shared = !lobe.separate();
    S value(0);
    for (int channel = 0; channel < 3; ++channel) {
      if (channel == 0 || !shared) {
        const S shape[max_shape] = {S(lobe.shape[0][channel]), S(lobe.shape[1][channel])};
        value = visit_lobe(lobe.kind, shape, [&](const auto& functor) { return functor.eval(angles); });
      }
      const S first = S(lobe.color[0][channel]), second = S(lobe.color[1][channel]);
      const S factor = !specular                          ? first
                       : lobe.fresnel == Fresnel::schlick ? schlick(first, second, angles.cos_d)
                                                          : conductor(first, second, angles.cos_d);
      sum[channel] += factor * value;
    }
  }
  return sum;
}

}  // namespace gonio
