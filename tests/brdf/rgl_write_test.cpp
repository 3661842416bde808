#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/rgl/rgl_write.h>
#include <gonio/brdf/formats/rgl/spectrum.h>
#include <gonio/brdf/formats/rgl/tensor_file.h>
#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/brdf/table/table.h>
#include <gonio/brdf/table/validate.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/rgl_quality.h"
#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;
using ::testing::HasSubstr;
using Shape = std::vector<std::uint64_t>;
using Type = TensorFile::Type;

Reflectance model(const char* description) {
  return [model = parse_model(description)](const glm::vec3& wi, const glm::vec3& wo) { return model.eval(wi, wo); };
}

RglSize smallest() {
  RglSize size;
  size.side = 6;
  size.vndf = 10;
  size.incident = 24;
  return size;
}

// The integral over the unit square of the bilinear density on the nodes of one slice.
double integral(const RglFile::Grid& grid, int slice) {
  double sum = 0;
  for (int j = 0; j < grid.height; ++j) {
    for (int i = 0; i < grid.width; ++i) {
      const double weight = (i == 0 || i == grid.width - 1 ? 0.5 : 1.0) * (j == 0 || j == grid.height - 1 ? 0.5 : 1.0);
      sum += weight * grid.values[static_cast<std::size_t>((slice * grid.height + j) * grid.width + i)];
    }
  }
  return sum / ((grid.width - 1) * (grid.height - 1));
}

void expect_normalised(const RglFile& file, double ndf_tolerance = 1e-5) {
  for (std::size_t k = 0; k < file.theta_i.size(); ++k) {
    EXPECT_NEAR(integral(file.vndf, static_cast<int>(k)), 1.0, 1e-5) << k;
    EXPECT_NEAR(integral(file.luminance, static_cast<int>(k)), 1.0, 1e-5) << k;
  }
  const std::vector<float> row(file.ndf.values.begin(), file.ndf.values.begin() + file.ndf.width);
  RadialNdf ndf(file.ndf.width, [&](double theta) {
    return row[static_cast<std::size_t>(std::lround(std::sqrt(theta * 2 / test::pi) * (file.ndf.width - 1)))];
  });
  EXPECT_NEAR(ndf.projected_area(), 1.0, ndf_tolerance);
  for (int k = 0; k < file.sigma.width; k += 15) {
    const double u = k / (file.sigma.width - 1.0);
    EXPECT_NEAR(file.sigma.values[static_cast<std::size_t>(k)], ndf.sigma(test::pi / 2 * u * u), ndf_tolerance) << k;
  }
  EXPECT_NEAR(file.sigma.values.front(), 1.0, ndf_tolerance);
}

TEST(RglResample, ModelsWithinOnePercent) {
  for (const char* description : {"default", "ggx:alpha=0.05,F0=0.9/0.6/0.3"}) {
    const Reflectance f_r = model(description);
    const RglFile file = resample_as_rgl(f_r, description);
    expect_normalised(file);
    const RglTable table(file, {});
    double mean = 0;
    const double angles[] = {2, 10, 17.3, 30, 42.1, 50, 61.9, 70, 80, 85};
    for (const double degrees : angles) {
      const RglQuality quality = measure(table, f_r, degrees, 160);
      mean += quality.error / std::size(angles);
      EXPECT_LT(quality.error, 0.025) << description << " at " << degrees;
      EXPECT_NEAR(quality.integral, 1.0, 0.002) << description << " at " << degrees;
    }
    EXPECT_LT(mean, 0.01) << description;
    RecordProperty(description, std::to_string(mean));
  }
}

// What the densities of a file must do is not a matter of course.
TEST(RglResample, TheMeasureCanFail) {
  Problems problems;
  const RglTable table(parse_rgl(make_rgl().bytes(), problems), {});
  const RglQuality quality = measure(table, model("default"), 30);
  EXPECT_GT(std::abs(quality.integral - 1.0), 0.05);
  EXPECT_GT(quality.error, 0.5);
}

