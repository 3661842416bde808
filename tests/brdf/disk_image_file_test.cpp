#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/ndf_cases.h"
#include "tests/support/table_files.h"

namespace gonio {
namespace {

using test::TemporaryFolder;

std::string message(const std::filesystem::path& path) {
  try {
    load_ndf_image(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A colour image of half floats, its data window away from the origin.
void write_rgba(const std::filesystem::path& path, int width, int height) {
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({10, 20}, {10 + width - 1, 20 + height - 1}));
  Imf::Array2D<Imf::Rgba> pixels(height, width);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels[y][x] = Imf::Rgba(static_cast<float>(x), static_cast<float>(y), 2.0f, 1.0f);
  Imf::RgbaOutputFile file(path.c_str(), header, Imf::WRITE_RGBA);
  file.setFrameBuffer(&pixels[0][0] - 10 - 20 * width, 1, static_cast<std::size_t>(width));
  file.writePixels(height);
}

TEST(DiskImageFile, RoundTripKeepsEveryBit) {
  const TemporaryFolder folder;
  const DiskImage image = rasterise(37, test::GgxNdf{0.2, 0.5});
  save_disk_image(folder / "d.exr", image, "D");
  const DiskImage again = load_ndf_image(folder / "d.exr");
  EXPECT_EQ(again.size, 37);
  EXPECT_EQ(again.values, image.values);
}

TEST(DiskImageFile, OtherProgramsImages) {
  const TemporaryFolder folder;
  write_rgba(folder / "rgb.exr", 24, 24);
  const DiskImage image = load_ndf_image(folder / "rgb.exr");
  ASSERT_EQ(image.size, 24);
  EXPECT_NEAR(image.at(5, 7), 0.2126 * 7 + 0.7152 * 5 + 0.0722 * 2, 1e-5);
}

TEST(DiskImageFile, RefusesWithReason) {
  const TemporaryFolder folder;
  write_rgba(folder / "flat.exr", 24, 12);
  EXPECT_NE(message(folder / "flat.exr").find("found 24 x 12"), std::string::npos);
  save_disk_image(folder / "g1.exr", DiskImage(8), "G1");
  EXPECT_NE(message(folder / "g1.exr").find("gonio:quantity: found G1, expected D"), std::string::npos);
  test::write_file(folder / "text.exr", "text");
  EXPECT_NE(message(folder / "text.exr").find("no OpenEXR file"), std::string::npos);
  EXPECT_NE(message(folder / "none.exr").find("none.exr: no such file"), std::string::npos);
  StackFile stack;
  stack.bsdf.diagrams.theta_i = {0.0, 1.0};
  DiagramGrid grid;
  grid.azimuth = Azimuth::half;
  grid.phi = {0, pi<double>};
  grid.r = {0, 1};
  grid.density = {1, 1, 1, 1};
  stack.bsdf.diagrams.diagrams = {grid, grid};
  save_stack(folder / "stack.exr", stack);
  EXPECT_NE(message(folder / "stack.exr").find("a stack file"), std::string::npos);
}

// Every truncation and a flipped byte anywhere: an image or an Error, nothing else.
TEST(DiskImageFile, DamagedFiles) {
  const TemporaryFolder folder;
  save_disk_image(folder / "d.exr", rasterise(9, test::GgxNdf{0.5, 0.5}), "D");
  const std::string bytes = test::file_bytes(folder / "d.exr");
  for (std::size_t n = 0; n < bytes.size(); n += 7) {
    test::write_file(folder / "bad.exr", bytes.substr(0, n));
    EXPECT_THROW(load_ndf_image(folder / "bad.exr"), Error) << n;
    std::string flipped = bytes;
    flipped[n] = static_cast<char>(flipped[n] ^ 0x55);
    test::write_file(folder / "bad.exr", flipped);
    try {
      load_ndf_image(folder / "bad.exr");
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("bad.exr"), std::string::npos);
    }
  }
}

TEST(DiskImageFile, AMissingFolderLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_THROW(save_disk_image(folder / "no/d.exr", DiskImage(8), "D"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace gonio
