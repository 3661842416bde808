#include "tools/render/compare/compare_runs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>

#include <gonio/mapping/base/error.h>

#include "tools/render/image/difference.h"

namespace gonio {
namespace {

constexpr double slice = 0.1;  // processor seconds of a turn

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A render with the time it has used.
class Timed {
 public:
  Timed(const Scene& scene, const RenderOptions& options, const std::shared_ptr<const World>& world)
      : film_(scene, options, world) {}

  /// At most a slice, and no further than the next power of two.
  void go_on() {
    const int samples = film_.samples();
    int next = 1;
    while (next <= samples) next *= 2;
    const double each = samples > 0 ? seconds_ / samples : slice;
    const int count = std::clamp(static_cast<int>(slice / each), 1, next - samples);
    const double start = processor_seconds();
    film_.add_samples(count);
    seconds_ += processor_seconds() - start;
  }
  /// Whether less than half of another sample fits.
  bool done(double budget) const { return film_.samples() > 0 && seconds_ + 0.5 * seconds_ / film_.samples() > budget; }
  bool at_power_of_two() const { return (film_.samples() & (film_.samples() - 1)) == 0; }
  double seconds() const { return seconds_; }
  const Film& film() const { return film_; }

 private:
  Film film_;
  double seconds_ = 0;
};

/// The values of another material, drawn in proportion to the cosine.
class CosineDrawn {
 public:
  explicit CosineDrawn(std::shared_ptr<const Scatter> values) : values_(std::move(values)) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
    auto s = cosine_.sample(wi, u);
    if (s) s->weight = values_->eval(wi, s->wo) * pi<float>;
    return s;
  }
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return cosine_.pdf(wi, wo); }
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return values_->eval(wi, wo); }

 private:
  std::shared_ptr<const Scatter> values_;
  LambertSampler cosine_{glm::vec3(1)};
};

/// The scenes with the compared materials sampled by each method.
class Variants {
 public:
  explicit Variants(const Scene& scene) : scene_(scene), compared_(compared_materials(scene)) {
    for (const std::size_t k : compared_) {
      const Material& m = scene.materials[k];
      builders_.push_back(m.table ? std::make_unique<MethodBuilder>(m.table, m.model) : nullptr);
    }
  }
  Scene make(SamplingMethod method) {
    Scene scene = scene_;
    for (std::size_t k = 0; k < compared_.size(); ++k) {
      std::shared_ptr<const Scatter>& bsdf = scene.materials[compared_[k]].bsdf;
      if (builders_[k])
        bsdf = builders_[k]->build(method);
      else if (method == SamplingMethod::cosine)
        bsdf = make_scatter(CosineDrawn(bsdf));
    }
    return scene;
  }

 private:
  const Scene& scene_;
  std::vector<std::size_t> compared_;
  std::vector<std::unique_ptr<MethodBuilder>> builders_;  // of each of those; none for a stack file
};

std::vector<std::size_t> compared_pixels(const Scene& scene, const std::shared_ptr<const World>& world) {
  const PathTracer tracer(scene, Strategy::mis, 0, world);
  const std::vector<std::size_t> compared = compared_materials(scene);
  std::vector<std::size_t> pixels;
  for (int y = 0; y < scene.camera.height; ++y)
    for (int x = 0; x < scene.camera.width; ++x) {
      const auto object = tracer.first_object(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      if (object && std::find(compared.begin(), compared.end(), scene.objects[*object].material) != compared.end())
        pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.camera.width) +
                         static_cast<std::size_t>(x));
    }
  return pixels;
}

RgbImage mean_of(RgbImage a, const RgbImage& b) {
  for (std::size_t k = 0; k < a.pixels.size(); ++k) a.pixels[k] = 0.5f * (a.pixels[k] + b.pixels[k]);
  return a;
}

}  // namespace

std::vector<std::size_t> compared_materials(const Scene& scene) {
  std::vector<std::size_t> tables, stacks;
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    if (scene.materials[k].table) tables.push_back(k);
    if (scene.materials[k].stack) stacks.push_back(k);
  }
  return tables.empty() ? stacks : tables;
}

