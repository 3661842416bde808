#pragma once

#include <glm/vec3.hpp>
#include <vector>

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

}  // namespace gonio
