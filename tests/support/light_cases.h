#pragma once

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <gonio/mapping/light/files/luminaire.h>

#include "tests/support/files.h"

namespace gonio::testing {

inline double rad(double degrees) { return degrees * pi<double> / 180; }

/// A diagram in the library's frame, tabulated from a function of C and gamma [rad].
template <class Function>
LightDiagram tabulate(int c_cells, int gamma_cells, double gamma_to, const Function& cd) {
  LightDiagram d;
  for (int i = 0; i <= c_cells; ++i) d.c.push_back(2 * pi<double> * i / c_cells);
  for (int j = 0; j <= gamma_cells; ++j) d.gamma.push_back(gamma_to * j / gamma_cells);
  for (int i = 0; i <= c_cells; ++i)
    for (double g : d.gamma) {
      const bool pole = g == 0 || g == pi<double>;
      d.cd.push_back(cd(pole || i == c_cells ? 0.0 : d.c[static_cast<std::size_t>(i)], g));
    }
  return d;
}

/// I = 1000/pi cos(gamma) cd, 1000 lm, every degree.
inline Luminaire lambertian() {
  Luminaire light;
  light.diagram = tabulate(1, 90, pi<double> / 2,
                           [](double, double g) { return g > rad(89.999) ? 0.0 : 1000 / pi<double> * std::cos(g); });
  light.symmetry = LightSymmetry::rotational;
  light.name = "Lambertian, 1000 lm";
  light.lamp_lumens = 1000;
  light.watts = 10;
  return light;
}

/// The direction in which asymmetric() is strongest.
inline Vec3<double> asymmetric_peak() { return LightFrame{}.direction(rad(30), rad(40)); }

/// A lobe of 1000 cd towards C = 30, gamma = 40 degrees and a weaker one up, towards C = 200,
/// gamma = 130: no two axes of the frame can be exchanged, mirrored or turned without showing.
inline Luminaire asymmetric() {
  Luminaire light;
  const Vec3<double> down = asymmetric_peak(), up = LightFrame{}.direction(rad(200), rad(130));
  light.diagram = tabulate(36, 36, pi<double>, [&](double c, double g) {
    const Vec3<double> w = LightFrame{}.direction(c, g);
    return 1000 * std::exp(8 * (glm::dot(w, down) - 1)) + 250 * std::exp(12 * (glm::dot(w, up) - 1));
  });
  light.name = "Asymmetric";
  light.lamp_lumens = 2000;
  light.watts = 20;
  light.size = {0.3, 0.1, 0};
  return light;
}

/// A spot of 6 degrees half width in a 180 x 1 degree table, dark elsewhere.
inline Luminaire narrow_spot() {
  Luminaire light;
  light.diagram = tabulate(1, 180, pi<double>, [](double, double g) {
    return g < rad(12) ? 20000 * std::pow(std::cos(g / rad(12) * pi<double> / 2), 2) : 0.0;
  });
  light.symmetry = LightSymmetry::rotational;
  return light;
}

/// Light upwards only.
inline Luminaire uplight() {
  Luminaire light = asymmetric();
  light.diagram = tabulate(
      24, 36, pi<double>, [](double c, double g) { return g > rad(91) ? -std::cos(g) * (2 + std::cos(c)) * 50 : 0.0; });
  return light;
}

/// The flux of a rotational luminaire between whose values the intensity is linear in gamma, in
/// closed form: the integral of (a + b g) sin g is b sin g - (a + b g) cos g. Degrees.
inline double rotational_flux(const std::vector<double>& gamma, const std::vector<double>& cd) {
  double sum = 0;
  for (std::size_t j = 0; j + 1 < gamma.size(); ++j) {
    const double g0 = rad(gamma[j]), g1 = rad(gamma[j + 1]), b = (cd[j + 1] - cd[j]) / (g1 - g0);
    sum += b * (std::sin(g1) - std::sin(g0)) - cd[j + 1] * std::cos(g1) + cd[j] * std::cos(g0);
  }
  return 2 * pi<double> * sum;
}

inline std::string ies_text(const Luminaire& light, const LightOptions& options = {}) {
  std::ostringstream stream;
  write_ies(stream, to_ies(light, options));
  return stream.str();
}

inline std::string eulumdat_text(const Luminaire& light) {
  std::ostringstream stream;
  write_eulumdat(stream, to_eulumdat(light));
  return stream.str();
}

inline Luminaire from_ies(const std::string& text, const LightOptions& options = {}) {
  Problems deviations;
  return to_luminaire(read_ies(text, "test.ies", deviations), "test.ies", options, deviations);
}

inline Luminaire from_eulumdat(const std::string& text, const LightOptions& options = {}) {
  Problems deviations;
  return to_luminaire(read_eulumdat(text, "test.ldt", deviations), "test.ldt", options, deviations);
}

/// Directions spread evenly over the sphere.
inline std::vector<Vec3<double>> directions(int count) {
  std::vector<Vec3<double>> all;
  const double golden = pi<double> * (3 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    const double z = 1 - 2 * (k + 0.5) / count, s = std::sqrt(1 - z * z);
    all.push_back({s * std::cos(golden * k), s * std::sin(golden * k), z});
  }
  return all;
}

/// The largest difference between two diagrams, as a fraction of the largest intensity.
inline double largest_difference(const LightDiagram& a, const LightDiagram& b, int count = 20000) {
  double largest = 0;
  for (const Vec3<double>& w : directions(count))
    largest = std::max(largest, std::abs(a.intensity(w) - b.intensity(w)));
  return largest / max_intensity(a);
}

/// All photometric files of GONIO_TEST_DATA but the one that is marked as broken; empty without it.
inline std::vector<std::filesystem::path> photometric_files() {
  std::vector<std::filesystem::path> files;
  if (test::test_data().empty()) return files;
  const std::filesystem::path folder = test::test_data() / "photometric";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if ((extension == ".ies" || extension == ".ldt") && entry.path().filename() != "test_file_format_error.ies")
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace gonio::testing
