#include <gonio/mapping/error.h>
#include <gonio/mapping/light/eulumdat.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>

#include "light_cases.h"

namespace gonio {
namespace {

using testing::rad;

/// Planes every 30 degrees, gamma 0 45 90; the stored plane number k holds 100 (k + 1) at 45
/// degrees.
std::string text_of(int isym, int stored, const char* end = "\r\n", const char* factor = "1") {
  std::string t;
  const auto line = [&](const std::string& s) { t += s + end; };
  line("Company");
  line("1");
  line(std::to_string(isym));
  line("12");
  line("30");
  line("3");
  line("45");
  for (const char* s : {"report", "name", "number", "file", "date", "100", "0", "50", "100", "0",
                        "0", "0", "0", "0", "100", "80", factor, "0"})
    line(s);
  line("2");
  for (const char* s : {"1", "lamp", "2000", "3000", "90", "20"}) line(s);
  for (const char* s : {"2", "lamps", "4000", "3000", "90", "40"}) line(s);
  for (int k = 0; k < 10; ++k) line("0.5");
  for (int k = 0; k < 12; ++k) line(std::to_string(30 * k));
  for (const char* s : {"0", "45", "90"}) line(s);
  for (int k = 0; k < stored; ++k) {
    line("50");
    line(std::to_string(100 * (k + 1)));
    line("0");
  }
  return t;
}

/// The number of the stored plane that is seen at `c` degrees.
double plane(const Luminaire& light, double c) {
  return light.diagram.intensity(LightFrame{}.direction(rad(c), rad(45))) /
             (100 * *light.lamp_lumens / 1000) -
         1;
}

TEST(Eulumdat, SymmetriesUnfold) {
  const Luminaire none = testing::from_eulumdat(text_of(0, 12));
  for (int k = 0; k < 12; ++k) EXPECT_NEAR(plane(none, 30 * k), k, 1e-9);
  const Luminaire rotational = testing::from_eulumdat(text_of(1, 1));
  EXPECT_NEAR(plane(rotational, 123), 0, 1e-9);
  EXPECT_TRUE(rotational.diagram.rotational());
  const Luminaire c0 = testing::from_eulumdat(text_of(2, 7));
  for (int k = 0; k < 7; ++k) {
    EXPECT_NEAR(plane(c0, 30 * k), k, 1e-9);
    EXPECT_NEAR(plane(c0, 360 - 30 * k), k, 1e-9);
  }
  // The format stores C270 through C0 to C90: the first plane is C270, not C90.
  const Luminaire c90 = testing::from_eulumdat(text_of(3, 7));
  for (int k = 0; k < 7; ++k) {
    EXPECT_NEAR(plane(c90, 270 + 30 * k), k, 1e-9);
    EXPECT_NEAR(plane(c90, 270 - 30 * k), k, 1e-9);
  }
  const Luminaire quadrant = testing::from_eulumdat(text_of(4, 4));
  for (int k = 0; k < 4; ++k)
    for (int c : {30 * k, 180 - 30 * k, 180 + 30 * k, 360 - 30 * k})
      EXPECT_NEAR(plane(quadrant, c), k, 1e-9);
}

TEST(Eulumdat, FactorsAndLampSets) {
  Deviations deviations;
  const Luminaire light = testing::from_eulumdat(text_of(1, 1, "\n", "1.5"));
  EXPECT_DOUBLE_EQ(max_intensity(light.diagram), 100 * 2.0 * 1.5);
  EXPECT_DOUBLE_EQ(*light.stated_lumens, 2000 * 0.8);
  EXPECT_TRUE(light.round);
  LightOptions second;
  second.lamp_set = 1;
  const Luminaire other = testing::from_eulumdat(text_of(1, 1), second);
  EXPECT_DOUBLE_EQ(max_intensity(other.diagram), 100 * 4.0);
  EXPECT_EQ(other.watts, 40);
  second.lamp_set = 2;
  EXPECT_THROW(testing::from_eulumdat(text_of(1, 1), second), Error);
}

TEST(Eulumdat, UglyFilesLoad) {
  const std::vector<double> expected = testing::from_eulumdat(text_of(2, 7)).diagram.cd;
  std::string commas = text_of(2, 7, "\n", "1,0");
  for (const std::string& text :
       {text_of(2, 7, "\n"), text_of(2, 7, "\r"), "\xEF\xBB\xBF" + text_of(2, 7), commas,
        text_of(2, 7) + "\r\n\r\n\x1a"}) {
    EXPECT_EQ(light_format(text), LightFormat::eulumdat);
    EXPECT_EQ(testing::from_eulumdat(text).diagram.cd, expected);
  }
  EXPECT_EQ(light_format("just some text\nmore\n"), LightFormat::unknown);
  EXPECT_EQ(light_format(""), LightFormat::unknown);
}

TEST(Eulumdat, BrokenFilesAreRejectedWithLineAndField) {
  const std::string good = text_of(2, 7);
  std::string bad = good;
  bad.replace(bad.find("\r\n12\r\n"), 6, "\r\nxx\r\n");
  try {
    testing::from_eulumdat(bad);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 4: Mc: found \"xx\""), std::string::npos)
        << error.what();
  }
  const std::size_t last = good.find_last_not_of("\r\n ");
  for (std::size_t length = 0; length < last; length += 3)
    EXPECT_THROW(testing::from_eulumdat(good.substr(0, length)), Error) << length;
}

