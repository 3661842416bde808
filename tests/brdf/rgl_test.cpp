#define GLM_ENABLE_EXPERIMENTAL  // glm/gtx, for rotations
#include <map>

#include <glm/geometric.hpp>
#include <glm/gtx/rotate_vector.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/repair.h>
#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;
using ::testing::HasSubstr;

RglFile parse(const TensorBuilder& builder) {
  Problems problems;
  RglFile file = parse_rgl(builder.bytes(), problems);
  throw_if_fatal("test", problems);
  return file;
}

RglTable table_of(const TensorBuilder& builder, const CellPolicies& policies = {}) {
  return RglTable(parse(builder), policies);
}

std::string message(const TensorBuilder& builder) {
  try {
    parse(builder);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Rgl, JacobianIsHonoured) {
  const RglTable with = table_of(make_rgl({0.4f, 0.8f, 1.2f}, true));
  const RglTable without = table_of(make_rgl({0.4f, 0.8f, 1.2f}, false));
  std::mt19937 engine(6);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 wi = random_direction(engine), wo = random_direction(engine);
    for (int c = 0; c < 3; ++c) {
      const float colour = 0.4f * static_cast<float>(c + 1);
      EXPECT_NEAR(with.eval_cosine(wi, wo)[c], colour / 4, 1e-6);
      EXPECT_NEAR(without.eval_cosine(wi, wo)[c], colour, 1e-6);
      const float cosine = std::max(wo.z, RglTable::min_cosine);
      EXPECT_NEAR(without.eval(wi, wo)[c] * cosine, colour, 1e-5);
    }
  }
}

TEST(Rgl, BoundedAtTheHorizon) {
  const RglTable table = table_of(make_rgl({1, 1, 1}, false));
  EXPECT_NEAR(table.eval(direction(0.3, 0), {1.0f, 0.0f, 1e-30f}).r, 1.0f / RglTable::min_cosine, 1.0);
}

// With uniform warps the chart of the normals alone makes the density.
TEST(Rgl, PdfOfUniformWarps) {
  const RglTable table = table_of(make_rgl());
  const glm::vec3 wi = direction(0.6, 0.2), wo = direction(1.1, 2.0);
  const glm::dvec3 m = glm::normalize(glm::dvec3(wi) + glm::dvec3(wo));
  const double theta = std::acos(m.z);
  const double jacobian = 2 * pi * pi * std::sqrt(2 * theta / pi) * std::sin(theta);
  EXPECT_NEAR(table.pdf(wi, wo), 1 / (jacobian * 4 * glm::dot(glm::dvec3(wi), m)), 1e-6);
}

TEST(Rgl, ColourSitsWhereThetaAndPhiSay) {
  TensorBuilder file = make_rgl({1, 1, 1}, false);
  // rgb[theta_i][channel][phi][theta]: phi 3 nodes, theta 2 nodes.
  std::vector<float> rgb;
  for (int slice = 0; slice < 3; ++slice) {
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 2; ++x) {
          rgb.push_back(static_cast<float>(1000 * slice + 100 * c + 10 * y + x));
        }
      }
    }
  }
  file["rgb"].data.assign(reinterpret_cast<const char*>(rgb.data()), rgb.size() * 4);
  const RglTable table = table_of(file);
  // theta_i = 0.8 is slice 1; a normal at u_theta = 0.6, turned by +90 degrees from wi,
  // has u_phi = 3/4; uniform warps leave both in place.
  const double theta_i = 0.8;
  const glm::dvec3 wi(direction(theta_i, 0.0)), m(direction(pi / 2 * 0.36, pi / 2));
  const glm::vec3 wo(2.0 * glm::dot(wi, m) * m - wi);
  ASSERT_GT(wo.z, 0.0f);
  const float expected = 1000.0f + 10.0f * 1.5f + 0.6f;
  EXPECT_NEAR(table.eval_cosine(glm::vec3(wi), wo).r, expected, 0.02);
  EXPECT_NEAR(table.eval_cosine(glm::vec3(wi), wo).b, expected + 200.0f, 0.02);
  // Only the azimuth relative to wi counts.
  EXPECT_NEAR(table.eval_cosine(glm::rotateZ(glm::vec3(wi), 2.5f), glm::rotateZ(wo, 2.5f)).r, expected, 0.02);
}

