#include <gonio/tools/report/measure_material.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <thread>

#include <gonio/tools/report/curves.h>
#include <gonio/tools/report/timing.h>

#include <gonio/brdf/baseline.h>
#include <gonio/brdf/choose_stack.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/parallel.h>
#include <gonio/fitting/fit_json.h>
#include <gonio/fitting/lobe_sampler.h>
#include <gonio/mapping/error.h>
#include <gonio/tools/input.h>
#include <gonio/tools/table_fits.h>

namespace gonio {
namespace {

nlohmann::json stack_params(const Stack<float>& stack) {
  std::size_t crossings = 0;
  int meridians = 0, parallels = 0;
  for (const auto& d : stack.diagrams()) {
    meridians = std::max(meridians, d.meridians());
    parallels = std::max(parallels, d.parallels());
    crossings += static_cast<std::size_t>(d.meridians() * d.parallels());
  }
  return {{"incident", stack.theta_i().size()},
          {"largest_meridians", meridians},
          {"largest_parallels", parallels},
          {"mean_crossings", crossings / stack.theta_i().size()}};
}

/// Collects what is to be measured; the samplers live in the closures.
class Bench {
 public:
  template <class S>
  void add(std::string id, std::string chart, nlohmann::json params, double build_seconds, std::shared_ptr<const S> sampler) {
    MethodReport method;
    method.id = std::move(id);
    method.chart = std::move(chart);
    method.params = std::move(params);
    method.bytes = sampler->bytes();
    method.build_seconds = build_seconds;
    method.ns = time_sampler(*sampler);
    methods_.push_back(std::move(method));
    subjects_.push_back(proof::subject_of(*sampler));
    owners_.push_back(std::move(sampler));
  }

