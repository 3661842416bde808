#include "tools/render/trace/path_tracer.h"

#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/fitting/model/synth.h>

#include "tests/support/table_files.h"
#include "tools/render/trace/film.h"

namespace gonio {
namespace {

constexpr float degree = pi<float> / 180;

std::shared_ptr<const BrdfTable> table_of(BrdfTable::Data data) {
  return std::make_shared<const BrdfTable>(std::move(data), BrdfTable::Info{"test", "test", "test", "", 0, {}});
}

/// An f_r of 0.5 / pi in every cell.
std::shared_ptr<const BrdfTable> grey_table() {
  return table_of(MbsdfTable(MbsdfFile{6, 6, 8, 3, std::vector<float>(3 * 6 * 6 * 8, 0.5f / pi<float>), "", false}));
}

std::shared_ptr<const BrdfTable> glossy_table() {
  static const auto table =
      table_of(MbsdfTable(synthesize_mbsdf(parse_model("ggx:alpha=0.25,F0=0.3+lambert:albedo=0.5/0.3/0.2"), 24, 48)));
  return table;
}

const Bsdf& glossy_bsdf() {
  static const Bsdf bsdf = make_bsdf(glossy_table());
  return bsdf;
}

std::shared_ptr<const Scatter> glossy() { return make_scatter(glossy_bsdf()); }

std::shared_ptr<const BrdfTable> rgl_table() {
  Problems problems;
  return table_of(RglTable(parse_rgl(test::make_rgl({0.20f, 0.25f, 0.30f}).bytes(), problems), {}));
}

using Light = glm::vec3 (*)(const glm::vec3& direction);
glm::vec3 constant(const glm::vec3&) { return glm::vec3(1); }
glm::vec3 gradient(const glm::vec3& w) { return glm::vec3(0.5f + 0.5f * w.z, 0.5f + 0.4f * w.x, 0.6f); }
glm::vec3 small_spot(const glm::vec3& w) {
  const bool inside = glm::dot(w, glm::normalize(glm::vec3(-0.5f, -0.4f, 0.8f))) > std::cos(8 * degree);
  return inside ? glm::vec3(60, 50, 40) : glm::vec3(0.02f);
}

std::shared_ptr<const Environment> environment(Light light) {
  RgbImage image{128, 64, {}};
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const float theta = pi<float> * (static_cast<float>(row) + 0.5f) / 64,
                  phi = pi<float> - 2 * pi<float> * (static_cast<float>(column) + 0.5f) / 128;
      image.pixels.push_back(
          light({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}));
    }
  return std::make_shared<const Environment>(std::move(image), "test");
}

glm::mat4 placed_at(const glm::vec3& position, float size = 1) {
  return glm::scale(glm::translate(glm::mat4(1.0f), position), glm::vec3(size));
}

Object object(const char* shape, const glm::mat4& place, std::size_t material,
              const glm::vec3& emission = glm::vec3(0)) {
  TriangleMesh mesh = make_shape(shape, "");
  transform(mesh, place);
  return {std::make_shared<const TriangleMesh>(std::move(mesh)), material, emission};
}

/// A square that emits downwards, not quite along an axis.
Object lamp(const glm::vec3& position, float size, const glm::vec3& emission) {
  return object("square", glm::rotate(placed_at(position, size), 3.0f, glm::vec3(1, 0.3f, 0)), 1, emission);
}

/// The whole scene moved after it was scaled: what it looks like stays.
void transform(Scene& scene, float size, const glm::vec3& move) {
  for (Object& o : scene.objects) {
    TriangleMesh mesh = *o.mesh;
    transform(mesh, placed_at(move, size));
    o.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  }
  for (glm::vec3* p : {&scene.camera.position, &scene.camera.target}) *p = size * *p + move;
  for (GoniometricLight& l : scene.lights) l.position = size * l.position + move, l.scale *= size * size;
}

/// 100 cd straight down, nothing sideways.
GoniometricLight down_light(const glm::vec3& position, float scale = 1) {
  const LightDiagram diagram{{0, 2 * pi<double>}, {0, pi<double> / 2, pi<double>}, {100, 50, 0, 100, 50, 0}, {}};
  return {position, glm::mat3(1.0f), glm::vec3(scale), std::make_shared<const EmissionSampler<float>>(diagram)};
}

/// A ball on a white plate; both fill the view.
Scene ball(Light light, std::shared_ptr<const Scatter> bsdf) {
  Scene scene;
  scene.camera = {{0, -6, 4}, {0, 0, 0.7f}, {0, 0, 1}, 20 * degree, 10, 10};
  scene.environment = environment(light);
  scene.materials.push_back({"ball", std::move(bsdf), true, nullptr, {}, {}});
  scene.materials.push_back({"plate", make_scatter(LambertSampler(glm::vec3(0.7f))), true, nullptr, {}, {}});
  scene.objects = {object("sphere", placed_at({0, 0, 1}), 0), object("square", placed_at({0, 0, 0}, 20), 1)};
  return scene;
}

double mean_luminance(const RgbImage& image) {
  double sum = 0;
  for (const glm::vec3& p : image.pixels) sum += static_cast<double>(luminance(p));
  return sum / static_cast<double>(image.pixels.size());
}

double mean_luminance(const Scene& scene, int samples, Strategy strategy, int max_bounces = 12) {
  RenderOptions options;
  options.strategy = strategy;
  options.max_bounces = max_bounces;
  Film film(scene, options);
  film.add_samples(samples);
  return mean_luminance(film.radiance());
}

/// The image's mean luminance and its standard error, from independent repeats.
struct Estimate {
  double mean, error;
};

Estimate estimate(const Scene& scene, Strategy strategy) {
  constexpr std::uint32_t repeats = 24, samples = 16;
  const PathTracer tracer(scene, strategy, 2);
  std::vector<double> means(repeats, 0.0);
  for (std::uint32_t k = 0; k < repeats; ++k)
    for (std::uint32_t pixel = 0; pixel < 100; ++pixel)
      for (std::uint32_t s = 0; s < samples; ++s) {
        PathSequence random(100 * static_cast<std::uint32_t>(strategy) + k, pixel, s);
        const glm::vec2 u = random.next();
        const PathResult path =
            tracer.trace(static_cast<float>(pixel % 10) + u.x, static_cast<float>(pixel / 10) + u.y, random);
        means[k] += static_cast<double>(luminance(path.radiance)) / (100 * samples);
      }
  const double n = repeats, mean = std::accumulate(means.begin(), means.end(), 0.0) / n;
  double squares = 0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

/// In standard errors.
double difference(const Estimate& a, const Estimate& b) {
  return std::abs(a.mean - b.mean) / std::hypot(a.error, b.error);
}

struct Case {
  const char* name;
  Light light;
};
const Case lights[] = {{"constant", constant}, {"gradient", gradient}, {"small spot", small_spot}};

void expect_strategies_agree(const Scene& scene, const std::string& name) {
  const Estimate mis = estimate(scene, Strategy::mis), bsdf = estimate(scene, Strategy::bsdf),
                 light = estimate(scene, Strategy::light);
  EXPECT_LT(difference(mis, bsdf), 3) << name << ": " << mis.mean << " and " << bsdf.mean;
  EXPECT_LT(difference(mis, light), 3) << name << ": " << mis.mean << " and " << light.mean;
  EXPECT_LT(difference(bsdf, light), 3) << name << ": " << bsdf.mean << " and " << light.mean;
  EXPECT_LT(mis.error, 0.01 * mis.mean) << name;  // the comparison says something
}

void expect_strategies_agree(const std::shared_ptr<const Scatter>& bsdf, const std::string& name) {
  for (const Case& light : lights) expect_strategies_agree(ball(light.light, bsdf), name + ", " + light.name);
}

// A plate of albedo 0.5 that fills the view, in an environment of radiance 1.
TEST(PathTracer, WhiteFurnaceOfALambertTable) {
  Scene scene;
  scene.camera = {{1, -2, 3}, {0, 0, 0}, {0, 0, 1}, 20 * degree, 16, 16};
  scene.environment = environment(constant);
  scene.materials.push_back({"grey", make_scatter(make_bsdf(grey_table())), true, nullptr, {}, {}});
  scene.objects.push_back(object("square", placed_at({0, 0, 0}, 10), 0));
  for (const Strategy strategy : strategies) {
    RenderOptions options;
    options.strategy = strategy;
    Film film(scene, options);
    film.add_samples(256);
    EXPECT_NEAR(mean_luminance(film.radiance()), 0.5, 0.5e-3) << to_string(strategy);
    if (strategy != Strategy::bsdf) continue;
    for (const glm::vec3& p : film.radiance().pixels) EXPECT_NEAR(luminance(p), 0.5f, 0.5e-2f);
  }
}

TEST(PathTracer, StrategiesAgreeOnEveryMethod) {
  BsdfOptions small;
  small.incident = small.meridians = small.parallels = 16;
  MethodBuilder builder(glossy_table(), {}, small);
  for (const SamplingMethod method : sampling_methods)
    if (builder.available(method)) expect_strategies_agree(builder.build(method), to_string(method));
}

TEST(PathTracer, StrategiesAgreeOnTheRglChain) {
  expect_strategies_agree(MethodBuilder(rgl_table()).build(SamplingMethod::rgl), "rgl");
}

TEST(PathTracer, StrategiesAgreeOnCompactBsdfs) {
  BsdfOptions options;
  options.f_r = BsdfValue::colour;
  options.max_variance = 0.01;
  expect_strategies_agree(make_scatter(make_bsdf(glossy_table(), options)), "compact");
}

TEST(PathTracer, StrategiesAgreeOnAreaLights) {
  Scene scene = ball(constant, glossy());
  scene.environment = nullptr;
  scene.objects.push_back(lamp({0.5f, -1.5f, 4}, 1, {20, 15, 10}));
  expect_strategies_agree(scene, "high");
  // Seen from below, so low that the steps off the surfaces count.
  scene.camera = {{0, -3, 0.2f}, {0, 0, 0}, {0, 0, 1}, 10 * degree, 10, 10};
  scene.objects = {object("square", placed_at({0, 0, 0}, 20), 1), lamp({0, 0, 0.3f}, 1, {20, 15, 10})};
  for (const float away : {0.0f, 20.0f, 1000.0f}) {
    Scene moved = scene;
    transform(moved, 1, glm::vec3(away));
    expect_strategies_agree(moved, "low, moved by " + std::to_string(away));
  }
}

/// A sampler whose weight and pdf() are those of a density 5 % too high.
class WrongPdf {
 public:
  explicit WrongPdf(Bsdf sampler) : sampler_(std::move(sampler)) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
    auto s = sampler_.sample(wi, u);
    if (s) s->pdf *= 1.05f, s->weight /= 1.05f;
    return s;
  }
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return 1.05f * sampler_.pdf(wi, wo); }
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return sampler_.eval(wi, wo); }

 private:
  Bsdf sampler_;
};