TEST(Rgl, NegativeColoursInterpolateAndClamp) {
  TensorBuilder file = make_rgl({1, 1, 1}, false);
  std::vector<float> rgb(54, 1.0f);
  for (std::size_t i = 0; i < rgb.size(); i += 2) rgb[i] = -1.0f;  // theta = 0 column
  file["rgb"].data.assign(reinterpret_cast<const char*>(rgb.data()), rgb.size() * 4);
  const glm::vec3 wi = direction(0.5, 0.0);
  const auto wo_of = [&](double u_theta) {
    const glm::dvec3 m(direction(pi / 2 * u_theta * u_theta, pi / 2));
    return glm::vec3(2.0 * glm::dot(glm::dvec3(wi), m) * m - glm::dvec3(wi));
  };
  const RglTable zero = table_of(file);
  EXPECT_EQ(zero.cells().negative, 27u / 3 * 1u);
  EXPECT_NEAR(zero.eval_cosine(wi, wo_of(0.6)).r, 0.2, 1e-4);
  EXPECT_EQ(zero.eval_cosine(wi, wo_of(0.3)).r, 0.0f);
  CellPolicies policies;
  policies.negative = CellPolicy::fill;
  EXPECT_NEAR(table_of(file, policies).eval_cosine(wi, wo_of(0.3)).r, 1.0, 1e-4);
  policies.negative = CellPolicy::reject;
  EXPECT_THROW(table_of(file, policies), Error);
}

TEST(Rgl, AnisotropicFilesAreRefused) {
  EXPECT_EQ(message(make_rgl({1, 1, 1}, true, 2)), "no error") << "two equal azimuths are isotropic";
  TensorBuilder two = make_rgl({1, 1, 1}, true, 2);
  std::string& data = two["luminance"].data;
  const float other = 9.0f;
  std::memcpy(data.data() + data.size() - 4, &other, 4);
  EXPECT_THAT(message(two), HasSubstr("luminance: found different data for the 2 phi_i"));
  EXPECT_THAT(message(make_rgl({1, 1, 1}, true, 8)), HasSubstr("phi_i: found 8 entries"));
}

TEST(Rgl, SpectraBecomeColour) {
  TensorBuilder file = make_rgl({1, 1, 1}, false);
  file.remove("rgb");
  std::vector<float> wavelengths, spectra;
  for (float nm = 360.0f; nm <= 1000.0f; nm += 5.0f) wavelengths.push_back(nm);
  const auto fill = [&](auto reflectance) {
    spectra.clear();
    for (int slice = 0; slice < 3; ++slice) {
      for (const float nm : wavelengths) spectra.insert(spectra.end(), 6, reflectance(nm));
    }
  };
  const glm::vec3 wi = direction(0.5, 0.0), wo = direction(0.9, 3.0);
  fill([](float) { return 0.25f; });
  file.add("wavelengths", {wavelengths.size()}, wavelengths);
  file.add("spectra", {1, 3, wavelengths.size(), 3, 2}, spectra);
  const RglTable grey = table_of(file);
  EXPECT_TRUE(grey.spectral());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(grey.eval_cosine(wi, wo)[c], 0.25, 1e-5);

  fill([](float nm) { return nm > 600.0f ? 1.0f : 0.0f; });
  file["spectra"].data.assign(reinterpret_cast<const char*>(spectra.data()), spectra.size() * 4);
  const glm::vec3 red = table_of(file).eval_cosine(wi, wo);
  EXPECT_GT(red.r, 0.5f);
  EXPECT_LT(red.g, 0.1f);
  EXPECT_LT(red.b, 0.1f);
  file.remove("wavelengths");
  EXPECT_THAT(message(file), HasSubstr("wavelengths: found no such field"));
}

TEST(Rgl, EveryFieldIsChecked) {
  for (const char* name : {"phi_i", "theta_i", "ndf", "sigma", "vndf", "luminance", "rgb", "jacobian"}) {
    TensorBuilder missing = make_rgl();
    missing.remove(name);
    EXPECT_THAT(message(missing), HasSubstr(std::string(name) + ": found no such field"));
    TensorBuilder flat = make_rgl();
    flat[name].shape.push_back(1);
    EXPECT_THAT(message(flat), HasSubstr(std::string(name) + ": found "));
    TensorBuilder huge = make_rgl();
    huge[name].shape[0] = 1ull << 62;
    EXPECT_THAT(message(huge), HasSubstr("values that lie within the file"));
    TensorBuilder typed = make_rgl();
    typed[name].type = 5;
    EXPECT_NE(message(typed), "no error") << name;
    typed[name].type = 77;
    EXPECT_THAT(message(typed), HasSubstr(std::string(name) + " type: found 77"));
  }
  const auto with = [](const char* name, float value) {
    TensorBuilder file = make_rgl();
    std::memcpy(file[name].data.data() + 4, &value, 4);
    return message(file);
  };
  EXPECT_THAT(with("theta_i", -1.0f), HasSubstr("theta_i[1]: found -1"));
  EXPECT_THAT(with("theta_i", 1.57f), HasSubstr("theta_i[2]: found 1.57"));
}