TEST(Eulumdat, RoundTrip) {
  Luminaire mirrored = testing::asymmetric();  // symmetric about C90-C270, strongest towards C90
  mirrored.diagram = testing::tabulate(36, 36, pi<double>, [](double c, double g) {
    return 100 * (2 + std::sin(c)) * std::exp(-g);
  });
  EXPECT_EQ(find_symmetry(mirrored.diagram), LightSymmetry::c90_c270);
  for (const Luminaire& light : {testing::lambertian(), testing::asymmetric(),
                                 testing::narrow_spot(), mirrored, testing::uplight()}) {
    const EulumdatFile file = to_eulumdat(light);
    EXPECT_EQ(file.intensity.size(), file.stored_c().size() * file.gamma.size()) << light.name;
    Deviations deviations;
    read_eulumdat(testing::eulumdat_text(light), "test.ldt", deviations);
    for (const Deviation& d : deviations) ADD_FAILURE() << light.name << ": " << to_string(d);
    const Luminaire again = testing::from_eulumdat(testing::eulumdat_text(light));
    EXPECT_LT(testing::largest_difference(light.diagram, again.diagram), 1e-6) << light.name;
    EXPECT_NEAR(again.downward_fraction.value(),
                flux(light.diagram, 0, rad(90)) / flux(light.diagram), 1e-6);
    const Luminaire through = testing::from_ies(testing::ies_text(again));
    EXPECT_LT(testing::largest_difference(light.diagram, through.diagram), 1e-6) << light.name;
  }
}

// The same luminaire written in both formats: the numbers differ by the 90 degrees between the two
// conventions, the light does not.
TEST(Eulumdat, IesZeroIsC90) {
  const Luminaire light = testing::asymmetric();
  const IesFile ies = to_ies(light);
  const EulumdatFile ldt = to_eulumdat(light);
  const std::size_t n = ies.vertical.size();
  const std::size_t g40 = 8;  // gamma = 40 degrees
  EXPECT_DOUBLE_EQ(ldt.gamma[g40], 40);
  const auto strongest = [&](const std::vector<double>& c, const std::vector<double>& values) {
    double best = -1, where = -1;
    for (std::size_t i = 0; i < c.size() && c[i] < 360; ++i)
      if (values[i * n + g40] > best) best = values[i * n + g40], where = c[i];
    return where;
  };
  EXPECT_NEAR(strongest(ldt.c, ldt.intensity), 30, 1e-9);
  EXPECT_NEAR(strongest(ies.horizontal, ies.candela), 300, 1e-9);  // C30 is 60 degrees before C90
  LightOptions as_labelled;
  as_labelled.ies_zero = 0;
  EXPECT_NEAR(strongest(to_ies(light, as_labelled).horizontal, to_ies(light, as_labelled).candela),
              30, 1e-9);
}

// Type B: V turns the plane about the horizontal axis, H is the latitude from it: dw = cos H dH dV.
// 20 x 20 midpoints in each cell; angles that start at 0 are mirrored.
double type_b_quadrature(const IesFile& f) {
  const std::vector<double>&h = f.horizontal, &v = f.vertical;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < h.size(); ++i)
    for (std::size_t j = 0; j + 1 < v.size(); ++j)
      for (int k = 0; k < 20; ++k)
        for (int l = 0; l < 20; ++l) {
          const double s = (k + 0.5) / 20, t = (l + 0.5) / 20;
          const auto at = [&](std::size_t a, std::size_t b) { return f.candela[a * v.size() + b]; };
          const double value = (1 - s) * ((1 - t) * at(i, j) + t * at(i, j + 1)) +
                               s * ((1 - t) * at(i + 1, j) + t * at(i + 1, j + 1));
          sum += value * std::cos(rad(h[i] + s * (h[i + 1] - h[i]))) * rad(h[i + 1] - h[i]) *
                 rad(v[j + 1] - v[j]) / 400;
        }
  return (h.front() == 0 ? 2 : 1) * (v.front() == 0 ? 2 : 1) * sum;
}

