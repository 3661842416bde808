#include <gonio/fitting/model.h>
#include <gonio/tools/report/compare_lobes.h>

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>

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
  const MethodReport* best = nullptr;
  for (const char* id : {"lobes1", "lobes2", "lobes3"}) {
    const MethodReport* lobes = find(material, id);
    if (lobes && (!best || cost(*lobes) < cost(*best))) best = lobes;
  }
  if (!stack || !small || !best) return std::nullopt;
  LobeComparison c;
  c.lobes = best->id;
  c.samples = mean_relvar(*best) / mean_relvar(*stack);
  c.equal_time = cost(*best) / cost(*stack);
  c.equal_bytes = mean_relvar(*best) / mean_relvar(*small);
  c.enough = c.equal_time <= lobes_enough_factor || mean_relvar(*best) <= lobes_enough_relvar;
  return c;
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
    const MethodReport &best = *find(material, c->lobes), &stack = *find(material, "displacement"),
                       &small = *find(material, "displacement_small");
    const std::string lobes = c->lobes.substr(5) + "-lobe GGX";
    out << "\n**As a sampler, ";
    if (c->enough) {
      out << "for this material a " << lobes << " is enough**";
    } else {
      out << "for this material a " << lobes << " costs " << times(c->samples) << " the samples**";
    }
    out << ": mean relvar from 2° to 70° is " << number(mean_relvar(best)) << " (`" << c->lobes
        << "`, " << number(best.ns.sample) << " ns, " << best.bytes << " bytes) against "
        << number(mean_relvar(stack)) << " (`displacement`, " << number(stack.ns.sample) << " ns, "
        << stack.bytes << " bytes): " << times(c->samples)
        << " the samples for equal noise. At equal time the lobes have " << times(c->equal_time)
        << " the variance; at about equal bytes, against a stack of " << small.bytes << " bytes, "
        << times(c->equal_bytes) << ".\n";
  }
  if (material.fits.empty()) return;
  out << "\n| fitted model | RMS | log RMS | L1 | albedo | ΔE | RMS beyond | log RMS beyond | L1 "
         "beyond | albedo beyond | ΔE beyond |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const nlohmann::json& fit : material.fits) {
    out << "| `" << rounded(fit["model"].get<std::string>()) << '`';
    for (const char* part : {"inside_cutoff", "beyond_cutoff"}) {
      for (const char* key : {"cosine_rms", "log_rms", "relative_l1", "albedo", "delta_e_2000"})
        out << " | " << number(fit["errors"][part][key].get<double>(), 3);
    }
    out << " |\n";
  }
}

}  // namespace gonio
