#include <gtest/gtest.h>

#include <gonio/brdf/formats/rgl/spectrum.h>

namespace gonio {
namespace {

glm::vec3 colour(float first, float step, int n, float (*reflectance)(float)) {
  std::vector<float> wavelengths;
  for (int i = 0; i < n; ++i) wavelengths.push_back(first + step * static_cast<float>(i));
  const std::vector<glm::vec3> weights = rec709_weights(wavelengths);
  glm::vec3 rgb(0.0f);
  for (std::size_t i = 0; i < weights.size(); ++i) rgb += weights[i] * reflectance(wavelengths[i]);
  return rgb;
}

TEST(Spectrum, FlatIsGreyOnAnyWavelengths) {
  const auto half = [](float) { return 0.5f; };
  for (const float step : {1.0f, 5.0f, 37.0f}) {
    const glm::vec3 rgb = colour(350.0f, step, static_cast<int>(700.0f / step), half);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], 0.5f, 1e-5f) << step;
  }
  const glm::vec3 narrow = colour(420.0f, 10.0f, 25, half);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(narrow[c], 0.5f, 1e-5f);
}

// A smooth ramp seen through two samplings is the same colour.
TEST(Spectrum, IndependentOfTheSampling) {
  const auto ramp = [](float nm) { return (nm - 350.0f) / 500.0f; };
  const glm::vec3 fine = colour(360.0f, 3.0f, 190, ramp), coarse = colour(360.0f, 20.0f, 30, ramp);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(fine[c], coarse[c], 1e-4f);
  EXPECT_GT(fine.r, fine.g);
  EXPECT_GT(fine.g, fine.b);
}

TEST(Spectrum, BandsHaveTheirColour) {
  const auto band = [](float low, float high) {
    std::vector<float> wavelengths;
    for (float nm = 360.0f; nm < 830.0f; nm += 5.0f) wavelengths.push_back(nm);
    const std::vector<glm::vec3> weights = rec709_weights(wavelengths);
    glm::vec3 rgb(0.0f);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (wavelengths[i] >= low && wavelengths[i] < high) rgb += weights[i];
    }
    return rgb;
  };
  const glm::vec3 blue = band(430, 480), green = band(520, 560), red = band(610, 700);
  EXPECT_TRUE(blue.b > blue.r && blue.b > blue.g);
  EXPECT_TRUE(green.g > green.r && green.g > green.b);
  EXPECT_TRUE(red.r > red.g && red.r > red.b);
}

TEST(Spectrum, ColoursAsReflectancesComeBack) {
  const RgbSpectra spectra = rgb_spectra();
  const std::vector<glm::vec3> weights = rec709_weights(spectra.wavelengths);
  ASSERT_EQ(spectra.reflectance.size(), weights.size());
  for (int primary = 0; primary < 3; ++primary) {
    glm::vec3 rgb(0.0f);
    for (std::size_t k = 0; k < weights.size(); ++k) rgb += weights[k] * spectra.reflectance[k][primary];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], c == primary ? 1.0f : 0.0f, 2e-5f);
  }
  for (const glm::vec3& r : spectra.reflectance) {
    EXPECT_NEAR(r.r + r.g + r.b, 1.0f, 1e-6f);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(r[c] >= 0.0f && r[c] <= 1.0f);
  }
}

}  // namespace
}  // namespace gonio
