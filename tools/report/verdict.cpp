#include "tools/report/verdict.h"

#include <iomanip>
#include <sstream>

#include "tools/report/compare_lobes.h"

namespace gonio {
namespace {

std::string number(double x) {
  std::ostringstream text;
  if (x >= 10) {
    text << std::fixed << std::setprecision(0) << x;
  } else {
    text << std::setprecision(2) << x;
  }
  return text.str();
}

const MethodReport* best_but(const MaterialReport& material, const MethodReport* excluded) {
  const MethodReport* best = nullptr;
  for (const MethodReport& m : material.methods)
    if (&m != excluded && (!best || efficiency(m) > efficiency(*best))) best = &m;
  return best;
}

}  // namespace

double efficiency(const MethodReport& method) { return 1 / (method.ns.sample * (mean_relvar(method) + 0.001)); }

const MethodReport* best_method(const MaterialReport& material) { return best_but(material, nullptr); }

std::string title(const MethodReport& method) {
  return method.chart == "none" ? method.id : method.id + " (" + method.chart + ")";
}

std::string verdict(const MaterialReport& material) {
  const MethodReport* best = best_method(material);
  if (!best) return "";
  std::ostringstream text;
  if (material.methods.size() == 1) {
    text << "One method, " << title(*best) << ": " << number(best->ns.sample) << " ns a sample, mean relative variance "
         << number(mean_relvar(*best)) << ".";
    return text.str();
  }
  const MethodReport* next = best_but(material, best);
  text << "Sample it with " << title(*best) << ": " << number(best->ns.sample)
       << " ns a sample, mean relative variance " << number(mean_relvar(*best)) << ", "
       << number(efficiency(*best) / efficiency(*next)) << "× as efficient as the next best, " << title(*next) << ".";
  const auto lobes = compare_lobes(material);
  if (lobes && lobes->enough) {
    text << " A fit of " << lobes->lobes.substr(5) << " GGX lobes is enough as a sampler.";
  } else if (lobes) {
    text << " Fitted lobes are not enough: the best, " << lobes->lobes << ", needs " << number(lobes->samples)
         << "× the samples of displacement, and at equal time has " << number(lobes->equal_time) << "× its variance.";
  }
  return text.str();
}

}  // namespace gonio
