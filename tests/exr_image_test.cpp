#include <gonio/tools/render/exr_image.h>

#include <gonio/mapping/error.h>
#include <gonio/tests/table_files.h>
#include <gtest/gtest.h>

namespace gonio {
namespace {

TEST(ExrImage, LayersSurviveBitByBit) {
  const test::TemporaryFolder folder;
  RgbImage a{3, 2, {}}, b{3, 2, {}};
  for (int k = 0; k < 6; ++k) {
    a.pixels.emplace_back(0.1f + static_cast<float>(k), 1e-8f, 1e6f);
    b.pixels.emplace_back(static_cast<float>(k), 0, 0);
  }
  save_layers(folder / "a.exr", {{"", {"R", "G", "B"}, &a}, {"depth.", {"Z"}, &b}});
  const RgbImage read = load_rgb(folder / "a.exr");
  EXPECT_EQ(read.width, 3);
  EXPECT_EQ(read.height, 2);
  EXPECT_EQ(read.pixels, a.pixels);
  save_layers(folder / "b.exr", {{"", {"Y"}, &b}});
  EXPECT_EQ(load_rgb(folder / "b.exr").pixels[4], glm::vec3(4));
  save_layers(folder / "c.exr", {{"depth.", {"Z"}, &b}});
  EXPECT_THROW(load_rgb(folder / "c.exr"), Error);
}

TEST(ExrImage, RefusesOtherFiles) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.exr", "no image");
  EXPECT_THROW(load_rgb(folder / "a.exr"), Error);
  EXPECT_THROW(load_rgb(folder / "none.exr"), Error);
  RgbImage a{1, 1, {glm::vec3(1)}};
  EXPECT_THROW(save_layers(folder.path() / "no" / "a.exr", {{"", {"R"}, &a}}), Error);
}

}  // namespace
}  // namespace gonio
