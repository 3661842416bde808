#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;
using ::testing::HasSubstr;

// f_r = 100 theta_in + 10 theta_out + phi, in indices; green and blue add 0.1 and 0.2.
MbsdfFile make_grid(int n_in, int n_out, int n_phi, int channels = 3) {
  MbsdfFile file{n_in, n_out, n_phi, channels, {}, "", false};
  for (int i = 0; i < n_in; ++i) {
    for (int o = 0; o < n_out; ++o) {
      for (int p = 0; p < n_phi; ++p) {
        for (int c = 0; c < channels; ++c) {
          file.values.push_back(static_cast<float>(100 * i + 10 * o + p) + 0.1f * static_cast<float>(c));
        }
      }
    }
  }
  return file;
}

MbsdfFile parse(const std::string& bytes, Problems& problems) {
  MbsdfFile file = parse_mbsdf(bytes, problems);
  throw_if_fatal("test", problems);
  return file;
}

std::string message(const std::string& bytes) {
  Problems problems;
  try {
    parse(bytes, problems);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Grid, HoldsItsValuesAtCellCentres) {
  const MbsdfTable table(make_grid(3, 5, 4));
  for (int i = 0; i < 3; ++i) {
    for (int o = 0; o < 5; ++o) {
      for (int p = 0; p < 4; ++p) {
        const double phi = (p + 0.5) * pi / 4;
        for (const double sign : {1.0, -1.0}) {
          for (const double turn : {0.0, 2.0, 3.1}) {
            const glm::vec3 f_r =
                table.eval(direction((i + 0.5) * pi / 6, turn), direction((o + 0.5) * pi / 10, turn + sign * phi));
            EXPECT_NEAR(f_r.r, 100 * i + 10 * o + p, 1e-3);
            EXPECT_NEAR(f_r.b, 100 * i + 10 * o + p + 0.2, 1e-3);
          }
        }
      }
    }
  }
}

TEST(Grid, LinearBetweenCentresAndConstantBeyond) {
  const MbsdfTable table(make_grid(3, 3, 4));
  const double step = pi / 6;
  const auto at = [&](double in, double out, double phi) {
    return table.eval(direction(in * step, 0.0), direction(out * step, phi * pi / 4)).r;
  };
  EXPECT_NEAR(at(1.0, 0.5, 0.5), 50.0, 1e-3);
  EXPECT_NEAR(at(0.5, 1.25, 0.5), 7.5, 1e-3);
  EXPECT_NEAR(at(0.5, 0.5, 2.0), 1.5, 1e-3);
  EXPECT_NEAR(at(0.5, 0.5, 0.1), 0.0, 1e-3);
  EXPECT_NEAR(at(0.5, 0.5, 4.0), 3.0, 1e-3) << "specular is the last phi";
  EXPECT_NEAR(at(2.9, 2.9, 0.5), 220.0, 1e-3);
}

// All of the hemisphere would get the column of phi = 0 otherwise.
TEST(Grid, AtTheNormalAzimuthsAreThoseFromX) {
  const MbsdfTable table(make_grid(3, 3, 4));
  EXPECT_TRUE(std::isfinite(table.eval({0, 0, 1}, {0, 0, 1}).r));
  for (const double phi : {0.0, 1.0, 2.0, 3.0})
    EXPECT_NEAR(table.eval({0, 0, 1}, direction(1.0, phi)).r, table.eval(direction(1e-5, 0.0), direction(1.0, phi)).r,
                1e-4)
        << phi;
  EXPECT_NE(table.eval({0, 0, 1}, direction(1.0, 0.0)).r, table.eval({0, 0, 1}, direction(1.0, 3.0)).r);
}

TEST(Grid, ScalarAndSingleCell) {
  const MbsdfTable scalar(make_grid(2, 2, 2, 1));
  const glm::vec3 f_r = scalar.eval(direction(0.3, 0.0), direction(0.9, 1.0));
  EXPECT_EQ(f_r.r, f_r.g);
  EXPECT_EQ(f_r.r, f_r.b);
  const MbsdfTable one(MbsdfFile{1, 1, 1, 1, {0.25f}, "", false});
  EXPECT_EQ(one.eval(direction(0.3, 0.0), direction(0.9, 1.0)).g, 0.25f);
}

TEST(Grid, BadCells) {
  MbsdfFile file = make_grid(2, 2, 3);
  file.values[0] = -1.0f;          // cell (0,0,0), red alone
  file.values[4] = std::nanf("");  // cell (0,0,1)
  const MbsdfTable table(file);
  EXPECT_EQ(table.cells().negative, 1u);
  EXPECT_EQ(table.cells().nonfinite, 1u);
  EXPECT_EQ(table.cells().total, 12u);
  const auto at = [&](const MbsdfTable& t, int p) {
    return t.eval(direction(pi / 8, 0.0), direction(pi / 8, (p + 0.5) * pi / 3));
  };
  EXPECT_NEAR(at(table, 0).r, 0.0f, 1e-5);
  EXPECT_NEAR(at(table, 0).g, 0.1f, 1e-5);
  EXPECT_NEAR(at(table, 1).g, 0.1f, 1e-4) << "filled from the lower neighbour";
  CellPolicies policies;
  policies.negative = CellPolicy::reject;
  EXPECT_THROW(MbsdfTable(file, policies), Error);
}

TEST(Grid, WrongShapesAreRefused) {
  EXPECT_THROW(MbsdfTable(MbsdfFile{0, 1, 1, 1, {}, "", false}), Error);
  EXPECT_THROW(MbsdfTable(MbsdfFile{1, 1, 1, 2, {0, 0}, "", false}), Error);
  EXPECT_THROW(MbsdfTable(MbsdfFile{2, 1, 1, 1, {0}, "", false}), Error);
  EXPECT_THROW(MbsdfTable(MbsdfFile{1 << 30, 1 << 30, 1 << 30, 3, {0}, "", false}), Error);
  const TemporaryFolder folder;
  EXPECT_THROW(write_mbsdf(folder / "x", make_grid(2, 3, 1)), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "x"));
}

