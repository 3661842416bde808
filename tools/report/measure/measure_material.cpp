#include "tools/report/measure/measure_material.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <mutex>
#include <set>
#include <thread>
#include <type_traits>

#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/fitting/fit/fit_json.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>

#include "tools/cli/input.h"
#include "tools/measure/size_front.h"
#include "tools/measure/table_fits.h"
#include "tools/measure/timing.h"
#include "tools/report/measure/curves.h"

namespace gonio {
namespace {

constexpr double compact_variance = 0.01;  // relvar of the method `compact`

nlohmann::json stack_params(const BsdfData& data) {
  std::size_t crossings = 0, meridians = 0, parallels = 0;
  for (const DiagramGrid& d : data.diagrams.diagrams) {
    meridians = std::max(meridians, d.phi.size());
    parallels = std::max(parallels, d.r.size());
    crossings += d.phi.size() * d.r.size();
  }
  nlohmann::json params = {{"incident", data.diagrams.theta_i.size()},
                           {"largest_meridians", meridians},
                           {"largest_parallels", parallels},
                           {"mean_crossings", crossings / data.diagrams.theta_i.size()}};
  if (!data.colour.empty()) {
    params["colour_cells"] = data.colour.side() * (data.colour.side() / 2);
    params["colour_angles"] = data.colour.theta_i().size();
  }
  return params;
}

/// A BSDF with colours of its own as what it is worth to its table: directions and pdf are its own, f_r is the table's.
struct AgainstTable {
  std::shared_ptr<const BrdfTable> table;
  Bsdf bsdf;

  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const {
    auto s = bsdf.sample(wi, u);
    if (s) s->weight = table->eval(wi, s->wo) * (s->wo.z / s->pdf);
    return s;
  }
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const { return bsdf.pdf(wi, wo); }
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const { return table->eval(wi, wo); }
};

/// Collects what is to be measured; the samplers live in the closures.
class Bench {
 public:
  template <class S>
  void add(std::string id, std::string chart, nlohmann::json params, double build_seconds,
           std::shared_ptr<const S> sampler) {
    const S& timed = *sampler;
    add(std::move(id), std::move(chart), std::move(params), build_seconds, timed, std::move(sampler));
  }

  /// The same, with times and bytes of another than is measured.
  template <class Timed, class S>
  void add(std::string id, std::string chart, nlohmann::json params, double build_seconds, const Timed& timed,
           std::shared_ptr<const S> sampler) {
    MethodReport method;
    method.id = std::move(id);
    method.chart = std::move(chart);
    method.params = std::move(params);
    method.bytes = timed.bytes();
    method.build_seconds = build_seconds;
    const TimedQueries queries(timed);
    method.ns = time_sampler(timed, queries);
    if constexpr (std::is_same_v<Timed, Bsdf>) method.ns_batch = time_batch(timed, queries);
    methods_.push_back(std::move(method));
    subjects_.push_back(proof::subject_of(*sampler));
    owners_.push_back(std::move(sampler));
  }

  /// Measures all methods into the material, and their curves.
  void run(MaterialReport& material, const Progress& progress) {
    constexpr std::size_t angles = std::size(report_angles), sections = std::size(curve_angles);
    // What belongs to the table is the same for all methods.
    glm::dvec3 albedo[angles];
    parallel_for(angles,
                 [&](std::size_t k) { albedo[k] = proof::albedo(subjects_.front(), radians(report_angles[k])); });
    std::vector<nlohmann::json> sections_of_table(sections);
    for (std::size_t k = 0; k < sections; ++k) {
      const auto at =
          std::find(std::begin(report_angles), std::end(report_angles), curve_angles[k]) - std::begin(report_angles);
      const double reflected = static_cast<double>(luminance(glm::vec3(albedo[at])));
      sections_of_table[k] = table_curves(subjects_.front(), curve_angles[k], reflected);
      for (nlohmann::json& fit : material.fits)
        fit["curves"].push_back(model_curves(parse_model(fit["model"].get<std::string>()), curve_angles[k],
                                             sections_of_table[k]["theta_o_deg"], reflected));
    }

    std::vector<std::function<void()>> jobs;  // the longest first, or they would end alone
    const auto add_jobs = [&](std::size_t count, const auto& job) {
      for (std::size_t m = 0; m < methods_.size(); ++m)
        for (std::size_t k = 0; k < count; ++k) jobs.push_back([=] { job(m, k); });
    };
    add_jobs(1, [&](std::size_t m, std::size_t) {
      methods_[m].convergence = proof::measure_convergence(subjects_[m], radians(coherence_angle));
    });
    add_jobs(angles, [&](std::size_t m, std::size_t k) {
      proof::MeasureOptions options;
      options.albedo_table = albedo[k];
      methods_[m].angles[k] = proof::measure(subjects_[m], radians(report_angles[k]), options);
    });
    add_jobs(1, [&](std::size_t m, std::size_t) {
      methods_[m].coherence = proof::measure_coherence(subjects_[m], radians(coherence_angle));
    });
    std::vector<std::vector<nlohmann::json>> curves(methods_.size(), std::vector<nlohmann::json>(sections));
    add_jobs(sections, [&](std::size_t m, std::size_t k) {
      curves[m][k] =
          method_curves(subjects_[m], curve_angles[k], sections_of_table[k]["theta_o_deg"], has_grid(methods_[m].id));
    });
    std::vector<WeightRow> weights(methods_.size());
    add_jobs(angles, [&](std::size_t m, std::size_t k) {
      if (!weights[m].maps.empty()) weights[m].maps[k] = weight_map(subjects_[m], radians(report_angles[k]));
    });
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      methods_[m].angles.resize(angles);
      if (methods_[m].id == "displacement" || methods_[m].id == "blend") weights[m].maps.resize(angles);
    }