// Quadrature over the file's own numbers, the straightforward way.
double plain_quadrature(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  Deviations deviations;
  std::vector<double> c, g, v;
  double scale = 1;
  if (light_format(text) == LightFormat::ies) {
    const IesFile f = read_ies(text, path.string(), deviations);
    c = f.horizontal, g = f.vertical, v = f.candela, scale = f.factor();
    if (f.type == IesFile::Type::b) return f.factor() * type_b_quadrature(f);
  } else {
    const EulumdatFile f = read_eulumdat(text, path.string(), deviations);
    c = f.stored_c(), g = f.gamma, v = f.intensity,
    scale = f.lamp_sets[0].lumens / 1000 * f.conversion_factor;
  }
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    double w = c.size() == 1
                   ? 1
                   : ((i > 0 ? c[i] - c[i - 1] : 0) + (i + 1 < c.size() ? c[i + 1] - c[i] : 0)) / 2;
    if (c.size() > 1 && c.back() - c.front() > 300 && c.back() - c.front() < 359.9 &&
        (i == 0 || i + 1 == c.size()))
      w += (360 - c.back() + c.front()) / 2;  // the gap between the last plane and 360
    double plane = 0;
    for (std::size_t j = 0; j + 1 < g.size(); ++j) {
      for (int k = 0; k < 20; ++k) {  // midpoints between the values
        const double t = (k + 0.5) / 20, width = rad(g[j + 1] - g[j]);
        const double value = (1 - t) * v[i * g.size() + j] + t * v[i * g.size() + j + 1];
        plane += value * std::sin(rad(g[j]) + t * width) * width / 20;
      }
    }
    sum += w * plane, weight += w;
  }
  return scale * sum / weight * rad(360);
}

TEST(PhotometricFiles, LoadWithTheirFlux) {
  const auto files = testing::photometric_files();
  if (files.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  // Files that state something else than the flux of their own numbers.
  const std::map<std::string, std::string> reasons = {
      {"B1_module.ies", "states the flux before its multiplier of 1.32"},
      {"multiple_lamp_sets.ldt", "invented numbers"},
      {"no_symmetry.ldt", "invented numbers"},
      {"symmetry_about_vertical_axis.ldt", "invented numbers"},
      {"symmetry_to_c0c180.ldt", "invented numbers"},
      {"symmetry_to_c0c90c180c270.ldt", "invented numbers"},
      {"symmetry_to_c90c270.ldt", "invented numbers"}};
  int stated = 0;
  for (const auto& path : files) {
    SCOPED_TRACE(path.string());
    const auto start = std::chrono::steady_clock::now();
    const Luminaire light = load_light(path);
    const double ms =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() * 1e3;
    const double lumens = flux(light.diagram), quadrature = plain_quadrature(path);
    EXPECT_NEAR(lumens / quadrature, 1, 0.01);
    const std::string name = path.filename().string();
    std::string remark = "states none";
    if (light.stated_lumens) {
      const double off = lumens / *light.stated_lumens - 1;
      char text[80];
      std::snprintf(text, sizeof text, "stated %.2f, off by %.2f %%", *light.stated_lumens,
                    100 * off);
      remark = text;
      const auto reason = reasons.find(name);
      if (reason == reasons.end()) {
        EXPECT_LT(std::abs(off), 0.05);
        ++stated;
      } else {
        EXPECT_GT(std::abs(off), 0.05) << "no longer an exception";
        remark += ": " + reason->second;
      }
    }
    std::printf("%-36s %4zu x %-3zu %10.2f lm, quadrature %+.3f %%, %s; loaded in %.1f ms\n",
                name.c_str(), light.diagram.c.size(), light.diagram.gamma.size(), lumens,
                100 * (lumens / quadrature - 1), remark.c_str(), ms);
  }
  EXPECT_GT(stated, 15);
  EXPECT_THROW(load_light(std::filesystem::path(std::getenv("GONIO_TEST_DATA")) /
                          "photometric/mdl-sdk/test_file_format_error.ies"),
               Error);
}

TEST(PhotometricFiles, SurviveBothFormats) {
  const auto files = testing::photometric_files();
  if (files.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  for (const auto& path : files) {
    SCOPED_TRACE(path.string());
    const Luminaire light = load_light(path);
    if (light.format.find("type B") != std::string::npos) continue;  // tabulated anew: not exact
    EXPECT_LT(testing::largest_difference(
                  light.diagram, testing::from_ies(testing::ies_text(light)).diagram, 5000),
              1e-6);
    EXPECT_LT(
        testing::largest_difference(
            light.diagram, testing::from_eulumdat(testing::eulumdat_text(light)).diagram, 5000),
        1e-6);
  }
}

}  // namespace
}  // namespace gonio