void set(TensorBuilder& file, const char* name, std::size_t i, float value) {
  std::memcpy(file[name].data.data() + 4 * i, &value, 4);
}

constexpr const char* densities[] = {"ndf", "sigma", "vndf", "luminance"};

// Rounding noise below 0 is 0, and what is not finite is its neighbour: the table is that of the file where a
// hand did so.
TEST(Rgl, DensitiesAreRepaired) {
  for (const char* name : densities) {
    TensorBuilder noisy = make_rgl(), clean = make_rgl();
    set(noisy, name, 1, -4e-10f);
    set(clean, name, 1, 0.0f);
    set(noisy, name, 4, std::nanf(""));  // uniform: its neighbour is what it was
    set(noisy, name, 5, -std::numeric_limits<float>::infinity());
    const RglTable table = table_of(noisy), expected = table_of(clean);
    EXPECT_EQ(table.densities().negative, 1u) << name;
    EXPECT_EQ(table.densities().nonfinite, 2u) << name;
    EXPECT_EQ(table.cells().negative + table.cells().nonfinite, 0u) << name;
    EXPECT_EQ(expected.densities().negative + expected.densities().nonfinite, 0u) << name;
    std::mt19937 engine(8);
    std::uniform_real_distribution<float> uniform;
    for (int i = 0; i < 300; ++i) {
      const glm::vec3 wi = random_direction(engine), wo = random_direction(engine);
      EXPECT_EQ(table.eval(wi, wo), expected.eval(wi, wo)) << name;
      EXPECT_EQ(table.pdf(wi, wo), expected.pdf(wi, wo)) << name;
      const float u = uniform(engine), v = uniform(engine);
      const auto a = table.sample(wi, u, v), b = expected.sample(wi, u, v);
      ASSERT_EQ(a.has_value(), b.has_value()) << name;
      if (a) {
        EXPECT_EQ(a->wo, b->wo) << name;
      }
    }
  }
}

TEST(Rgl, PoliciesHoldForDensities) {
  for (const char* name : densities) {
    TensorBuilder file = make_rgl();
    set(file, name, 0, -1.0f);
    CellPolicies policies;
    policies.negative = CellPolicy::fill;
    const glm::vec3 wi = direction(0.4, 0), wo = direction(0.7, 2);
    EXPECT_EQ(table_of(file, policies).pdf(wi, wo), table_of(make_rgl()).pdf(wi, wo)) << name;
    EXPECT_EQ(table_of(file, policies).eval(wi, wo), table_of(make_rgl()).eval(wi, wo)) << name;
    policies.negative = CellPolicy::reject;
    try {
      table_of(file, policies);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(name) + ": found 1 negative of "));
    }
    for (const float bad : {-1.0f, std::nanf("")}) {
      const std::size_t n = file[name].data.size() / 4;
      for (std::size_t i = 0; i < n; ++i) set(file, name, i, bad);
      EXPECT_THAT(message(file), HasSubstr(std::string(name) + ": found no valid value of "));
    }
  }
}

// Every cut says how long the file should be, and nothing else.
TEST(Rgl, CutOffFilesSayHowLongTheyShouldBe) {
  const std::string bytes = make_rgl().bytes();
  const std::size_t data = bytes.find("uniform");
  for (std::size_t n = 18; n < bytes.size(); ++n) {
    Problems problems;
    parse_rgl(bytes.substr(0, n), problems);
    ASSERT_EQ(problems.size(), 1u) << n;
    const std::string text = to_string(problems[0]);
    EXPECT_THAT(text, HasSubstr(std::to_string(n) + " bytes"));
    EXPECT_THAT(text, HasSubstr("cut off"));
    if (n >= data) {
      EXPECT_THAT(text, HasSubstr("expected " + std::to_string(bytes.size()) + " bytes"));
    }
  }
}

// Whether fields lie within the file is known once all are. What ends the list early leaves none of them.
TEST(Rgl, FieldsBeyondTheEndAreNotReadWhereTheListIsBroken) {
  TensorBuilder file = make_rgl();
  file.add("broken", std::vector<std::uint64_t>(99, 1), {0.0f});
  std::string bytes = file.bytes();
  const std::uint64_t far = std::uint64_t{1} << 40;
  std::memcpy(bytes.data() + bytes.find("ndf") + 3 + 2 + 1, &far,
              sizeof(far));  // the offset, after dimensions and type
  Problems problems;
  parse_rgl(bytes, problems);
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(to_string(problems[0]), HasSubstr("99 dimensions"));
}