    std::mutex mutex;
    std::size_t done = 0;
    parallel_for(jobs.size(), [&](std::size_t job) {
      jobs[job]();
      const std::lock_guard<std::mutex> lock(mutex);
      progress(static_cast<double>(++done) / static_cast<double>(jobs.size()));
    });

    material.curves = sections_of_table;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      methods_[m].curves = curves[m];
      if (weights[m].maps.empty()) continue;
      weights[m].name = methods_[m].id + " / " + methods_[m].chart;
      for (const proof::Quality& q : methods_[m].angles) weights[m].relvar.push_back(q.relvar);
      material.weights.push_back(std::move(weights[m]));
    }
    material.methods = std::move(methods_);
  }

 private:
  static double radians(double degrees) { return degrees * pi<double> / 180; }

  /// Grids are most of the page's bytes; those of some methods say little.
  static bool has_grid(const std::string& id) {
    static const std::set<std::string> without{"uniform", "cosine", "nearest",           "lobes1",
                                               "lobes2",  "lobes3", "displacement_small"};
    return without.count(id) == 0;
  }

  std::vector<MethodReport> methods_;
  std::vector<proof::Subject> subjects_;
  std::vector<std::shared_ptr<const void>> owners_;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Adds the fits to the report and their samplers, lobes1 to lobes3, to the bench. Returns the
/// bytes of the largest of them; 0 if there is nothing to fit, the table being black.
std::size_t add_lobes(const std::shared_ptr<const BrdfTable>& table, MaterialReport& material, Bench& bench,
                      std::vector<FrontPoint>& points) {
  TableFits fits;
  try {
    fits = fit_table(*table, parse_model(default_fit_form));
  } catch (const Error&) {
    return 0;
  }
  std::size_t bytes = 0;
  for (StageFit& stage : fits.stages) {
    stage.fit.model.name.clear();  // that of a file, which need not be UTF-8 as JSON is
    const LobeModel& model = stage.fit.model;
    const nlohmann::json written = nlohmann::json::parse(to_json(stage.fit, stage.errors));
    points.push_back(front_point(table, stage));
    material.fits.push_back({{"model", describe(model)},
                             {"parameters", written["lobes"]},
                             {"fit", written["fit"]},
                             {"errors", written["errors"]}});
    const nlohmann::json params = {{"model", describe(model)}, {"adaption", "shapes"}, {"fit_seconds", fits.seconds}};
    const auto start = Clock::now();
    const auto sampler = std::make_shared<const LobeSampler>(table, model);
    bench.add<LobeSampler>("lobes" + std::to_string(model.specular_count()), "none", params, seconds_since(start),
                           sampler);
    bytes = std::max(bytes, sampler->bytes());
  }
  return bytes;
}

/// A stack of about that many bytes: at least seven angles, with as many lines as fit.
void add_small_stack(const std::shared_ptr<const BrdfTable>& table, std::size_t bytes, Bench& bench) {
  const auto start = Clock::now();
  std::shared_ptr<const Bsdf> bsdf;
  BsdfData kept;
  for (const int side : {4, 5, 6, 8, 12, 16}) {  // upwards: those that do not fit take longest to build
    if (bsdf && bsdf->bytes() > bytes) break;
    BsdfOptions options;
    options.interpolation = Interpolation::displacement;
    options.meridians = options.parallels = side;
    options.budget = bytes;
    BsdfData data{build_stack(*table, options), options.interpolation, {}};
    const auto larger = std::make_shared<const Bsdf>(data, table);
    if (bsdf && larger->bytes() > bytes) break;
    bsdf = larger, kept = std::move(data);
  }
  bench.add<Bsdf>("displacement_small", "outgoing", stack_params(kept), seconds_since(start), bsdf);
}

/// What make_bsdf() does by default, but that a colour is fitted, too, and the smallest BSDF with colours of its own of
/// ten times the variance. Everything that was measured on the way becomes a point.
void add_compact(const std::shared_ptr<const BrdfTable>& table, Bench& bench, std::vector<FrontPoint>& points,
                 const Progress& progress) {
  const auto add_points = [&](const CompactChoice& choice, bool chosen) {
    for (std::size_t k = 0; k < choice.tried.size(); ++k) {
      points.push_back(front_point(choice.tried[k]));
      points.back().chosen = chosen && k == choice.chosen;
    }
  };
  auto start = Clock::now();
  const CompactChoice fine = fit_compact(*table, {}, [&](double done) { progress(done / 2); });
  BsdfData without_colour = fine.best().data;
  without_colour.colour = {};
  const auto bsdf = std::make_shared<const Bsdf>(without_colour, table);
  nlohmann::json params = stack_params(without_colour);
  params["default"] = true;
  bench.add<Bsdf>("blend", to_string(bsdf->chart()), params, seconds_since(start), bsdf);
  add_points(fine, false);

  start = Clock::now();
  BsdfOptions options;
  options.max_variance = compact_variance;
  const CompactChoice small = fit_compact(*table, options, [&](double done) { progress(0.5 + done / 2); });
  const CompactFit& best = small.best();
  const auto compact = std::make_shared<const AgainstTable>(AgainstTable{table, Bsdf(best.data)});
  params = stack_params(best.data);
  params["eval_error"] = best.quality.eval_error;
  params["albedo_error"] = best.quality.albedo_error;
  bench.add<Bsdf, AgainstTable>("compact", to_string(best.data.diagrams.chart), params, seconds_since(start),
                                compact->bsdf, compact);
  add_points(small, true);
}

MaterialReport measure_stack_file(const std::filesystem::path& path, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const StackFile file = load_stack(path);
  MaterialReport material{file.name, path.string(), "stack", std::filesystem::file_size(path), {}};
  nlohmann::json params = stack_params(file.bsdf);
  params["self_contained"] = true;
  Bench bench;
  const auto add = [&](auto bsdf) {
    using Held = decltype(bsdf);
    const std::chrono::duration<double> build = std::chrono::steady_clock::now() - start;
    bench.add<Held>(to_string(file.bsdf.interpolation), to_string(file.bsdf.diagrams.chart), params, build.count(),
                    std::make_shared<const Held>(std::move(bsdf)));
  };
  if (file.bsdf.interpolation == Interpolation::mixture)
    add(StackBsdf(file.bsdf));
  else
    add(to_bsdf(file, path));
  bench.run(material, progress);
  material.stack.emplace(file.bsdf.diagrams, file.bsdf.interpolation);
  return material;
}

}  // namespace