TEST(Grid, RoundTrip) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    const MbsdfFile file = make_grid(4, 4, 6, channels);
    write_mbsdf(folder / "x", file);
    const MbsdfFile back = read_mbsdf(folder / "x");
    EXPECT_EQ(back.n_theta_in, 4);
    EXPECT_EQ(back.n_theta_out, 4);
    EXPECT_EQ(back.n_phi, 6);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.values, file.values);
  }
}

TEST(Grid, PartsOfAFile) {
  const std::vector<float> a(12, 1.0f), b(12, 2.0f);
  const std::string both = make_mbsdf(0, 2, 3, a, "MBSDF_DATA_TRANSMISSION=\n") + make_mbsdf(0, 2, 3, b).substr(20);
  Problems problems;
  const MbsdfFile file = parse(both, problems);
  EXPECT_EQ(file.values, b);
  EXPECT_TRUE(file.has_transmission);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].field, "transmission");
  EXPECT_EQ(message(make_mbsdf(0, 2, 3, a, "maker=someone\nMBSDF_DATA=\n")), "no error");
  EXPECT_THAT(message(make_mbsdf(0, 2, 3, a, "MBSDF_DATA_TRANSMISSION=\n")), HasSubstr("transmission alone"));
  EXPECT_THAT(message("NVIDIA ARC MBSDF V1\n"), HasSubstr("reflection: found none"));
  EXPECT_THAT(message(make_mbsdf(0, 2, 3, a) + make_mbsdf(0, 2, 3, a).substr(20)),
              HasSubstr("reflection: found a second part"));
}

TEST(Grid, DamagedFilesAreNamed) {
  const std::vector<float> values(12, 1.0f);
  EXPECT_THAT(message(make_mbsdf(2, 2, 3, values)), HasSubstr("reflection type: found 2"));
  EXPECT_THAT(message(make_mbsdf(1, 2, 3, values)), HasSubstr("reflection values: found 48 bytes, expected 144"));
  EXPECT_THAT(message(make_mbsdf(0, 0, 3, values)), HasSubstr("reflection n_theta: found 0"));
  EXPECT_THAT(message(make_mbsdf(0, 0xffffffffu, 0xffffffffu, values)),
              HasSubstr("reflection n_phi: found 4294967295"));
  EXPECT_THAT(message(make_mbsdf(0, 16384, 16384, values)), HasSubstr("reflection values"));
  EXPECT_THAT(message(make_mbsdf(0, 1, 1, values)), HasSubstr("header: found binary data"));
}

TEST(Grid, MeasuredFiles) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const std::filesystem::path folder = test_data() / "mbsdf";
  for (const char* name : {"carpaint_blue.mbsdf", "carpaint_red.mbsdf"}) {
    const MbsdfFile file = read_mbsdf(folder / name);
    EXPECT_EQ(file.n_theta_in, 45);
    EXPECT_EQ(file.n_phi, 90);
    EXPECT_GT(MbsdfTable(file).cells().negative, 0u);
  }
  EXPECT_EQ(read_mbsdf(folder / "test_reflection_scalar_theta_2_phi_3.mbsdf").channels, 1);
  EXPECT_EQ(read_mbsdf(folder / "test_rgb_theta_2_phi_3.mbsdf").channels, 3);
  EXPECT_THROW(read_mbsdf(folder / "test_none.mbsdf"), Error);
  EXPECT_THROW(read_mbsdf(folder / "test_file_format_error.mbsdf"), Error);
}

}  // namespace
}  // namespace gonio