TEST(PathTracer, NegativeControlAPdfThatIsFivePercentOffIsSeen) {
  const auto wrong = make_scatter(WrongPdf(glossy_bsdf()));
  // Not the small spot: there MIS draws from the light, nearly always, and is right to.
  for (const Light light : {constant, gradient}) {
    const Scene scene = ball(light, wrong);
    EXPECT_GT(difference(estimate(scene, Strategy::mis), estimate(scene, Strategy::light)), 3);
  }
}

// No surface reflects more than it receives: nothing is brighter than the environment.
TEST(PathTracer, EnergyIsNotGained) {
  const Scene scene = ball(constant, glossy());
  RenderOptions options;
  options.max_bounces = 64;
  Film film(scene, options);
  film.add_samples(256);
  for (const glm::vec3& p : film.radiance().pixels) {
    EXPECT_LT(luminance(p), 1.0f);
    EXPECT_GT(luminance(p), 0.2f);
  }
}

// E = I cos / d^2, whatever the strategy: nothing hits such a light by chance.
TEST(PathTracer, GoniometricLightIlluminatesByTheInverseSquare) {
  Scene scene;
  scene.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.1f * degree, 4, 4};
  scene.materials.push_back({"grey", make_scatter(LambertSampler(glm::vec3(0.5f))), true, nullptr, {}, {}});
  scene.objects.push_back(object("square", glm::mat4(1.0f), 0));
  scene.lights.push_back(down_light({0, 0, 5}));
  for (const Strategy strategy : strategies)
    EXPECT_NEAR(mean_luminance(scene, 4, strategy), 0.5 / pi<double> * 100 / 25, 1e-3) << to_string(strategy);
  // A blocker in between makes it dark; one behind it does not.
  scene.objects.push_back(object("square", placed_at({0, 0, 5.01f}), 0));
  EXPECT_NEAR(mean_luminance(scene, 4, Strategy::mis), 0.5 / pi<double> * 100 / 25, 1e-3);
  scene.objects.back() = object("square", placed_at({0, 0, 4}), 0);
  EXPECT_EQ(mean_luminance(scene, 4, Strategy::mis), 0);
}