  /// Measures all methods into the material, and then the curves.
  void run(MaterialReport& material, const Progress& progress) {
    constexpr std::size_t angles = std::size(report_angles);
    std::mutex mutex;
    std::size_t done = 0;
    for (MethodReport& m : methods_) m.angles.resize(angles);
    // For each method its angles, and coherence as one more.
    const std::size_t jobs = methods_.size() * (angles + 1);
    parallel_for(jobs, [&](std::size_t job) {
      const std::size_t m = job / (angles + 1), k = job % (angles + 1);
      const double theta_i = (k < angles ? report_angles[k] : coherence_angle) * pi<double> / 180;
      if (k < angles) {
        methods_[m].angles[k] = proof::measure(subjects_[m], theta_i);
      } else {
        methods_[m].coherence = proof::measure_coherence(subjects_[m], theta_i);
        methods_[m].convergence = proof::measure_convergence(subjects_[m], theta_i);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      progress(static_cast<double>(++done) / static_cast<double>(jobs));
    });
    add_curves(material);
    material.methods = std::move(methods_);
  }

 private:
  void add_curves(MaterialReport& material) {
    // Grids are most of the page's bytes; those of these say little.
    static const std::set<std::string> no_grid{"uniform", "cosine", "nearest", "lobes1", "lobes2", "lobes3", "displacement_small"};
    for (const double theta_i : curve_angles) {
      const auto k = std::find(std::begin(report_angles), std::end(report_angles), theta_i) - std::begin(report_angles);
      const double albedo = static_cast<double>(luminance(glm::vec3(methods_.front().angles[static_cast<std::size_t>(k)].albedo_table)));
      material.curves.push_back(table_curves(subjects_.front(), theta_i, albedo));
      const nlohmann::json& theta_o = material.curves.back()["theta_o_deg"];
      std::vector<nlohmann::json> curves(methods_.size());
      parallel_for(methods_.size(), [&](std::size_t m) {
        curves[m] = method_curves(subjects_[m], theta_i, theta_o, no_grid.count(methods_[m].id) == 0);
      });
      for (std::size_t m = 0; m < methods_.size(); ++m) methods_[m].curves.push_back(std::move(curves[m]));
    }
  }

  std::vector<MethodReport> methods_;
  std::vector<proof::Subject> subjects_;
  std::vector<std::shared_ptr<const void>> owners_;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Adds the fits to the report and their samplers, lobes1 to lobes3, to the bench. Returns the
/// bytes of the largest of them; 0 if there is nothing to fit, the table being black.
std::size_t add_lobes(const std::shared_ptr<const BrdfTable>& table, MaterialReport& material, Bench& bench) {
  TableFits fits;
  try {
    fits = fit_table(*table, parse_model(default_fit_form));
  } catch (const Error&) {
    return 0;
  }
  std::size_t bytes = 0;
  for (const StageFit& stage : fits.stages) {
    const LobeModel& model = stage.fit.model;
    const nlohmann::json written = nlohmann::json::parse(to_json(stage.fit, stage.errors));
    material.fits.push_back({{"model", describe(model)}, {"parameters", written["lobes"]}, {"fit", written["fit"]}, {"errors", written["errors"]}});
    const nlohmann::json params = {{"model", describe(model)}, {"adaption", "shapes"}, {"fit_seconds", fits.seconds}};
    const auto start = Clock::now();
    const auto sampler = std::make_shared<const LobeSampler>(table, model);
    bench.add<LobeSampler>("lobes" + std::to_string(model.specular_count()), "none", params, seconds_since(start), sampler);
    bytes = std::max(bytes, sampler->bytes());
  }
  return bytes;
}

/// A stack of about that many bytes: at least seven angles, with as many lines as fit.
void add_small_stack(const std::shared_ptr<const BrdfTable>& table, std::size_t bytes, Bench& bench) {
  const auto start = Clock::now();
  std::shared_ptr<const Sampler> sampler;
  for (const int side : {4, 5, 6, 8, 12, 16}) {  // upwards: those that do not fit take longest to build
    StackOptions options;
    options.meridians = options.parallels = side;
    options.bytes = bytes;
    const auto larger = std::make_shared<const Sampler>(table, build_stack(*table, options));
    if (sampler && larger->bytes() > bytes) break;
    sampler = larger;
  }
  bench.add<Sampler>("displacement_small", "outgoing", stack_params(sampler->stack()), seconds_since(start), sampler);
}

/// The half-vector chart, with both continuous interpolations, at the limits of the other stacks.
void add_half_stacks(const std::shared_ptr<const BrdfTable>& table, StackOptions options, Bench& bench,
                     const Progress& progress) {
  options.chart = Chart::half;
  double before = 0;
  for (const Interpolation interpolation : {Interpolation::displacement, Interpolation::blend}) {
    options.interpolation = interpolation;
    const auto start = Clock::now();
    const auto sampler = std::make_shared<const Sampler>(table, options, [&](double done) { progress(before + done / 2); });
    bench.add<Sampler>(to_string(interpolation), "half", stack_params(sampler->stack()), seconds_since(start), sampler);
    before += 0.5;
  }
}

/// Says in the params which stack `gonio convert --chart auto` takes: the one with the smaller mean
/// relvar at rating_angles.
void mark_choice(std::vector<MethodReport>& methods) {
  MethodReport* best = nullptr;
  double least = 0;
  for (MethodReport& m : methods) {
    const bool candidate = (m.id == "displacement" && m.chart == "outgoing") || (m.id == "blend" && m.chart == "half");
    if (!candidate) continue;
    double mean = 0;
    for (const auto& q : m.angles)
      if (q.theta_i < 80.5 * pi<double> / 180) mean += q.relvar / std::size(rating_angles);
    m.params["mean_relvar"] = mean;
    m.params["chart_auto"] = false;
    if (!best || mean < least) best = &m, least = mean;
  }
  if (best) best->params["chart_auto"] = true;
}

MaterialReport measure_stack_file(const std::filesystem::path& path, const Progress& progress) {
  const StackFile file = load_stack(path);
  MaterialReport material{file.name, path.string(), "stack", std::filesystem::file_size(path), {}};
  const auto start = std::chrono::steady_clock::now();
  const auto sampler = std::make_shared<const Sampler>(load_sampler(path));
  const std::chrono::duration<double> build = std::chrono::steady_clock::now() - start;
  nlohmann::json params = stack_params(sampler->stack());
  params["self_contained"] = true;
  Bench bench;
  bench.add<Sampler>(to_string(file.interpolation), to_string(file.diagrams.chart), params, build.count(), sampler);
  bench.run(material, progress);
  material.stack = sampler->stack();
  return material;
}

}  // namespace

MaterialReport measure_material(const std::filesystem::path& path, const ReportOptions& options,
                                const Progress& progress) {
  if (is_exr(path)) return measure_stack_file(path, progress);
  const auto table = std::make_shared<const BrdfTable>(load_input(path, options.policies));
  MaterialReport material{table->info().name, table->info().source, table->info().format, table->info().source_bytes, {}};

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
  for (const Interpolation interpolation : {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement}) {
    const auto sampler = std::make_shared<const Sampler>(table, grid, interpolation);
    bench.add<Sampler>(to_string(interpolation), "outgoing", stack_params(sampler->stack()), build.count(), sampler);
  }
  add_half_stacks(table, options.stack, bench, [&](double done) { progress(building * (1 + 2 * done) / 3); });
  if (const std::size_t bytes = add_lobes(table, material, bench); bytes > 0)
    add_small_stack(table, bytes, bench);
  bench.run(material, [&](double done) { progress(building + (1 - building) * done); });
  mark_choice(material.methods);
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
