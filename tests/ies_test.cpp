#include <gonio/mapping/error.h>
#include <gonio/mapping/light/ies.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "light_cases.h"

namespace gonio {
namespace {

using testing::rad;

std::string plain(const std::string& horizontal, const std::string& values,
                  const std::string& counts, const std::string& vertical = "0 45 90",
                  const std::string& type = "1", const std::string& factors = "1 1 10",
                  const std::string& multiplier = "1") {
  return "IESNA:LM-63-2002\n[TEST] t\n[TESTLAB] l\n[ISSUEDATE] d\n[MANUFAC] m\nTILT=NONE\n1 -1 " +
         multiplier + " " + counts + " " + type + " 2 0 0 0\n" + factors + "\n" + vertical + "\n" +
         horizontal + "\n" + values + "\n";
}

/// Intensity in the plane that the file calls `h`, at its vertical angle `v` (both in degrees).
double at(const Luminaire& light, double h, double v) {
  return light.diagram.intensity(LightFrame{}.direction(rad(h + 90), rad(v)));
}

TEST(Ies, EveryFieldIsRead) {
  const std::string text =
      "IESNA91\r\n[TEST] T1\r\n[MANUFAC] Maker\r\n[MORE] and sons\r\n[LUMCAT] "
      "X\r\nTILT=INCLUDE\r\n1\r\n3\r\n"
      "0 45 90\r\n1.0 0.9 0.8\r\n2 1500 2.5 3 1 1 1 1 2 0.5\r\n0.9 0.8 42\r\n0 45 90\r\n0\r\n10 5 "
      "1\r\n";
  Deviations deviations;
  const IesFile f = read_ies(text, "a", deviations);
  EXPECT_EQ(f.standard, "IESNA91");
  EXPECT_EQ(f.keyword("MANUFAC"), "Maker and sons");
  EXPECT_EQ(f.tilt_factors, (std::vector<double>{1.0, 0.9, 0.8}));
  EXPECT_EQ(f.lamps, 2);
  EXPECT_EQ(f.lumens_per_lamp, 1500);
  EXPECT_EQ(f.units, 1);
  EXPECT_EQ(f.length, 2);
  EXPECT_EQ(f.watts, 42);
  EXPECT_DOUBLE_EQ(f.factor(), 2.5 * 0.9 * 0.8);  // 1991: the second factor is one
  EXPECT_EQ(f.candela, (std::vector<double>{10, 5, 1}));
  EXPECT_TRUE(deviations.empty());

  LightOptions tilted;
  tilted.tilt = rad(67.5);
  const Luminaire upright = to_luminaire(f, "a", {}, deviations);
  const Luminaire hanging = to_luminaire(f, "a", tilted, deviations);
  EXPECT_NEAR(max_intensity(hanging.diagram) / max_intensity(upright.diagram), 0.85, 1e-12);
  EXPECT_DOUBLE_EQ(*upright.lamp_lumens, 3000);
  EXPECT_NEAR(upright.size.y, 2 * 0.3048,
              1e-12);  // the length lies along the 0-degree plane: y here
}

TEST(Ies, LaterStandardsHaveNoSecondFactor) {
  IesFile f;
  f.standard = "IES:LM-63-2019";
  f.second_factor = 1.1;
  EXPECT_EQ(f.factor(), 1);
  f.standard.clear();
  EXPECT_EQ(f.factor(), 1.1);  // 1986
}

// The horizontal angles imply the symmetry; every range of the standard, and some that are not in
// it.
TEST(Ies, SymmetriesUnfold) {
  const auto light = [](const std::string& h, const std::string& values, const std::string& count) {
    return testing::from_ies(plain(h, values, "3 " + count));
  };
  const Luminaire one = light("0", "9 6 3", "1");
  for (double h : {0.0, 77.0, 200.0}) EXPECT_NEAR(at(one, h, 45), 6, 1e-12);

  const Luminaire quadrant = light("0 45 90", "9 1 0  9 2 0  9 3 0", "3");
  for (double h : {0.0, 180.0}) EXPECT_NEAR(at(quadrant, h, 45), 1, 1e-12);
  for (double h : {45.0, 135.0, 225.0, 315.0}) EXPECT_NEAR(at(quadrant, h, 45), 2, 1e-12);
  for (double h : {90.0, 270.0}) EXPECT_NEAR(at(quadrant, h, 45), 3, 1e-12);

  const Luminaire half = light("0 90 180", "9 1 0  9 2 0  9 3 0", "3");
  EXPECT_NEAR(at(half, 0, 45), 1, 1e-12);
  for (double h : {90.0, 270.0}) EXPECT_NEAR(at(half, h, 45), 2, 1e-12);
  EXPECT_NEAR(at(half, 180, 45), 3, 1e-12);

  const Luminaire other = light("90 180 270", "9 1 0  9 2 0  9 3 0", "3");
  EXPECT_NEAR(at(other, 90, 45), 1, 1e-12);
  for (double h : {0.0, 180.0}) EXPECT_NEAR(at(other, h, 45), 2, 1e-12);
  EXPECT_NEAR(at(other, 270, 45), 3, 1e-12);

  const Luminaire full = light("0 90 180 270 360", "9 1 0  9 2 0  9 3 0 9 4 0 9 1 0", "5");
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(at(full, 90 * k, 45), k + 1, 1e-12);
  EXPECT_NEAR(at(full, 315, 45), 2.5, 1e-12);

  const Luminaire open = light("0 90 180 270", "9 1 0  9 2 0  9 3 0 9 4 0", "4");  // 360 left out
  EXPECT_NEAR(at(open, 315, 45), 2.5, 1e-12);
}

TEST(Ies, UglyFilesLoad) {
  const std::string clean = plain("0 90", "9,1,0\t9 , 2,0", "3 2");
  const Luminaire expected = testing::from_ies(plain("0 90", "9 1 0 9 2 0", "3 2"));
  std::string crlf;
  for (char c : clean) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::string cr = clean;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  for (const std::string& text : {clean, "\xEF\xBB\xBF" + clean, crlf, cr}) {
    EXPECT_EQ(light_format(text), LightFormat::ies);
    EXPECT_EQ(testing::from_ies(text).diagram.cd, expected.diagram.cd);
  }
  Deviations deviations;
  read_ies(clean + "END OF FILE 1 2 3", "a", deviations);
  ASSERT_EQ(deviations.size(), 1u);
  EXPECT_NE(to_string(deviations[0]).find("END OF FILE"), std::string::npos);
}

TEST(Ies, BrokenFilesAreRejectedWithLineAndField) {
  const auto message = [](const std::string& text) {
    try {
      testing::from_ies(text);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message("IESNA91\nTILT=NONE\nfile format error\n1 0").find("line 3: number of lamps"),
            std::string::npos);
  EXPECT_NE(message("IESNA91\n[TEST]\n").find("TILT"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1", "3 1")).find("candela values: found the end"),
            std::string::npos);
  EXPECT_NE(message(plain("0", "9 nan 0", "3 1")).find("candela values"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 0")).find("number of horizontal angles"),
            std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 45 90", "4")).find("photometric type"),
            std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 90 45")).find("ascending"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 45 90", "1", "0 1 10")).find("ballast factor"),
            std::string::npos);
  EXPECT_EQ(message(plain("0", "9 1 0", "3 1")), "accepted");
}

// No prefix of a file may crash or be taken for the whole.
TEST(Ies, TruncatedFilesAreRejected) {
  const std::string text = testing::ies_text(testing::lambertian());
  const std::size_t last_value = text.find_last_not_of("\r\n ");
  for (std::size_t length = 0; length < last_value; length += 7)
    EXPECT_THROW(testing::from_ies(text.substr(0, length)), Error) << length;
}

TEST(Ies, ShortTablesAreDarkBeyond) {
  const Luminaire light = testing::from_ies(plain("0", "9 6 3", "3 1", "0 30 60"));
  EXPECT_NEAR(at(light, 0, 59.9), 3.01, 0.01);
  EXPECT_EQ(at(light, 0, 60.01), 0);
  EXPECT_EQ(at(light, 0, 120), 0);
}

TEST(Ies, NegativeValuesAndUnequalPolesAreTold) {
  Deviations deviations;
  const Luminaire light = to_luminaire(
      read_ies(plain("0 90", "9 -1 0  7 2 0", "3 2"), "a", deviations), "a", {}, deviations);
  ASSERT_EQ(deviations.size(), 2u);
  EXPECT_NEAR(at(light, 0, 0), 8, 1e-12);
  EXPECT_EQ(at(light, 0, 45), 0);
}

// Type B: polar axis horizontal. V turns the plane from the nadir towards the 0-degree plane, H is
// the angle in that plane, towards 90 degrees if counter-clockwise.
TEST(Ies, TypeB) {
  const std::string text =
      plain("-90 -45 0 45 90", "0 0 0  0 1 2  0 3 4  0 5 6  0 0 0", "3 5", "-90 0 45", "2");
  const Luminaire light = testing::from_ies(text);
  const LightFrame frame;
  const Vec3<double> along = frame.direction(rad(90), rad(90)),
                     aside = frame.direction(rad(180), rad(90));
  const auto direction = [&](double h, double v) {
    return std::cos(rad(h)) * (std::cos(rad(v)) * frame.nadir + std::sin(rad(v)) * along) +
           std::sin(rad(h)) * aside;
  };
  const auto value = [&](const Luminaire& l, double h, double v) {
    return l.diagram.intensity(direction(h, v));
  };
  EXPECT_NEAR(value(light, 0, 0), 3, 1e-9);
  EXPECT_NEAR(value(light, -45, 0), 1, 1e-9);
  EXPECT_NEAR(value(light, 45, 0), 5, 1e-9);
  EXPECT_NEAR(value(light, 22.5, 20), 4 + 20.0 / 45, 1e-9);
  EXPECT_EQ(value(light, 0, 50), 0);   // beyond the last V
  EXPECT_EQ(value(light, 0, 180), 0);  // the back
  LightOptions clockwise;
  clockwise.clockwise = true;
  EXPECT_NEAR(value(testing::from_ies(text, clockwise), -45, 0), 5, 1e-9);
  // Converted to type C it shines the same way.
  const Luminaire c = testing::from_ies(testing::ies_text(light));
  EXPECT_LT(std::abs(value(c, 20, 10) / value(light, 20, 10) - 1), 0.01);
  EXPECT_NEAR(flux(c.diagram) / flux(light.diagram), 1, 0.01);
}

// Type A: polar axis vertical, (0, 0) horizontal in the 0-degree plane.
TEST(Ies, TypeA) {
  const std::string text = plain("-30 0 30", "0 1 0  0 5 0  0 2 0", "3 3", "-45 0 45", "3");
  const Luminaire light = testing::from_ies(text);
  EXPECT_NEAR(at(light, 0, 90), 5, 1e-9);
  EXPECT_NEAR(at(light, 30, 90), 2, 1e-9);
  EXPECT_NEAR(at(light, -30, 90), 1, 1e-9);
  EXPECT_NEAR(at(light, 15, 112.5), 1.75, 1e-9);
  EXPECT_EQ(at(light, 31, 90), 0);
  EXPECT_EQ(at(light, 180, 90), 0);
  // From 0: mirrored.
  const Luminaire half = testing::from_ies(plain("0 30", "0 5 0  0 2 0", "3 2", "-45 0 45", "3"));
  EXPECT_NEAR(at(half, -30, 90), 2, 1e-9);
}

TEST(Ies, RoundTrip) {
  for (const Luminaire& light :
       {testing::lambertian(), testing::asymmetric(), testing::narrow_spot(), testing::uplight()}) {
    const Luminaire again = testing::from_ies(testing::ies_text(light));
    EXPECT_LT(testing::largest_difference(light.diagram, again.diagram), 1e-6) << light.name;
    EXPECT_EQ(again.lamp_lumens, light.lamp_lumens);
    EXPECT_EQ(testing::ies_text(again), testing::ies_text(light));
  }
  EXPECT_EQ(to_ies(testing::lambertian()).horizontal.size(), 1u);
}

}  // namespace
}  // namespace gonio