// Draws follow the pdf: the mean weight is the albedo, and none is far from it.
TEST(RglResample, WeightsAreNearlyConstant) {
  const Reflectance f_r = model("default");
  RglSize coarse;
  coarse.incident = 24;
  const RglTable table(resample_as_rgl(f_r, "", coarse), {});
  const glm::vec3 wi = direction(0.9, 0.3);
  constexpr int n = 256;
  double sum = 0, squares = 0;
  for (int i = 0; i < n * n; ++i) {
    const auto s = table.sample(wi, (static_cast<float>(i % n) + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
    const double weight = s ? luminance(s->f_r) * s->wo.z / s->pdf : 0.0;
    sum += weight;
    squares += weight * weight;
  }
  const double mean = sum / (n * n);
  EXPECT_LT(squares / (n * n) / (mean * mean) - 1, 0.01);
}

TEST(RglResample, BlackAndSingleColours) {
  RglSize small = smallest();
  const auto black = [](const glm::vec3&, const glm::vec3&) { return glm::vec3(0.0f); };
  const RglFile file = resample_as_rgl(black, "black", small);
  expect_normalised(file);
  const RglTable table(file, {});
  EXPECT_EQ(table.eval(direction(0.5, 0), direction(0.6, 3)), glm::vec3(0.0f));
  EXPECT_NEAR(measure(table, black, 30).integral, 1.0, 0.1);
  // No retro-reflection at all, and one channel.
  const auto forward = [](const glm::vec3& wi, const glm::vec3& wo) {
    return wi.x * wo.x + wi.y * wo.y < 0 ? glm::vec3(0.3f, 0.0f, 0.0f) : glm::vec3(0.0f);
  };
  const RglTable half(resample_as_rgl(forward, "forward", small), {});
  EXPECT_NEAR(half.eval(direction(0.5, 0), direction(0.6, test::pi)).r, 0.3f, 0.03f);
  EXPECT_EQ(half.eval(direction(0.5, 0), direction(0.6, test::pi)).g, 0.0f);
}

TEST(RglResample, SizesAreWithinRange) {
  const auto grey = model("lambert:albedo=0.5");
  RglSize least = smallest();
  least.side = 2;
  least.vndf = 4;
  const RglFile file = resample_as_rgl(grey, "", least);
  const auto expect_finite = [](const std::vector<float>& values, const char* name) {
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) << name;
  };
  expect_finite(file.vndf.values, "vndf");
  expect_finite(file.luminance.values, "luminance");
  const auto expect_refused = [&](int side, int vndf, std::size_t incident) {
    RglSize size;
    size.side = side, size.vndf = vndf, size.incident = incident;
    EXPECT_THROW(resample_as_rgl(grey, "", size), Error) << side << ' ' << vndf << ' ' << incident;
  };
  expect_refused(1, 4, 24);
  expect_refused(2, 3, 24);
  expect_refused(2, 4, 23);
}

// Every field that the loaders ask for: powitacq_rgb, powitacq, pbrt-v4 and Mitsuba 3.
TEST(RglWrite, FieldsOfAllReaders) {
  const RglSize small = smallest();
  const RglFile file = resample_as_rgl(model("default"), "a material", small);
  const TemporaryFolder folder;
  write_rgl(folder / "both.bsdf", file);
  write_rgl(folder / "rgb.bsdf", file, RglColour::rgb);
  const std::uint64_t n = file.theta_i.size(), wavelengths = rgb_spectra().wavelengths.size();
  for (const bool both : {true, false}) {
    Problems problems;
    const TensorFile read(file_bytes(folder / (both ? "both.bsdf" : "rgb.bsdf")), problems);
    EXPECT_TRUE(problems.empty());
    const auto expect = [&](const char* name, Type type, const Shape& shape) {
      const TensorFile::Field* field = read.find(name);
      ASSERT_NE(field, nullptr) << name;
      EXPECT_EQ(field->type, type) << name;
      EXPECT_EQ(field->shape, shape) << name;
      EXPECT_EQ(field->offset % 8, 0u) << name;
    };
    expect("description", Type::u8, {10});
    expect("phi_i", Type::f32, {1});
    expect("theta_i", Type::f32, {n});
    expect("ndf", Type::f32, {2, 256});
    expect("sigma", Type::f32, {2, 256});
    expect("vndf", Type::f32, {1, n, 10, 10});
    expect("luminance", Type::f32, {1, n, 6, 6});
    expect("rgb", Type::f32, {1, n, 3, 6, 6});
    expect("jacobian", Type::u8, {1});
    EXPECT_EQ(read.octets(*read.find("jacobian"))[0], 1);
    // The RGB variants of Mitsuba refuse a file that has wavelengths.
    EXPECT_EQ(read.find("wavelengths") != nullptr, both);
    EXPECT_EQ(read.find("spectra") != nullptr, both);
    if (both) {
      expect("wavelengths", Type::f32, {wavelengths});
      expect("spectra", Type::f32, {1, n, wavelengths, 6, 6});
    }
    EXPECT_TRUE(validate_table(folder / (both ? "both.bsdf" : "rgb.bsdf")).empty());
  }
}

TEST(RglWrite, SpectraHaveTheColours) {
  const RglSize small = smallest();
  const RglFile file = resample_as_rgl(model("ggx:F0=0.9/0.6/0.2"), "", small);
  const TemporaryFolder folder;
  write_rgl(folder / "a.bsdf", file);
  Problems problems;
  const TensorFile read(file_bytes(folder / "a.bsdf"), problems);
  const std::vector<float> spectra = read.floats(*read.find("spectra"));
  const std::vector<glm::vec3> weights = rec709_weights(read.floats(*read.find("wavelengths")));
  const std::size_t plane = 36, slice = 5;
  for (std::size_t i = 0; i < plane; ++i) {
    glm::vec3 rgb(0.0f);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      rgb += weights[k] * spectra[(slice * weights.size() + k) * plane + i];
    }
    const glm::vec3 expected = file.colour[slice * plane + i];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], expected[c], 1e-4f * std::max(1.0f, expected.r));
  }
}

