#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/brdf/table/validate.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;
using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<std::string> texts(const Problems& problems) {
  std::vector<std::string> result;
  for (const Problem& problem : problems) result.push_back(to_string(problem));
  return result;
}

bool usable(const Problems& problems) {
  return std::none_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; });
}

TEST(Validate, FaultlessFiles) {
  const TemporaryFolder folder;
  write_merl(folder / "m", make_merl([](int, int, int) { return 0.5 / pi; }));
  write_file(folder / "g", make_mbsdf(0, 2, 3, std::vector<float>(12, 0.3f)));
  write_file(folder / "r", make_rgl({0.1f, 0.1f, 0.1f}).bytes());
  for (const char* name : {"m", "g", "r"}) {
    EXPECT_THAT(texts(validate_table(folder / name)), ::testing::IsEmpty()) << name;
  }
}

TEST(Validate, ListsEveryProblem) {
  const TemporaryFolder folder;
  TensorBuilder file = make_rgl();
  file.remove("jacobian");
  file["ndf"].shape = {8};
  const float theta[3] = {0.0f, 2.0f, 1.0f};
  std::memcpy(file["theta_i"].data.data(), theta, sizeof(theta));
  write_file(folder / "r", file.bytes());
  const auto problems = validate_table(folder / "r");
  EXPECT_FALSE(usable(problems));
  EXPECT_THAT(texts(problems), Contains(HasSubstr("jacobian: found no such field")));
  EXPECT_THAT(texts(problems), Contains(HasSubstr("ndf: found f32 [8]")));
  EXPECT_THAT(texts(problems), Contains(HasSubstr("theta_i[1]: found 2.0")));
  EXPECT_THAT(texts(problems), Contains(HasSubstr("theta_i[2]: found 1.0")));
}

TEST(Validate, DoubtsThatDoNotForbidUse) {
  const TemporaryFolder folder;
  std::vector<float> values(12, 0.5f);
  values[3] = -1.0f;
  values[7] = std::nanf("");
  write_file(folder / "g", make_mbsdf(0, 2, 3, values));
  const auto problems = validate_table(folder / "g");
  EXPECT_TRUE(usable(problems));
  EXPECT_THAT(texts(problems), Contains("cells: found 1 negative of 12, expected none"));
  EXPECT_THAT(texts(problems), Contains("cells: found 1 not finite of 12, expected none"));
  EXPECT_THAT(texts(problems), Contains(HasSubstr("albedo at 2 degrees: found 1.")));
  write_file(folder / "black", make_mbsdf(0, 2, 3, std::vector<float>(12, 0.0f)));
  EXPECT_THAT(texts(validate_table(folder / "black")), Contains(HasSubstr("albedo: found 0")));
  write_merl(folder / "m", make_merl([](int h, int, int p) { return h == 3 && p == 7 ? -1.0 : 0.1; }));
  EXPECT_THAT(texts(validate_table(folder / "m")), Contains(HasSubstr("missing (not measured)")));
}

TEST(Validate, NaNFilledFiles) {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  write_merl(folder / "m", make_merl([&](int, int, int) { return nan; }));
  write_file(folder / "g", make_mbsdf(1, 1, 1, std::vector<float>(3, std::nanf(""))));
  write_file(folder / "r", make_rgl(glm::vec3(std::nanf(""))).bytes());
  for (const char* name : {"m", "g", "r"}) {
    const auto problems = validate_table(folder / name);
    EXPECT_FALSE(usable(problems)) << name;
    EXPECT_THAT(texts(problems), Contains(HasSubstr("no valid"))) << name;
  }
}

// Every prefix of a file is damaged and says so.
TEST(Validate, TruncatedAnywhere) {
  const TemporaryFolder folder;
  const std::string files[] = {make_rgl().bytes(), make_mbsdf(1, 2, 2, std::vector<float>(24, 0.1f))};
  for (const std::string& bytes : files) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      write_file(folder / "x", bytes.substr(0, size));
      const auto problems = validate_table(folder / "x");
      ASSERT_FALSE(usable(problems)) << size << " of " << bytes.size();
      ASSERT_FALSE(problems[0].field.empty() || problems[0].found.empty());
    }
  }
  const std::string merl = file_bytes([&] {
    write_merl(folder / "m", make_merl([](int, int, int) { return 0.1; }));
    return folder / "m";
  }());
  for (const std::size_t size : {0ul, 3ul, 11ul, 12ul, 13ul, 1000000ul, merl.size() - 1}) {
    write_file(folder / "x", merl.substr(0, size));
    EXPECT_FALSE(usable(validate_table(folder / "x"))) << size;
  }
  write_file(folder / "x", merl + "x");
  EXPECT_THAT(texts(validate_table(folder / "x")), Contains(HasSubstr("file size: found 34992013")));
}

// One byte changed anywhere: whatever comes out, nothing is read past the end (run under a
// sanitizer) and what loads evaluates.
TEST(Validate, AnyByteChanged) {
  const std::string rgl = make_rgl().bytes();
  const std::string mbsdf = make_mbsdf(1, 2, 2, std::vector<float>(24, 0.1f));
  int refused = 0, loaded = 0;
  for (const std::string* original : {&rgl, &mbsdf}) {
    for (std::size_t i = 0; i < original->size(); ++i) {
      for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
        std::string bytes = *original;
        bytes[i] = static_cast<char>(value);
        Problems problems;
        if (original == &mbsdf) {
          parse_mbsdf(bytes, problems);
        } else {
          RglFile file = parse_rgl(bytes, problems);
          if (usable(problems)) {
            try {
              const RglTable table(std::move(file), {});
              table.eval(direction(0.3, 0.1), direction(0.8, 2.0));
              table.sample(direction(0.3, 0.1), 0.2f, 0.7f);
            } catch (const std::runtime_error&) {
            }
          }
        }
        ++(usable(problems) ? loaded : refused);
      }
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(loaded, 100);
}

TEST(Validate, MislabelledFiles) {
  const TemporaryFolder folder;
  std::string rgl = make_rgl().bytes();
  write_file(folder / "a", "NVIDIA ARC MBSDF V1\n" + rgl);
  write_file(folder / "b", "tensor_file" + make_mbsdf(0, 1, 1, {1.0f}));
  rgl[12] = 9;
  write_file(folder / "c", rgl);
  EXPECT_THAT(texts(validate_table(folder / "a")), Contains(HasSubstr("header: found binary data")));
  EXPECT_THAT(texts(validate_table(folder / "b")), Contains(HasSubstr("magic: found")));
  EXPECT_THAT(texts(validate_table(folder / "c")), Contains(HasSubstr("container version: found 9.0")));
  EXPECT_THAT(texts(validate_table(folder / "none")), Contains(HasSubstr("no such file")));
}

TEST(Validate, MeasuredFiles) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  EXPECT_TRUE(validate_table(test_data() / "rgl/paper_white_rgb.bsdf").empty());
  const auto satin = validate_table(test_data() / "rgl/satin_rosaline_rgb.bsdf");
  EXPECT_TRUE(usable(satin));
  EXPECT_THAT(texts(satin), Contains(HasSubstr("albedo at 80 degrees: found 1.1")));
  EXPECT_FALSE(usable(validate_table(test_data() / "mbsdf/test_none.mbsdf")));
  EXPECT_FALSE(usable(validate_table(test_data() / "mbsdf/test_file_format_error.mbsdf")));
}

}  // namespace
}  // namespace gonio
