#pragma once

#include <vector>

#include <glm/vec3.hpp>

namespace gonio {

/// Weights w_k that turn a reflectance spectrum, given at rising `wavelengths` in nm and linear
/// between them, into linear Rec. 709: rgb = sum over k of w_k * reflectance_k.
///
/// The reflectance is lit by CIE illuminant D65, the white of Rec. 709, so that no chromatic
/// adaptation is needed, and seen through the colour matching functions of CIE 1931 in the
/// multi-lobe fit of Wyman, Sloan and Shirley 2013 (equation 4 and table 1). The weights of each
/// channel are scaled to a sum of 1: a reflectance of 1 at every wavelength is exactly white, and
/// wavelengths that the data lack count like the average of the others.
std::vector<glm::vec3> rec709_weights(const std::vector<float>& wavelengths);

/// Linear Rec. 709 colours as reflectances: the reflectance at wavelengths[k] is
/// dot(reflectance[k], rgb), linear between wavelengths and constant beyond.
struct RgbSpectra {
  std::vector<float> wavelengths;      ///< 380 to 730 nm
  std::vector<glm::vec3> reflectance;  ///< of red, green and blue
};

/// Three reflectances within [0, 1] that sum to 1 at every wavelength, so that grey is flat, and that
/// rec709_weights() turns back into the primaries (within 2e-5): a colour of a reflectance is a
/// reflectance that has this colour under D65. The idea is that of Mallett and Yuksel 2019,
/// "Spectral primary decomposition for rendering with sRGB reflectance".
RgbSpectra rgb_spectra();

}  // namespace gonio
