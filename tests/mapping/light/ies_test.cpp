#include <algorithm>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/files/ies.h>
#include <gonio/mapping/light/files/text_scanner.h>

#include "tests/support/light_cases.h"

namespace gonio {
namespace {

using testing::rad;

std::string plain(const std::string& horizontal, const std::string& values, const std::string& counts,
                  const std::string& vertical = "0 45 90", const std::string& type = "1",
                  const std::string& factors = "1 1 10", const std::string& multiplier = "1") {
  return "IESNA:LM-63-2002\n[TEST] t\n[TESTLAB] l\n[ISSUEDATE] d\n[MANUFAC] m\nTILT=NONE\n1 -1 " + multiplier + " " +
         counts + " " + type + " 2 0 0 0\n" + factors + "\n" + vertical + "\n" + horizontal + "\n" + values + "\n";
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
  Problems deviations;
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

// The second factor is the ballast-lamp photometric factor of 1986 and 1991. 1995 and 2002 call it
// future use, 2019 has the way the file was made there: neither is a factor.
TEST(Ies, SecondFactorIsOneTo1991) {
  struct Case {
    const char* first_line;
    int edition;
    double factor;
    int deviations;  // of the first line and the second factor
  };
  for (const Case& c :
       {Case{"IESNA91", 1991, 0.5, 0}, Case{"IESNA:LM-63-1991", 1991, 0.5, 0}, Case{"iesna91", 1991, 0.5, 1},
        Case{"IESNA:LM-63-1986", 1986, 0.5, 0}, Case{"a label", 1986, 0.5, 1}, Case{"IES 400 W lamps", 1986, 0.5, 1},
        Case{"IESNA:LM-63-1995", 1995, 1, 1}, Case{"IESNA95", 1995, 1, 2}, Case{"IESNA:LM-63-2002", 2002, 1, 1},
        Case{"iesna:lm-63-2002", 2002, 1, 2}, Case{"ANSI/IESNA LM-63-02", 2002, 1, 2},
        Case{"IES:LM-63-2019", 2019, 1, 0}, Case{"Ies: LM-63-2019", 2019, 1, 1}, Case{"IESNA:LM-63-2040", 0, 1, 2}}) {
    SCOPED_TRACE(c.first_line);
    Problems deviations;
    const IesFile f = read_ies(std::string(c.first_line) +
                                   "\n[TEST] t\n[TESTLAB] l\n[ISSUEDATE] d\n[MANUFAC] m\nTILT=NONE\n"
                                   "1 -1 2 3 1 1 2 0 0 0\n1 0.5 10\n0 45 90\n0\n9 6 3\n",
                               "a", deviations);
    EXPECT_EQ(f.edition(), c.edition);
    EXPECT_DOUBLE_EQ(f.factor(), 2 * c.factor);
    int found = 0;
    for (const Problem& d : deviations) found += d.field == "first line" || d.field == "future use";
    EXPECT_EQ(found, c.deviations);
  }
}

TEST(Ies, FutureUseOfZeroDoesNotDarken) {
  const std::string text = plain("0", "100 90 70 40 0", "5 1", "0 22.5 45 67.5 90", "1", "1 0 10");
  EXPECT_NEAR(flux(testing::from_ies(text).diagram),
              testing::rotational_flux({0, 22.5, 45, 67.5, 90}, {100, 90, 70, 40, 0}), 1e-9);
}

TEST(Ies, KeywordsAndTiltAreReadInAnySpelling) {
  const std::string good = plain("0", "9 6 3", "3 1");
  const LightDiagram expected = testing::from_ies(good).diagram;
  const auto with_tilt = [&](const std::string& line) {
    std::string text = good;
    return text.replace(text.find("TILT=NONE"), 9, line);
  };
  for (const char* line :
       {"Tilt=None", "TILT = NONE", "  tilt =none", "TILT=None", "TILT=20 wall washer\n[OTHER] label\nTILT=NONE"}) {
    SCOPED_TRACE(line);
    const std::string text = with_tilt(line);
    EXPECT_EQ(light_format(text), LightFormat::ies);
    Problems deviations;
    const IesFile file = read_ies(text, "a", deviations);
    EXPECT_EQ(file.tilt, IesFile::Tilt::none);
    EXPECT_EQ(to_luminaire(file, "a", {}, deviations).diagram.cd, expected.cd);
    EXPECT_EQ(deviations.size(), 1u);
  }
  Problems deviations;
  const IesFile included = read_ies(with_tilt("Tilt = Include\n1 2 0 90 1 0.5"), "a", deviations);
  EXPECT_EQ(included.tilt_factors, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(read_ies(with_tilt("TILT= lamp.tlt"), "a", deviations).tilt_file, "lamp.tlt");
  IesFile file;
  file.labels = {"[Manufac] Maker", "[more] and sons"};
  EXPECT_EQ(file.keyword("MANUFAC"), "Maker and sons");
}

// What commas between digits mean is what makes the counts come out.
TEST(Ies, CommasAreReadAsTheCountsHaveIt) {
  const auto cd = [](const std::string& text) {
    Problems deviations;
    return read_ies(text, "a", deviations).candela;
  };
  const auto counts = [](const std::string& text) {
    Problems deviations;
    read_ies(text, "a", deviations);
    return std::count_if(deviations.begin(), deviations.end(), [](const Problem& d) { return d.field == "commas"; });
  };
  using Values = std::vector<double>;
  // Decimal commas; those before a blank are separators all the same.
  for (const char* values : {"100,5 90,5 70,5", "100,5, 90,5, 70,5", "100,5;90,5;70,5"}) {
    const std::string text = plain("0", values, "3 1");
    EXPECT_EQ(cd(text), (Values{100.5, 90.5, 70.5})) << values;
    EXPECT_EQ(counts(text), 1) << values;
  }
  EXPECT_NEAR(flux(testing::from_ies(plain("0", "100,5 90,5 70,5 40,5 0,0", "5 1", "0 22.5 45 67.5 90")).diagram),
              testing::rotational_flux({0, 22.5, 45, 67.5, 90}, {100.5, 90.5, 70.5, 40.5, 0}), 1e-9);
  // Thousands.
  EXPECT_EQ(cd(plain("0", "1,234 1,100 950", "3 1")), (Values{1234, 1100, 950}));
  EXPECT_EQ(cd(plain("0", "1,234,567.5 12,100.25 950", "3 1")), (Values{1234567.5, 12100.25, 950}));
  EXPECT_EQ(counts(plain("0", "1,234 1,100 950", "3 1")), 1);
  std::string lumens = plain("0", "9 6 3", "3 1");
  lumens.replace(lumens.find("1 -1 1 3"), 8, "2 12,500 1 3");
  EXPECT_DOUBLE_EQ(*testing::from_ies(lumens).lamp_lumens, 25000);
  // Three decimals look like thousands until one cannot be: it begins with 0, or is no angle.
  EXPECT_EQ(cd(plain("0", "1,234 1,100 0,000", "3 1")), (Values{1.234, 1.1, 0}));
  EXPECT_EQ(cd(plain("0", "1,234 1,100 1,000", "3 1", "0 45,000 90,000")), (Values{1.234, 1.1, 1}));
  // Separators, as the standard has them: nothing to tell.
  const std::string separated = plain("0,90", "9,1,0,9,2,0", "3,2", "0,45,90", "1", "1,1,10");
  EXPECT_EQ(cd(separated), (Values{9, 1, 0, 9, 2, 0}));
  EXPECT_EQ(counts(separated), 0);
  // In TILT tables too.
  std::string tilt = plain("0", "9,5 6,5 3,5", "3 1");
  tilt.replace(tilt.find("TILT=NONE"), 9, "TILT=INCLUDE\n1 2\n0 90\n1,0 0,5");
  Problems deviations;
  EXPECT_EQ(read_ies(tilt, "a", deviations).tilt_factors, (Values{1, 0.5}));
  // No reading gives the counts.
  for (const char* values : {"100,5 90,5", "100,5 90,5 70,5 40,5", "1,234 90,5 70.5,5"})
    EXPECT_THROW(cd(plain("0", values, "3 1")), Error) << values;
}

TEST(Ies, NumbersMissingOrLeftOverAreErrors) {
  const auto message = [](const std::string& values) {
    try {
      testing::from_ies(plain("0 90", values, "3 2"));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message("9 1 0 9 2 0"), "accepted");
  EXPECT_EQ(message("9 1 0 9 2 0\nremarks, 1 2 3"), "accepted");
  EXPECT_NE(message("9 1 0 9 2").find("after 5 numbers, expected 6"), std::string::npos) << message("9 1 0 9 2");
  EXPECT_NE(message("9 1 0 9 2 0 7 8")
                .find("more numbers after the 6 of 2 horizontal and 3 vertical "
                      "angles: \"7 8\""),
            std::string::npos)
      << message("9 1 0 9 2 0 7 8");
}

// The symmetry is told in the luminaire's frame, where the 0-degree plane of IES files is C90.
TEST(Ies, SymmetryIsThatOfTheFrame) {
  for (const char* range : {"0 90 180", "180 270 360", "-180 -90 0", "90 180 270", "-90 0 90"})
    for (double zero : {90.0, 0.0, 180.0, -90.0}) {
      LightOptions options;
      options.ies_zero = rad(zero);
      const Luminaire light = testing::from_ies(plain(range, "9 1 0  9 2 0  9 3 0", "3 3"), options);
      EXPECT_NE(light.symmetry, LightSymmetry::none);
      EXPECT_EQ(light.symmetry, find_symmetry(light.diagram)) << range << " at " << zero;
    }
  const std::string bilateral = plain("0 90 180", "9 1 0  9 2 0  9 3 0", "3 3");
  EXPECT_EQ(testing::from_ies(bilateral).symmetry, LightSymmetry::c90_c270);
  LightOptions askew;
  askew.ies_zero = rad(45);
  EXPECT_EQ(testing::from_ies(bilateral, askew).symmetry, LightSymmetry::none);
}

TEST(Ies, LabelsOfTheOtherConventionAreTold) {
  const auto hint = [](const std::string& range, const std::string& size, double zero = 90) {
    std::string text = plain(range, "9 1 0  9 2 0  9 3 0", "3 3");
    text.replace(text.find("2 0 0 0\n"), 7, "2 " + size);
    LightOptions options;
    options.ies_zero = rad(zero);
    return testing::from_ies(text, options).other_zero;
  };
  EXPECT_EQ(hint("0 90 180", "0.1 1.2 0"), "");
  EXPECT_NE(hint("90 180 270", "0 0 0").find("90-270 plane"), std::string::npos);
  EXPECT_NE(hint("0 90 180", "1.2 0.1 0").find("longer across"), std::string::npos);
  EXPECT_EQ(hint("90 180 270", "1.2 0.1 0", 0), "");
}

// The shapes that sizes code (LM-63-1995 and 2002, "luminous opening").
TEST(Ies, RoundOpeningsKeepTheirSize) {
  struct Case {
    const char *standard, *size;
    Vec3<double> expected;  // across, along, up
    bool round;
  };
  for (const Case& c : {Case{"IESNA:LM-63-1995", "-0.5 0 0", {0.5, 0.5, 0}, true},
                        Case{"IESNA:LM-63-2002", "-0.5 0 0", {0.5, 0.5, 0}, true},
                        Case{"IESNA:LM-63-2002", "-0.5 -0.5 0", {0.5, 0.5, 0}, true},
                        Case{"IESNA:LM-63-1995", "-0.5 0 0.2", {0.5, 0.5, 0.2}, true},
                        Case{"IESNA:LM-63-1995", "-0.5 0 -0.5", {0.5, 0.5, 0.5}, true},
                        Case{"IESNA:LM-63-2002", "-0.5 0 -0.5", {0.5, 0, 0.5}, false},
                        Case{"IESNA:LM-63-2002", "-0.4 -0.8 0", {0.4, 0.8, 0}, true},
                        Case{"IESNA:LM-63-1995", "-0.4 0.8 0", {0.4, 0.8, 0}, true},
                        Case{"IESNA:LM-63-1995", "0 1.2 -0.1", {0.1, 1.2, 0.1}, false},
                        Case{"IESNA:LM-63-2002", "-0.1 1.2 -0.1", {0.1, 1.2, 0.1}, false},
                        Case{"IESNA:LM-63-2002", "0.3 0.6 0", {0.3, 0.6, 0}, false},
                        Case{"IESNA:LM-63-2002", "0 0 0", {0, 0, 0}, false}}) {
    SCOPED_TRACE(std::string(c.standard) + ": " + c.size);
    std::string text = plain("0", "9 6 3", "3 1");
    text.replace(0, 16, c.standard);
    text.replace(text.find("2 0 0 0\n"), 7, "2 " + std::string(c.size));
    const Luminaire light = testing::from_ies(text);
    EXPECT_EQ(light.size, c.expected);
    EXPECT_EQ(light.round, c.round);
    const std::string ies = testing::ies_text(light);
    EXPECT_EQ(ies.find("-0 "), std::string::npos) << ies;
    const Luminaire again = testing::from_ies(ies);
    EXPECT_EQ(again.size, light.size);
    EXPECT_EQ(again.round, light.round);
    const std::string ldt = testing::eulumdat_text(light);
    EXPECT_EQ(ldt.find("-0\r"), std::string::npos) << ldt;
    const Luminaire other = testing::from_eulumdat(ldt);
    EXPECT_LT(glm::length(other.size - light.size), 1e-6);
    EXPECT_EQ(other.round, light.round && light.size.x == light.size.y);
  }
}

TEST(Ies, Utf16IsConverted) {
  const std::string ascii = plain("0", "9 6 3", "3 1");
  const auto utf16 = [](const std::string& text, bool big) {
    std::string result;
    for (char c : text) result += big ? std::string{'\0', c} : std::string{c, '\0'};
    return result;
  };
  EXPECT_EQ(without_utf16("\xFF\xFE" + utf16(ascii, false)), ascii);
  EXPECT_EQ(without_utf16("\xFE\xFF" + utf16(ascii, true)), ascii);
  for (bool big : {false, true}) EXPECT_EQ(without_utf16(utf16(ascii, big)), ascii);
  EXPECT_EQ(without_utf16(ascii), ascii);
  EXPECT_EQ(without_utf16(""), "");
  // U+00FC, U+20AC, U+1F4A1 as a pair; half a character at the end is dropped.
  EXPECT_EQ(without_utf16({"\xFF\xFE\xFC\x00\xAC\x20\x3D\xD8\xA1\xDC\x41", 11}),
            "\xC3\xBC\xE2\x82\xAC\xF0\x9F\x92\xA1");
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
  Problems deviations;
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
  EXPECT_NE(message("IESNA91\nTILT=NONE\nfile format error\n1 0").find("line 3: number of lamps"), std::string::npos);
  EXPECT_NE(message("IESNA91\n[TEST]\n").find("TILT"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1", "3 1")).find("candela values: found the end"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 nan 0", "3 1")).find("candela values"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 0")).find("number of horizontal angles"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 45 90", "4")).find("photometric type"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 90 45")).find("ascending"), std::string::npos);
  EXPECT_NE(message(plain("0", "9 1 0", "3 1", "0 45 90", "1", "0 1 10")).find("ballast factor"), std::string::npos);
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
  Problems deviations;
  const Luminaire light =
      to_luminaire(read_ies(plain("0 90", "9 -1 0  7 2 0", "3 2"), "a", deviations), "a", {}, deviations);
  ASSERT_EQ(deviations.size(), 2u);
  EXPECT_NEAR(at(light, 0, 0), 8, 1e-12);
  EXPECT_EQ(at(light, 0, 45), 0);
}

TEST(Ies, DeviationsHaveTheUnitOfTheFile) {
  const auto told = [](const std::string& values) {
    std::string text = plain("0 180 360", values, "3 3");
    text.replace(text.find("TILT"), 0, "[_INTENSITYUNITS] mW/sr\n");
    Problems deviations;
    to_luminaire(read_ies(text, "a", deviations), "a", {}, deviations);
    std::string all;
    for (const Problem& d : deviations) all += to_string(d) + "\n";
    return all;
  };
  EXPECT_NE(told("9 1 0  7 2 0  9 1 0").find("7 to 9 mW/sr"), std::string::npos);
  EXPECT_NE(told("9 1 0  9 2 0  9 3 0").find("differ by up to 2 mW/sr"), std::string::npos);
}

// Type B: polar axis horizontal. V turns the plane from the nadir towards the 0-degree plane, H is
// the angle in that plane, towards 90 degrees if counter-clockwise.
TEST(Ies, TypeB) {
  const std::string text = plain("-90 -45 0 45 90", "0 0 0  0 1 2  0 3 4  0 5 6  0 0 0", "3 5", "-90 0 45", "2");
  const Luminaire light = testing::from_ies(text);
  const LightFrame frame;
  const Vec3<double> along = frame.direction(rad(90), rad(90)), aside = frame.direction(rad(180), rad(90));
  const auto direction = [&](double h, double v) {
    return std::cos(rad(h)) * (std::cos(rad(v)) * frame.nadir + std::sin(rad(v)) * along) + std::sin(rad(h)) * aside;
  };
  const auto value = [&](const Luminaire& l, double h, double v) { return l.diagram.intensity(direction(h, v)); };
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

// A type B file that is lit up to the horizon and dark above it: 1 cd over a hemisphere.
TEST(Ies, TypeBKeepsItsEdgeAtTheHorizon) {
  const Luminaire light = testing::from_ies(plain("-90 0 90", "1 1 1  1 1 1  1 1 1", "3 3", "-90 0 90", "2"));
  for (const Luminaire& l :
       {light, testing::from_ies(testing::ies_text(light)), testing::from_eulumdat(testing::eulumdat_text(light))}) {
    EXPECT_NEAR(flux(l.diagram) / (2 * pi<double>), 1, 1e-4);
    EXPECT_NEAR(l.diagram.intensity(LightFrame{}.direction(rad(33), rad(89.9))), 1, 1e-6);
    EXPECT_NEAR(l.diagram.intensity(LightFrame{}.direction(rad(33), rad(90.1))), 0, 1e-6);
  }
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
