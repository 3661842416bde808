#include <algorithm>
#include <cmath>

#include <gonio/brdf/formats/rgl/spectrum.h>

namespace gonio {
namespace {

// CIE standard illuminant D65, relative power every 10 nm from 380 to 780 nm (CIE 15).
constexpr double d65[] = {49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
                          114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
                          100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
                          80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856,
                          75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
constexpr int first_nm = 380, last_nm = 780;

double illuminant(int nm) {
  const int i = std::min((nm - first_nm) / 10, 39);
  return d65[i] + (d65[i + 1] - d65[i]) * (nm - first_nm - 10 * i) / 10.0;
}

double lobe(double nm, double centre, double below, double above) {
  const double t = (nm - centre) / (nm < centre ? below : above);
  return std::exp(-0.5 * t * t);
}

glm::dvec3 xyz(double nm) {
  return {
      1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
      0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
      1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

glm::dvec3 rec709(const glm::dvec3& c) {
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z, -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

}  // namespace

std::vector<glm::vec3> rec709_weights(const std::vector<float>& wavelengths) {
  std::vector<glm::dvec3> weights(wavelengths.size(), glm::dvec3(0.0));
  glm::dvec3 sum(0.0);
  for (int nm = first_nm; nm <= last_nm; ++nm) {
    const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), static_cast<float>(nm));
    if (above == wavelengths.begin()) continue;
    const auto k = static_cast<std::size_t>(above - wavelengths.begin());
    if (above == wavelengths.end() && static_cast<float>(nm) > wavelengths.back()) continue;
    const glm::dvec3 rgb = illuminant(nm) * rec709(xyz(nm));
    sum += rgb;
    if (above == wavelengths.end()) {
      weights[k - 1] += rgb;
      continue;
    }
    const double before = wavelengths[k - 1];
    const double t = (nm - before) / (wavelengths[k] - before);
    weights[k - 1] += (1.0 - t) * rgb;
    weights[k] += t * rgb;
  }
  std::vector<glm::vec3> result;
  result.reserve(weights.size());
  for (const glm::dvec3& weight : weights) result.emplace_back(weight / sum);
  return result;
}

RgbSpectra rgb_spectra() {
  // Of all that meet the conditions at these wavelengths, the ones with the least sum of squared
  // differences between neighbours: a quadratic programme in 45 unknowns, solved once.
  RgbSpectra spectra;
  spectra.reflectance = {
      {0.05796f, 0.00000f, 0.94204f}, {0.05920f, 0.00000f, 0.94080f}, {0.04907f, 0.00000f, 0.95093f},
      {0.00568f, 0.00000f, 0.99432f}, {0.00000f, 0.20882f, 0.79118f}, {0.00000f, 0.88454f, 0.11546f},
      {0.00000f, 1.00000f, 0.00000f}, {0.00000f, 1.00000f, 0.00000f}, {0.09673f, 0.84521f, 0.05806f},
      {0.95613f, 0.04387f, 0.00000f}, {1.00000f, 0.00000f, 0.00000f}, {1.00000f, 0.00000f, 0.00000f},
      {1.00000f, 0.00000f, 0.00000f}, {1.00000f, 0.00000f, 0.00000f}, {0.99952f, 0.00040f, 0.00008f}};
  for (std::size_t k = 0; k < spectra.reflectance.size(); ++k) {
    spectra.wavelengths.push_back(380.0f + 25.0f * static_cast<float>(k));
  }
  return spectra;
}

}  // namespace gonio
