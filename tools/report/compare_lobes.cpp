#include "tools/report/compare_lobes.h"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>

#include <gonio/fitting/model/model.h>

namespace gonio {
namespace {

constexpr double last_angle = 70.5 * pi<double> / 180;

const MethodReport* find(const MaterialReport& material, const std::string& id) {
  for (const MethodReport& m : material.methods)
    if (m.id == id) return &m;
  return nullptr;
}

double cost(const MethodReport& method) { return method.ns.sample * mean_relvar(method); }

std::string number(double x, int digits = 2) {
  std::ostringstream text;
  if (x >= 10) {
    text << std::fixed << std::setprecision(0) << x;
  } else {
    text << std::setprecision(digits) << x;
  }
  return text.str();
}

/// A dash where nothing was measured.
std::string error_text(const nlohmann::json& error, int digits, double factor = 1) {
  return error.is_null() ? "–" : number(factor * error.get<double>(), digits);
}

/// To four digits, for reading.
std::string rounded(const std::string& description) {
  LobeModel model = parse_model(description);
  const auto round = [](glm::dvec3& v) {
    for (int c = 0; c < 3; ++c) {
      std::ostringstream text;
      text << std::setprecision(4) << v[c];
      v[c] = std::stod(text.str());
    }
  };
  for (Lobe& lobe : model.lobes) {
    for (glm::dvec3& v : lobe.shape) round(v);
    for (glm::dvec3& v : lobe.color) round(v);
  }
  return describe(model);
}

std::string times(double ratio) { return number(ratio) + "×"; }

}  // namespace

double mean_relvar(const MethodReport& method) {
  double sum = 0;
  int n = 0;
  for (const auto& q : method.angles) {
    if (q.theta_i > last_angle) continue;
    sum += q.relvar;
    ++n;
  }
  return sum / n;
}

std::optional<LobeComparison> compare_lobes(const MaterialReport& material) {
  const MethodReport* stack = find(material, "displacement");
  const MethodReport* small = find(material, "displacement_small");
  if (!stack || !small) return std::nullopt;
  std::optional<LobeComparison> best;
  for (const char* id : {"lobes1", "lobes2", "lobes3"}) {
    const MethodReport* lobes = find(material, id);
    if (!lobes) continue;
    LobeComparison c;
    c.lobes = id;
    c.samples = mean_relvar(*lobes) / mean_relvar(*stack);
    c.equal_time = cost(*lobes) / cost(*stack);
    c.equal_bytes = mean_relvar(*lobes) / mean_relvar(*small);
    c.enough = c.equal_time <= lobes_enough_factor || mean_relvar(*lobes) <= lobes_enough_relvar;
    if (!best || c.enough || c.equal_time < best->equal_time) best = c;
    if (c.enough) break;
  }
  return best;
}

nlohmann::json to_json(const LobeComparison& c) {
  return {{"lobes", c.lobes},
          {"samples_ratio", c.samples},
          {"equal_time_ratio", c.equal_time},
          {"equal_bytes_ratio", c.equal_bytes},
          {"enough", c.enough}};
}

void write_lobes(std::ostream& out, const MaterialReport& material) {
  if (const auto c = compare_lobes(material)) {
    const MethodReport &lobes = *find(material, c->lobes), &stack = *find(material, "displacement"),
                       &small = *find(material, "displacement_small");
    out << "\n**For this material a " << c->lobes.substr(5) << "-lobe GGX ";
    if (c->enough) {
      out << "is enough as a sampler.**";
    } else {
      out << "costs " << times(c->samples) << " the samples.**";
    }
    out << " Its relvar, the mean from 2° to 70°, is " << number(mean_relvar(lobes)) << "; that of `displacement` is "
        << number(mean_relvar(stack)) << ". At equal time it has " << times(c->equal_time) << " the variance ("
        << number(lobes.ns.sample) << " against " << number(stack.ns.sample)
        << " ns a sample), at equal bytes in memory " << times(c->equal_bytes) << " that of `displacement_small` ("
        << lobes.bytes << " against " << small.bytes << " bytes, relvar " << number(mean_relvar(small)) << ").";
    if (c->enough) {
      out << (c->equal_time <= lobes_enough_factor
                  ? " Enough means here: at equal time at most " + times(lobes_enough_factor) + " the variance.\n"
                  : " Enough means here: a relvar of at most " + number(lobes_enough_relvar) +
                        ", less than what light adds that varies over the hemisphere.\n");
    } else {
      out << '\n';
    }
  }
  if (material.fits.empty()) return;
  const nlohmann::json& errors = material.fits.back()["errors"]["inside_cutoff"];
  out << "\nIn place of the table, the fit with most lobes is off by " << error_text(errors["relative_l1"], 2, 100)
      << " % of the light and a mean ΔE of " << error_text(errors["delta_e_2000"], 2)
      << " inside the cut-off. More lobes never raise the cost of a fit; its errors, which weigh differently, may rise "
         "a "
         "little.\n";
  out << "\n| fitted model | RMS | log RMS | L1 | albedo | ΔE | RMS beyond | log RMS beyond | L1 "
         "beyond | albedo beyond | ΔE beyond |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const nlohmann::json& fit : material.fits) {
    out << "| `" << rounded(fit["model"].get<std::string>()) << '`';
    for (const char* part : {"inside_cutoff", "beyond_cutoff"}) {
      for (const char* key : {"cosine_rms", "log_rms", "relative_l1", "albedo", "delta_e_2000"})
        out << " | " << error_text(fit["errors"][part][key], 3);
    }
    out << " |\n";
  }
}

}  // namespace gonio
