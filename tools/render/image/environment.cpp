#include "tools/render/image/environment.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

/// The element of a cumulative table of n + 1 entries that holds u; u becomes the place within it.
std::size_t find(const float* cumulative, std::size_t n, float& u) noexcept {
  auto k = static_cast<std::size_t>(std::upper_bound(cumulative, cumulative + n + 1, u) - cumulative);
  k = std::min(std::max<std::size_t>(k, 1), n) - 1;
  while (k > 0 && !(cumulative[k + 1] > cumulative[k])) --k;  // u at the very end of the table
  const float width = cumulative[k + 1] - cumulative[k];
  u = width > 0 ? std::clamp((u - cumulative[k]) / width, 0.0f, 1 - 0x1p-24f) : 0.5f;
  return k;
}

}  // namespace

Environment::Environment(RgbImage image, const std::string& name, float turn) : image_(std::move(image)), turn_(turn) {
  const auto width = static_cast<std::size_t>(image_.width), height = static_cast<std::size_t>(image_.height);
  if (image_.pixels.empty()) throw Error(name + ": found an empty image, expected one of the whole sphere");
  for (const glm::vec3& p : image_.pixels)
    for (int c = 0; c < 3; ++c)
      if (!(p[c] >= 0 && static_cast<double>(p[c]) <= max_radiance))
        throw Error(name + ": found a radiance of " + std::to_string(p[c]) + ", expected 0 to 1e12");
  rows_.assign(height + 1, 0);
  columns_.assign(height * (width + 1), 0);
  std::vector<double> row(width + 1);
  std::vector<double> masses(height + 1, 0.0);
  for (std::size_t j = 0; j < height; ++j) {
    row[0] = 0;
    for (std::size_t i = 0; i < width; ++i) {
      // The mean over a pixel of the bilinear interpolation: 1/8, 6/8, 1/8 in each direction.
      float mean = 0;
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di)
          mean += (dj == 0 ? 0.75f : 0.125f) * (di == 0 ? 0.75f : 0.125f) *
                  luminance(texel(static_cast<int>(j) + dj, static_cast<int>(i) + di));
      row[i + 1] = row[i] + static_cast<double>(mean);
    }
    const double n = static_cast<double>(height), solid_angle = 2 * pi<double> / static_cast<double>(width) *
                                                                (std::cos(pi<double> * static_cast<double>(j) / n) -
                                                                 std::cos(pi<double> * static_cast<double>(j + 1) / n));
    solid_angles_.push_back(static_cast<float>(solid_angle));
    masses[j + 1] = masses[j] + row[width] * solid_angle;
    for (std::size_t i = 0; i <= width; ++i)
      columns_[j * (width + 1) + i] = static_cast<float>(row[width] > 0 ? row[i] / row[width] : 0.0);
  }
  power_ = static_cast<float>(masses[height]);
  if (power_ > 0)
    for (std::size_t j = 0; j <= height; ++j) rows_[j] = static_cast<float>(masses[j] / masses[height]);
}

const glm::vec3& Environment::texel(int row, int column) const noexcept {
  row = std::clamp(row, 0, image_.height - 1);
  column = (column + image_.width) % image_.width;
  return image_.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                       static_cast<std::size_t>(column)];
}

glm::vec2 Environment::place(const glm::vec3& d) const noexcept {
  float turns = 0.5f - (std::atan2(d.y, d.x) - turn_) / (2 * pi<float>);
  turns -= std::floor(turns);
  const float theta = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z);
  const float width = static_cast<float>(image_.width), height = static_cast<float>(image_.height);
  return {std::min(turns * width, width * (1 - 0x1p-23f)),
          std::min(theta / pi<float> * height, height * (1 - 0x1p-23f))};
}

glm::vec3 Environment::radiance(const glm::vec3& direction) const noexcept {
  const glm::vec2 at = place(direction) - 0.5f, base = glm::floor(at), t = at - base;
  const int i = static_cast<int>(base.x), j = static_cast<int>(base.y);
  return glm::mix(glm::mix(texel(j, i), texel(j, i + 1), t.x), glm::mix(texel(j + 1, i), texel(j + 1, i + 1), t.x),
                  t.y);
}

std::optional<Environment::Sample> Environment::sample(glm::vec2 u) const noexcept {
  if (!(power_ > 0)) return std::nullopt;
  const auto width = static_cast<std::size_t>(image_.width), height = static_cast<std::size_t>(image_.height);
  const std::size_t j = find(rows_.data(), height, u.y);
  const std::size_t i = find(&columns_[j * (width + 1)], width, u.x);
  const float step = pi<float> / static_cast<float>(height), top = std::cos(step * static_cast<float>(j)),
              bottom = std::cos(step * static_cast<float>(j + 1));
  const float z = top + (bottom - top) * u.y, r = std::sqrt(std::max(0.0f, 1 - z * z));
  const float phi = turn_ + pi<float> - 2 * pi<float> * (static_cast<float>(i) + u.x) / static_cast<float>(width);
  const glm::vec3 direction(r * std::cos(phi), r * std::sin(phi), z);
  const float density = pdf(direction);  // as others will see it, where rounding moves it to the next pixel
  if (!(density > 0)) return std::nullopt;
  return Sample{direction, density};
}

float Environment::pdf(const glm::vec3& direction) const noexcept {
  if (!(power_ > 0)) return 0;
  const glm::vec2 at = place(direction);
  const auto i = static_cast<std::size_t>(at.x), j = static_cast<std::size_t>(at.y),
             width = static_cast<std::size_t>(image_.width);
  const float share = (rows_[j + 1] - rows_[j]) * (columns_[j * (width + 1) + i + 1] - columns_[j * (width + 1) + i]);
  return share / solid_angles_[j];
}

RgbImage make_sky(const glm::vec3& sun, float sun_radius, float sun_radiance, int height) {
  RgbImage sky{2 * height, height, {}};
  sky.pixels.reserve(static_cast<std::size_t>(2 * height * height));
  const glm::vec3 zenith(0.16f, 0.30f, 0.62f), horizon(0.78f, 0.86f, 0.95f), ground(0.16f, 0.15f, 0.14f),
      warm(1.0f, 0.93f, 0.82f);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < sky.width; ++column) {
      const float theta = pi<float> * (static_cast<float>(row) + 0.5f) / static_cast<float>(height);
      const float phi = pi<float> - 2 * pi<float> * (static_cast<float>(column) + 0.5f) / static_cast<float>(sky.width);
      const glm::vec3 w(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const float to_sun = std::atan2(glm::length(glm::cross(w, sun)), glm::dot(w, sun));
      const float up = std::max(w.z, 0.0f);
      glm::vec3 value = glm::mix(zenith, horizon, std::exp(-4 * up));
      value = glm::mix(ground, value, glm::smoothstep(-0.03f, 0.03f, w.z));
      value += warm * (0.35f * std::exp(-to_sun / 0.25f));
      value += warm * sun_radiance * (1 - glm::smoothstep(0.8f * sun_radius, 1.2f * sun_radius, to_sun));
      sky.pixels.push_back(value);
    }
  return sky;
}

}  // namespace gonio