MaterialReport measure_material(const std::filesystem::path& path, const ReportOptions& options,
                                const Progress& progress) {
  if (is_exr(path)) return measure_stack_file(path, progress);
  const auto table = std::make_shared<const BrdfTable>(load_input(path, options.policies));
  MaterialReport material{
      table->info().name, table->info().source, table->info().format, table->info().source_bytes, {}};

  constexpr double building = 0.4;  // its share of the progress
  const auto start = std::chrono::steady_clock::now();
  const StackGrid grid = build_stack(*table, options.stack, [&](double done) { progress(building / 3 * done); });
  const std::chrono::duration<double> build = std::chrono::steady_clock::now() - start;

  Bench bench;
  const nlohmann::json none = nlohmann::json::object();
  bench.add<UniformSampler>("uniform", "none", none, 0, std::make_shared<const UniformSampler>(table));
  bench.add<CosineSampler>("cosine", "none", none, 0, std::make_shared<const CosineSampler>(table));
  if (std::holds_alternative<RglTable>(table->data()))
    bench.add<RglSampler>("rgl", "half", none, 0, std::make_shared<const RglSampler>(table));
  for (const Interpolation interpolation :
       {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement}) {
    const BsdfData data{grid, interpolation, {}};
    if (interpolation == Interpolation::mixture)
      bench.add<StackBsdf>("mixture", "outgoing", stack_params(data), build.count(),
                           std::make_shared<const StackBsdf>(data, table));
    else
      bench.add<Bsdf>(to_string(interpolation), "outgoing", stack_params(data), build.count(),
                      std::make_shared<const Bsdf>(data, table));
  }
  std::vector<FrontPoint> points;
  add_compact(table, bench, points, [&](double done) { progress(building * (1 + 2 * done) / 3); });
  if (const std::size_t bytes = add_lobes(table, material, bench, points); bytes > 0)
    add_small_stack(table, bytes, bench);
  bench.run(material, [&](double done) { progress(building + (1 - building) * done); });
  material.front = front_json(points);
  material.stack.emplace(grid, Interpolation::displacement);
  return material;
}

Machine this_machine() {
  Machine machine{"unknown", "unknown", std::max(1u, std::thread::hardware_concurrency())};
#if defined(__clang__)
  machine.compiler = "Clang " __clang_version__;
#elif defined(__GNUC__)
  machine.compiler = "GCC " __VERSION__;
#endif
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    machine.cpu = line.substr(line.find(':') + 2);
    break;
  }
  return machine;
}

}  // namespace gonio