TEST(RglWrite, KeepsValuesBitByBit) {
  const RglSize small = smallest();
  RglFile file = resample_as_rgl(model("default"), "as it was", small);
  file.colour[7] = {-0.25f, 0.5f, 1.0f};  // measurements hold negative values
  const TemporaryFolder folder;
  write_rgl(folder / "a.bsdf", file);
  const RglFile read = read_rgl(folder / "a.bsdf");
  EXPECT_EQ(read.description, file.description);
  EXPECT_EQ(read.theta_i, file.theta_i);
  EXPECT_EQ(read.ndf.values, file.ndf.values);
  EXPECT_EQ(read.sigma.values, file.sigma.values);
  EXPECT_EQ(read.vndf.values, file.vndf.values);
  EXPECT_EQ(read.luminance.values, file.luminance.values);
  EXPECT_EQ(read.colour, file.colour);
  EXPECT_TRUE(read.jacobian);
}

// Files of the database hold densities of any scale, and measurements hold NaN.
TEST(RglWrite, NormalisesWhatIsNot) {
  RglFile file = resample_as_rgl(model("default"), "", smallest());
  const RglTable table(file, {});
  const std::size_t vndf = 100, plane = 36;
  for (std::size_t i = 3 * vndf; i < 4 * vndf; ++i) file.vndf.values[i] *= 20;
  for (std::size_t i = 5 * plane; i < 6 * plane; ++i) file.luminance.values[i] *= 0.1f;
  std::fill_n(file.luminance.values.begin() + 7 * plane, plane, 0.0f);
  const TemporaryFolder folder;
  write_rgl(folder / "a.bsdf", file);
  const RglFile read = read_rgl(folder / "a.bsdf");
  expect_normalised(read);
  EXPECT_EQ(read.ndf.values, file.ndf.values);
  EXPECT_EQ(read.sigma.values, file.sigma.values);
  EXPECT_EQ(read.colour, file.colour);
  const RglTable scaled(read, {});
  std::mt19937 engine(11);
  for (int k = 0; k < 200; ++k) {
    const glm::vec3 wi = direction(0.3, 0),
                    wo = random_direction(engine);  // between slices 4 and 5
    EXPECT_NEAR(scaled.pdf(wi, wo), table.pdf(wi, wo), 1e-5f * (1 + table.pdf(wi, wo)));
    EXPECT_EQ(scaled.eval_cosine(wi, wo), table.eval_cosine(wi, wo));
  }
}

TEST(RglWrite, DatabaseFilesBecomeNormalised) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const TemporaryFolder folder;
  for (const char* name : {"paper_white", "satin_rosaline", "cc_iris_purple_gem", "cg_sunflower"}) {
    const RglFile file = read_rgl(test_data() / "rgl" / (std::string(name) + "_rgb.bsdf"));
    write_rgl(folder / "a.bsdf", file);
    // ndf and sigma stay those of the database, whose quadrature is coarser than RadialNdf's.
    expect_normalised(read_rgl(folder / "a.bsdf"), 0.01);
  }
}

TEST(RglWrite, NaNStaysInItsChannel) {
  RglFile file = resample_as_rgl(model("lambert:albedo=0.5/0.4/0.3"), "", smallest());
  const std::size_t cell = 5 * 36 + 14;
  file.colour[cell] = {0.5f, std::numeric_limits<float>::quiet_NaN(), 0.25f};
  const TemporaryFolder folder;
  write_rgl(folder / "a.bsdf", file);
  Problems problems;
  const TensorFile read(file_bytes(folder / "a.bsdf"), problems);
  const std::vector<float> rgb = read.floats(*read.find("rgb")), spectra = read.floats(*read.find("spectra"));
  EXPECT_EQ(std::count_if(rgb.begin(), rgb.end(), [](float x) { return !std::isfinite(x); }), 1);
  // Spectra take the colour beside the cell, as gonio itself does.
  const std::size_t wavelengths = rgb_spectra().wavelengths.size();
  for (const float x : spectra) ASSERT_TRUE(std::isfinite(x) && x >= 0);
  for (std::size_t k = 0; k < wavelengths; ++k) {
    const std::size_t at = (5 * wavelengths + k) * 36 + 14;
    EXPECT_EQ(spectra[at], spectra[at - 1]) << k;
  }
}

TEST(RglWrite, RefusesWhatOtherReadersRefuse) {
  Problems problems;
  RglFile file = parse_rgl(make_rgl().bytes(), problems);
  const TemporaryFolder folder;
  const auto message = [&] {
    try {
      write_rgl(folder / "a.bsdf", file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message(), HasSubstr("luminance and rgb: found 3 x 2"));
  file.luminance.height = file.colour_height = 2;
  file.luminance.values.resize(12);
  file.colour.resize(12);
  file.jacobian = false;
  EXPECT_THAT(message(), HasSubstr("jacobian: found 0"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing half-written";
}

}  // namespace
}  // namespace gonio