// Half way between two cells of opposite signs: their difference is no float.
TEST(Rgl, CellsBeyondAnyBrdfAreNotFinite) {
  EXPECT_EQ(kind_of({1e30f, 0, 0}), CellKind::valid);
  EXPECT_EQ(kind_of({0, 1.1e30f, 0}), CellKind::nonfinite);
  EXPECT_EQ(kind_of({0, 0, -1.1e30f}), CellKind::nonfinite);
  TensorBuilder file = make_rgl();
  std::vector<float> rgb(54, 3e38f);
  for (std::size_t k = 0; k < rgb.size(); k += 2) rgb[k] = -3e38f;
  rgb[6] = rgb[13] = rgb[20] = 0.5f;
  file["rgb"].data.assign(reinterpret_cast<const char*>(rgb.data()), rgb.size() * sizeof(float));
  Problems problems;
  const RglFile parsed = parse_rgl(file.bytes(), problems);
  try {
    const RglTable table(parsed, {});
    for (const float theta : {0.1f, 0.9f, 1.5f}) {
      const glm::vec3 f = table.eval({std::sin(theta), 0, std::cos(theta)}, {0.3f, 0.4f, 0.866f});
      for (int c = 0; c < 3; ++c) EXPECT_GE(f[c], 0) << theta;  // not of NaN
    }
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("valid"));
  }
}

TEST(Rgl, OneInfinityHidesNoAnisotropy) {
  TensorBuilder file = make_rgl({1, 1, 1}, true, 2);
  set(file, "luminance", 0, std::numeric_limits<float>::infinity());
  EXPECT_EQ(message(file), "no error");
  set(file, "luminance", 1, 9.0f);
  EXPECT_THAT(message(file), HasSubstr("luminance: found different data for the 2 phi_i"));
}

class RglMaterials : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
    table_ =
        std::make_unique<RglTable>(read_rgl(test_data() / "rgl" / (std::string(GetParam()) + ".bsdf")), CellPolicies{});
  }
  std::unique_ptr<RglTable> table_;
};

// f_r cos(theta_o) and pdf against the values of the authors' own loader (single precision).
TEST_P(RglMaterials, AgreeWithThePublishedLoader) {
  std::ifstream stream(test_data() / "rgl" / "reference_values.csv");
  std::string line;
  int pairs = 0;
  while (std::getline(stream, line)) {
    if (line.rfind(GetParam(), 0) != 0) continue;
    std::istringstream numbers(line.substr(line.find(',') + 1));
    float v[10];
    char comma;
    for (float& value : v) numbers >> value >> comma;
    const glm::vec3 wi(v[0], v[1], v[2]), wo(v[3], v[4], v[5]);
    const glm::vec3 value = table_->eval_cosine(wi, wo);
    const float found[4] = {value.r, value.g, value.b, table_->pdf(wi, wo)};
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(found[k], v[6 + k], std::max(1e-5f, 1e-3f * v[6 + k])) << line << " column " << k;
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(table_->eval(wi, wo)[c] * std::max(wo.z, RglTable::min_cosine), value[c], 1e-5f * value[c]);
    }
    ++pairs;
  }
  EXPECT_EQ(pairs, 500);
}

TEST_P(RglMaterials, SampleAgreesWithPdfAndEval) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform;
  int valid = 0, close = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 wi = direction(1.4 * uniform(engine), 6.0 * uniform(engine));
    const auto draw = table_->sample(wi, uniform(engine), uniform(engine));
    if (!draw) continue;
    ++valid;
    EXPECT_NEAR(glm::length(draw->wo), 1.0f, 1e-5f);
    // In single precision the way back through the warps loses digits where a density is steep.
    const float pdf = table_->pdf(wi, draw->wo);
    const glm::vec3 f_r = table_->eval(wi, draw->wo);
    close += std::abs(pdf - draw->pdf) <= 2e-2f * draw->pdf &&
             glm::length(f_r - draw->f_r) <= 2e-2f * glm::length(draw->f_r) + 1e-4f;
  }
  EXPECT_GT(valid, 19000);
  EXPECT_GT(close, valid * 0.99);
}

INSTANTIATE_TEST_SUITE_P(Measured, RglMaterials,
                         ::testing::Values("cc_iris_purple_gem_rgb", "cg_sunflower_rgb", "paper_white_rgb",
                                           "satin_rosaline_rgb"));

}  // namespace
}  // namespace gonio