bool method_available(const Scene& scene, SamplingMethod method) {
  const std::vector<std::size_t> compared = compared_materials(scene);
  return std::all_of(compared.begin(), compared.end(), [&](std::size_t k) {
    const Material& m = scene.materials[k];
    return m.table ? MethodBuilder(m.table, m.model).available(method)
                   : method == SamplingMethod::automatic || method == SamplingMethod::cosine;
  });
}

Comparison compare_methods(const Scene& scene, const CompareOptions& options, const Progress& progress) {
  const auto world = std::make_shared<const World>(scene);
  const std::vector<std::size_t> pixels = compared_pixels(scene, world);
  if (pixels.size() < 2) throw Error("scene: found no pixels that show a table or a stack file, expected some");
  const double total = options.reference_seconds + options.seconds * 2 * static_cast<double>(options.methods.size());
  double used = 0;
  const auto advance = [&](Timed& timed) {
    const double before = timed.seconds();
    timed.go_on();
    used += timed.seconds() - before;
    if (progress) progress(used / total);
  };

  Comparison result;
  result.pixels = pixels.size();
  Variants variants(scene);
  std::map<SamplingMethod, Scene> scenes;
  std::map<SamplingMethod, double> build_seconds;
  for (const SamplingMethod method : options.methods) {
    const auto start = std::chrono::steady_clock::now();
    scenes.emplace(method, variants.make(method));
    build_seconds[method] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (scenes.count(SamplingMethod::automatic) == 0)
    scenes.emplace(SamplingMethod::automatic, variants.make(SamplingMethod::automatic));

  // The reference: two halves with seeds of their own.
  std::vector<RgbImage> halves;
  for (std::uint32_t half = 0; half < 2; ++half) {
    RenderOptions render = options.render;
    render.seed += 1000 + half;
    Timed timed(scenes.at(SamplingMethod::automatic), render, world);
    while (!timed.done(options.reference_seconds / 2)) advance(timed);
    result.reference_samples += timed.film().samples();
    halves.push_back(timed.film().radiance());
  }
  result.reference = mean_of(halves[0], halves[1]);
  // A half is as far from the mean of both as that mean is from the truth, in expectation.
  for (const RgbImage& half : halves)
    result.reference_relmse += relative_error(half, result.reference, pixels).relmse / 2;

  std::vector<std::unique_ptr<Timed>> timed;
  for (const Strategy strategy : {Strategy::mis, Strategy::bsdf})
    for (const SamplingMethod method : options.methods) {
      RenderOptions render = options.render;
      render.strategy = strategy;
      result.runs.push_back({method, strategy, build_seconds[method], {}, {}});
      timed.push_back(std::make_unique<Timed>(scenes.at(method), render, world));
    }
  while (true) {
    std::size_t next = timed.size();
    for (std::size_t k = 0; k < timed.size(); ++k)
      if (!timed[k]->done(options.seconds) && (next == timed.size() || timed[k]->seconds() < timed[next]->seconds()))
        next = k;
    if (next == timed.size()) break;
    Timed& run = *timed[next];
    advance(run);
    const bool last = run.done(options.seconds);
    if (!run.at_power_of_two() && !last) continue;
    const RgbImage image = run.film().radiance();
    const RelativeError error = relative_error(image, result.reference, pixels);
    result.runs[next].convergence.push_back({run.film().samples(), run.seconds(),
                                             std::max(error.relmse - result.reference_relmse, 0.0),
                                             error.standard_error});
    if (last) result.runs[next].image = image;
  }
  int fewest = result.runs.front().convergence.back().samples;
  for (const CompareRun& run : result.runs) fewest = std::min(fewest, run.convergence.back().samples);
  result.equal_samples = 1;
  while (2 * result.equal_samples <= fewest) result.equal_samples *= 2;
  return result;
}

}  // namespace gonio