// A lamp on a vast ground under a sky, of whose power it has 1e-9: it is drawn nevertheless.
TEST(PathTracer, AWeakLightIsNotLostInTheSky) {
  Scene scene;
  scene.camera = {{0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.1f * degree, 4, 4};
  scene.environment = environment(constant);
  scene.materials.push_back({"grey", make_scatter(LambertSampler(glm::vec3(0.5f))), true, nullptr, {}, {}});
  scene.objects.push_back(object("square", placed_at({0, 0, 0}, 1000), 0));
  scene.lights.push_back(down_light({0, 0, 1}, 0.001f));
  for (const Strategy strategy : strategies)
    EXPECT_NEAR(mean_luminance(scene, 1024, strategy), 0.5 + 0.5 / pi<double> * 0.1, 2e-3) << to_string(strategy);
}

// A closed box whose six squares emit 1 and reflect half of what they get: 1 + 1/2 + 1/4 ... = 2.
TEST(PathTracer, RussianRouletteKeepsTheMean) {
  Scene scene;
  scene.camera = {{0.1f, 0.2f, 0.3f}, {1, 0.4f, 0.2f}, {0, 0, 1}, 60 * degree, 8, 8};
  scene.materials.push_back({"grey", make_scatter(LambertSampler(glm::vec3(0.5f))), true, nullptr, {}, {}});
  for (const glm::vec3 side : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
    for (const float sign : {-1.0f, 1.0f}) {
      const glm::vec3 inwards = -sign * side, across(side.y, side.z, side.x);
      glm::mat4 place(1.0f);
      place[0] = glm::vec4(across, 0), place[1] = glm::vec4(glm::cross(inwards, across), 0),
      place[2] = glm::vec4(inwards, 0), place[3] = glm::vec4(-inwards, 1);
      scene.objects.push_back(object("square", place, 0, glm::vec3(1)));
    }
  EXPECT_NEAR(mean_luminance(scene, 8192, Strategy::bsdf, 64), 2, 2e-3);
  EXPECT_NEAR(mean_luminance(scene, 8192, Strategy::mis, 64), 2, 2e-3);
}

TEST(PathTracer, ThePictureDoesNotDependOnTheUnitOfLength) {
  Scene scene = ball(gradient, glossy());
  scene.objects.push_back(lamp({0.5f, -1.5f, 4}, 1, {20, 15, 10}));
  scene.lights.push_back(down_light({-1, -1, 3}));
  const auto picture = [](const Scene& of) {
    Film film(of, {});
    film.add_samples(16);
    return film.radiance();
  };
  const RgbImage whole = picture(scene);
  Scene small = scene;
  transform(small, 1e-5f, glm::vec3(0));
  const RgbImage again = picture(small);
  EXPECT_NEAR(mean_luminance(again) / mean_luminance(whole), 1, 1e-3);
}

TEST(PathTracer, TheBackOfAOneSidedMaterialIsBlack) {
  Scene scene = ball(constant, glossy());
  scene.camera.position = {0, 0, 1};  // inside the ball
  scene.camera.target = {0, 1, 1};
  for (const bool two_sided : {true, false}) {
    scene.materials[0].two_sided = two_sided;
    scene.objects[0].emission = glm::vec3(0);
    Film film(scene, {});
    film.add_samples(1);
    for (const glm::vec3& p : film.albedo().pixels) EXPECT_EQ(luminance(p) > 0, two_sided);
  }
}

}  // namespace
}  // namespace gonio
