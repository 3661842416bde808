#include "tools/render/trace/film.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/support/table_files.h"
#include "tools/render/scene/read_scene.h"

namespace gonio {
namespace {

Scene small_scene() {
  return make_scene(nlohmann::json::parse(R"({
    "camera": {"position": [0, -5, 2], "target": [0, 0, 0.8], "resolution": [37, 21]},
    "environment": {"sky": {"sun": [-1, -1, 2]}},
    "materials": {"a": {"albedo": [0.7, 0.5, 0.3]}, "b": {"albedo": 0.4}},
    "objects": [{"shape": "sphere", "material": "a", "translate": [0, 0, 1]}, {"shape": "square", "material": "b", "scale": 5}]})"),
                    "test", {});
}

bool same(const RgbImage& a, const RgbImage& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

TEST(Film, DependsNeitherOnThreadsNorOnTheDivisionOfSamples) {
  const Scene scene = small_scene();
  RenderOptions options;
  options.threads = 1;
  Film one(scene, options);
  one.add_samples(7);
  options.threads = 3;
  Film three(scene, options);
  for (const int n : {1, 4, 2}) three.add_samples(n);
  EXPECT_EQ(three.samples(), 7);
  EXPECT_TRUE(same(one.radiance(), three.radiance()));
  EXPECT_TRUE(same(one.albedo(), three.albedo()));
  EXPECT_TRUE(same(one.normal(), three.normal()));
  EXPECT_TRUE(same(one.variance(), three.variance()));
}

TEST(Film, AnotherSeedIsAnotherPicture) {
  const Scene scene = small_scene();
  RenderOptions options;
  Film a(scene, options);
  options.seed = 2;
  Film b(scene, options);
  a.add_samples(2);
  b.add_samples(2);
  EXPECT_FALSE(same(a.radiance(), b.radiance()));
}

TEST(Film, AlbedoAndNormalAreThoseOfTheFirstSurface) {
  Scene scene = small_scene();
  scene.camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.01f, 4, 4};
  scene.objects.erase(scene.objects.begin());
  Film film(scene, {});
  film.add_samples(8);
  for (const glm::vec3& n : film.normal().pixels) EXPECT_NEAR(n.z, 1, 1e-6f);
  for (const glm::vec3& a : film.albedo().pixels) EXPECT_NEAR(a.g, 0.4f, 1e-6f);
}

// The variance channel predicts how far another seed is away.
TEST(Film, VarianceIsThatOfThePixels) {
  const Scene scene = small_scene();
  RenderOptions options;
  options.strategy = Strategy::bsdf;  // noisy
  Film a(scene, options);
  options.seed = 2;
  Film b(scene, options);
  EXPECT_EQ(a.variance().pixels.front(), glm::vec3(0));
  a.add_samples(64);
  b.add_samples(64);
  const RgbImage x = a.radiance(), y = b.radiance(), va = a.variance(), vb = b.variance();
  double squares = 0, predicted = 0;
  for (std::size_t k = 0; k < x.pixels.size(); ++k) {
    const double d = static_cast<double>(x.pixels[k].g - y.pixels[k].g);
    squares += d * d;
    predicted += static_cast<double>(va.pixels[k].g + vb.pixels[k].g);
  }
  EXPECT_GT(squares / predicted, 0.3);
  EXPECT_LT(squares / predicted, 1.5);
}

}  // namespace
}  // namespace gonio
