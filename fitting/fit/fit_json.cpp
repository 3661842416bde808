#include <gonio/fitting/fit/fit_json.h>
#include <gonio/fitting/model/model_json.h>

namespace gonio {
namespace {

nlohmann::ordered_json errors_json(const FitErrors& errors) {
  return {{"cosine_rms", errors.cosine_rms},
          {"log_rms", errors.log_rms},
          {"relative_l1", errors.relative_l1},
          {"albedo", errors.albedo},
          {"delta_e_2000", errors.delta_e}};
}

}  // namespace

std::string to_json(const Fit& fit, const FitErrorReport& errors) {
  nlohmann::ordered_json j = detail::model_json(fit.model);
  const FitSummary& s = fit.summary;
  nlohmann::ordered_json spread = nlohmann::ordered_json::object();
  for (const ParameterSpread& p : s.parameters) spread[p.name] = {{"min", p.min}, {"max", p.max}};
  j["fit"] = {{"termination", to_string(s.termination)},
              {"iterations", s.iterations},
              {"initial_cost", s.initial_cost},
              {"cost", s.cost},
              {"samples", s.samples},
              {"costs_of_starts", s.costs},
              {"agreeing_starts", s.agreeing_starts},
              {"spread_of_agreeing_starts", spread}};
  j["errors"] = {{"units",
                  {{"cosine_rms", "1/sr"},
                   {"log_rms", "natural logarithm"},
                   {"relative_l1", "1"},
                   {"albedo", "1"},
                   {"delta_e_2000", "CIEDE2000"}}},
                 {"inside_cutoff", errors_json(errors.inside)},
                 {"beyond_cutoff", errors_json(errors.beyond)}};
  return j.dump(2) + "\n";
}

}  // namespace gonio
