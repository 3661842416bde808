#include "tools/measure/size_front.h"

#include <algorithm>
#include <cmath>

#include <gonio/brdf/build/compact/compact_quality.h>
#include <gonio/fitting/fit/brdf_function.h>
#include <gonio/fitting/sampling/lobe_sampler.h>

#include "tools/measure/timing.h"

namespace gonio {

FrontPoint front_point(const CompactFit& fit) {
  const Bsdf bsdf(fit.data);
  return {std::string("compact/") + to_string(bsdf.chart()), bsdf.bytes(),
          time_sampler(bsdf, TimedQueries(bsdf)).sample, fit.quality.worst_relvar, fit.quality.eval_error};
}

FrontPoint front_point(const std::shared_ptr<const BrdfTable>& table, const StageFit& stage) {
  const LobeModel& model = stage.fit.model;
  const LobeSampler sampler(table, model);
  const CompactDraws draws(*table, [&](float theta_i, float u, float v) {
    const auto s = sampler.sample({std::sin(theta_i), 0, std::cos(theta_i)}, {u, v});
    return s ? DirectionSample<float>{Vec3<float>(s->wo), s->pdf} : DirectionSample<float>{{0, 0, 1}, 0};
  });
  const BrdfFunction measured = measured_part(*table);
  const CompactQuality quality = draws.quality([&](float theta_i, const CompactDraw& d) {
    if (!(d.pdf > 0)) return glm::vec3(0);
    const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    if (std::isnan(measured(wi, d.wo).r)) return glm::vec3(std::nanf(""));
    return glm::vec3(model.eval(wi, d.wo)) * (d.wo.z / d.pdf);
  });
  return {"lobes" + std::to_string(model.specular_count()), sampler.bytes(),
          time_sampler(sampler, TimedQueries(sampler)).sample, quality.worst_relvar, quality.eval_error};
}

nlohmann::json front_json(std::vector<FrontPoint> points) {
  std::stable_sort(points.begin(), points.end(),
                   [](const FrontPoint& a, const FrontPoint& b) { return a.bytes < b.bytes; });
  nlohmann::json json = nlohmann::json::array();
  for (const FrontPoint& p : points) {
    const bool dominated = std::any_of(points.begin(), points.end(), [&](const FrontPoint& q) {
      const bool as_good = q.bytes <= p.bytes && q.ns <= p.ns && q.relvar <= p.relvar && q.eval_error <= p.eval_error;
      return as_good && (q.bytes < p.bytes || q.ns < p.ns || q.relvar < p.relvar || q.eval_error < p.eval_error);
    });
    json.push_back({{"id", p.id},
                    {"bytes", p.bytes},
                    {"ns", p.ns},
                    {"relvar", p.relvar},
                    {"eval_error", p.eval_error},
                    {"chosen", p.chosen},
                    {"on_front", !dominated}});
  }
  return json;
}

}  // namespace gonio
