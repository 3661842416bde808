#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tools/render/image/exr_image.h"

namespace gonio {

/// What is brighter could make infinities of sums and products.
inline constexpr double max_radiance = 1e12;

/// Radiance from all directions, as a latitude-longitude image: the top row is round +z, the middle
/// column looks along +x, columns to the right turn clockwise seen from above (as a panorama is seen
/// from within). Bilinear between the centres of pixels.
///
/// Drawn in proportion to the mean luminance of each pixel's area, uniformly in solid angle within
/// it, so that the pdf is positive wherever the radiance is. Thread safety: immutable.
class Environment {
 public:
  /// @param turn [rad] by which the image is turned about z, counter-clockwise seen from above
  /// @throws Error if the image is empty or a value is not from 0 to max_radiance; `name` for messages.
  Environment(RgbImage image, const std::string& name, float turn = 0);

  /// @param direction unit vector, in the world
  glm::vec3 radiance(const glm::vec3& direction) const noexcept;

  struct Sample {
    glm::vec3 direction;
    float pdf;  ///< [1/sr]
  };
  /// Empty if all is black. @param u in [0, 1)^2
  std::optional<Sample> sample(glm::vec2 u) const noexcept;
  float pdf(const glm::vec3& direction) const noexcept;

  /// Integral of the luminance over all directions.
  float power() const noexcept { return power_; }

 private:
  const glm::vec3& texel(int row, int column) const noexcept;
  glm::vec2 place(const glm::vec3& direction) const noexcept;  // in pixels: column, row

  RgbImage image_;
  float turn_;
  float power_ = 0;
  std::vector<float> rows_;          // cumulative share of rows 0 ... height
  std::vector<float> columns_;       // of each row, columns 0 ... width
  std::vector<float> solid_angles_;  // of a pixel of each row [sr]
};

/// A clear sky over a dim ground: bright at the horizon, blue at the zenith, with a sun whose disc
/// is soft and, at `sun_radius`, larger than the real one (0.27 degrees).
/// @param sun direction to it, unit; angles in radians
RgbImage make_sky(const glm::vec3& sun, float sun_radius, float sun_radiance, int height = 512);

}  // namespace gonio
