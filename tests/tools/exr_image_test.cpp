#include "tools/render/image/exr_image.h"

#include <gtest/gtest.h>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

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

std::string message_of(const std::filesystem::path& path) {
  try {
    load_rgb(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Their channels have the names of a picture's and mean something else.
TEST(ExrImage, OtherFilesOfGonioAreNamed) {
  const test::TemporaryFolder folder;
  DiagramGrid diagram{Azimuth::half, {0, pi<double>}, {0, 1}, std::vector<double>(4, 1.0)};
  StackFile stack;
  stack.bsdf.diagrams.theta_i = {0};
  stack.bsdf.diagrams.diagrams = {diagram};
  stack.bsdf.colour = Colour({0}, 2, std::vector<glm::vec3>(2, glm::vec3(0.5f)));
  save_stack(folder / "stack.exr", stack);
  EXPECT_NE(message_of(folder / "stack.exr").find("stack.exr: content: found a stack file, expected a picture"),
            std::string::npos)
      << message_of(folder / "stack.exr");
  DiskImage disk(4);
  disk.values.assign(16, 1.0f);
  save_disk_image(folder / "d.exr", disk, "D");
  EXPECT_NE(
      message_of(folder / "d.exr").find("d.exr: content: found an image of a normal distribution, expected a picture"),
      std::string::npos)
      << message_of(folder / "d.exr");
}

}  // namespace
}  // namespace gonio
