#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/folded_disk.h>
#include <gonio/mapping/numeric/code16.h>

namespace gonio {
namespace {

constexpr float max_weight = 1e6f;  // no material comes near; products with a pdf and 1 / cosine stay finite

}  // namespace

Colour::Colour(std::vector<float> theta_i, int side, const std::vector<glm::vec3>& values)
    : side_(side), theta_i_(std::move(theta_i)) {
  if (side < 2 || side % 2 != 0)
    throw Error("colour: side: found " + std::to_string(side) + ", expected an even number >= 2");
  if (theta_i_.empty()) throw Error("colour: theta_i: found no angles, expected at least one");
  for (std::size_t k = 0; k < theta_i_.size(); ++k)
    if (!(theta_i_[k] >= 0 && theta_i_[k] <= pi<float> / 2 + 1e-6f) || (k > 0 && !(theta_i_[k] > theta_i_[k - 1])))
      throw Error("colour: theta_i[" + std::to_string(k) + "]: found " + std::to_string(theta_i_[k]) +
                  ", expected ascending angles in 0 to pi/2");
  const std::size_t expected = theta_i_.size() * static_cast<std::size_t>(side) * static_cast<std::size_t>(side / 2);
  if (values.size() != expected)
    throw Error("colour: found " + std::to_string(values.size()) + " values, expected " + std::to_string(expected));
  for (const glm::vec3& w : values) {
    for (int c = 0; c < 3; ++c) {
      if (!(w[c] >= 0 && w[c] <= max_weight)) {
        std::ostringstream found;
        found << w[c];
        throw Error("colour: found " + found.str() + ", expected weights from 0 to 1e6");
      }
      largest_ = std::max(largest_, w[c]);
    }
  }
  codes_.reserve(3 * values.size() + 1);
  for (const glm::vec3& w : values)
    for (int c = 0; c < 3; ++c)
      codes_.push_back(largest_ > 0 ? encode16(static_cast<double>(w[c]) / static_cast<double>(largest_))
                                    : std::uint16_t{0});
  codes_.push_back(0);
}

std::vector<glm::vec3> Colour::values() const {
  std::vector<glm::vec3> values(cells());
  for (std::size_t i = 0; i < 3 * values.size(); ++i)
    values[i / 3][static_cast<int>(i % 3)] = largest_ * decode16(codes_[i]);
  return values;
}

glm::vec3 Colour::eval(float theta_i, SquarePoint<float> at) const noexcept {
  const auto [k, alpha] = bracket(theta_i_, theta_i);
  const float x = std::clamp(at.u * static_cast<float>(side_) - 0.5f, 0.0f, static_cast<float>(side_ - 1));
  const float y =
      std::clamp((std::abs(at.v - 0.5f)) * static_cast<float>(side_) - 0.5f, 0.0f, static_cast<float>(side_ / 2 - 1));
  const int i = std::min(static_cast<int>(x), side_ - 2), j = std::min(static_cast<int>(y), std::max(side_ / 2 - 2, 0));
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const int below = side_ > 2 ? 3 * side_ : 0, behind = theta_i_.size() > 1 ? 3 * side_ * (side_ / 2) : 0;
  const std::uint16_t* first = codes_.data() + 3 * ((k * (side_ / 2) + j) * side_ + i);

  float sum[4] = {0, 0, 0, 0};  // vectors of four; the last lane is that of another cell
  const auto add = [&](const std::uint16_t* cell, float weight) {
    for (int channel = 0; channel < 4; ++channel) sum[channel] += weight * decode16(cell[channel]);
  };
  const auto add_layer = [&](const std::uint16_t* top, float weight) {
    const std::uint16_t* bottom = top + below;
    add(top, weight * (1 - b) * (1 - a));
    add(top + 3, weight * (1 - b) * a);
    add(bottom, weight * b * (1 - a));
    add(bottom + 3, weight * b * a);
  };
  add_layer(first, largest_ * (1 - alpha));
  add_layer(first + behind, largest_ * alpha);
  return {sum[0], sum[1], sum[2]};
}

}  // namespace gonio
