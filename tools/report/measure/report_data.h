#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <gonio/brdf/proof/coherence.h>
#include <gonio/brdf/proof/measure.h>
#include <gonio/mapping/light/emission.h>

#include "tools/measure/timing.h"
#include "tools/report/measure/weights_figure.h"

namespace gonio {

/// One way of sampling one material, measured.
struct MethodReport {
  std::string id;         ///< one of those of docs/guide/report.md
  std::string chart;      ///< what the method's density is tabulated over; "none" if nothing is tabulated
  nlohmann::json params;  ///< what made it
  std::size_t bytes = 0;  ///< all memory that the sampler holds, the source table apart
  double build_seconds = 0;
  CallTimes ns{};
  std::optional<CallTimes> ns_batch{};  ///< per look-up of a batch; none for methods that have no batch form
  std::vector<proof::Quality> angles;
  proof::Coherence coherence;                       ///< at coherence_angle
  proof::Convergence convergence;                   ///< at coherence_angle
  nlohmann::json curves = nlohmann::json::array();  ///< method_curves() at curve_angles
};

struct MaterialReport {
  std::string name, source, format;
  std::uint64_t source_bytes = 0;
  std::vector<MethodReport> methods;
  nlohmann::json fits = nlohmann::json::array();    ///< of one, two and three lobes; empty for a stack file
  nlohmann::json curves = nlohmann::json::array();  ///< table_curves() at curve_angles
  nlohmann::json front = nlohmann::json::array();   ///< front_json() of stacks of several sizes and the fitted lobes
  std::string sha256{};                             ///< of the file
  std::vector<WeightRow> weights{};                 ///< of the continuous stacks, for the figure; not part of the JSON
  std::optional<Stack<float>> stack{};              ///< of `displacement`, for the figure; not part of the JSON
};

/// The emission of one luminaire, sampled by every method.
struct LightReport {
  std::string name, source, format;
  std::uint64_t source_bytes = 0;
  std::string sha256;
  double flux;  ///< [lm], by quadrature of the bilinear diagram
  std::vector<EmissionQuality> methods;
};

struct Machine {
  std::string cpu, compiler;
  unsigned threads;
};

struct Report {
  Machine machine;
  std::string command{};  ///< what made it, as typed
  std::vector<MaterialReport> materials;
  std::vector<LightReport> lights;
  nlohmann::json stability = nullptr;  ///< of `gonio stability`, if it was given
};

/// The incident angles of every report, in degrees.
inline constexpr double report_angles[] = {2, 10, 30, 50, 70, 80, 85};

/// The incident angle at which coherence and convergence are measured, in degrees.
inline constexpr double coherence_angle = 40;

/// The significance of one chi-square test such that a whole report of correct samplers passes with
/// probability 0.99.
double report_significance(const Report& report);

}  // namespace gonio
