#include <gonio/brdf/colour.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gonio/brdf/parallel.h>
#include <gonio/mapping/error.h>

namespace gonio {

Colour::Colour(std::size_t angles, int side, std::vector<glm::vec3> values)
    : side_(side), values_(std::move(values)) {
  if (side < 2 || side % 2 != 0)
    throw Error("colour: side: found " + std::to_string(side) + ", expected an even number >= 2");
  const std::size_t expected = angles * static_cast<std::size_t>(side) * static_cast<std::size_t>(side / 2);
  if (values_.size() != expected)
    throw Error("colour: found " + std::to_string(values_.size()) + " values, expected " + std::to_string(expected));
  for (const glm::vec3& w : values_)
    for (int c = 0; c < 3; ++c)
      if (!(w[c] >= 0 && std::isfinite(w[c])))
        throw Error("colour: found " + std::to_string(w[c]) + ", expected finite values >= 0");
}

Colour Colour::from_table(const BrdfTable& table, const Stack<float>& stack, int side) {
  constexpr int samples = 8;
  const std::size_t angles = stack.theta_i().size(), columns = static_cast<std::size_t>(side), rows = columns / 2;
  std::vector<glm::vec3> values(angles * rows * columns, glm::vec3(0));
  parallel_for(angles, [&](std::size_t k) {
    const float theta_i = stack.theta_i()[k];
    const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        glm::vec3 sum(0);
        for (int s = 0; s < samples * samples; ++s) {
          const float x = (static_cast<float>(s % samples) + 0.5f) / samples;
          const float y = (static_cast<float>(s / samples) + 0.5f) / samples;
          const float u = (static_cast<float>(column) + x) / static_cast<float>(side);
          const float v = 0.5f + (static_cast<float>(row) + y) / static_cast<float>(side);
          const auto drawn = stack.sample(theta_i, u, v);
          if (!(drawn.pdf > 0)) continue;
          // Both signs of phi: a table need not be as symmetric as its diagrams.
          const glm::vec3 mirror(drawn.wo.x, -drawn.wo.y, drawn.wo.z);
          sum += (table.eval(wi, drawn.wo) + table.eval(wi, mirror)) * (0.5f * drawn.wo.z / drawn.pdf);
        }
        values[(k * rows + row) * columns + column] = sum / static_cast<float>(samples * samples);
      }
    }
  });
  return Colour(angles, side, std::move(values));
}

glm::vec3 Colour::bilinear(std::size_t angle, SquarePoint<float> at) const noexcept {
  const float x = std::clamp(at.u * static_cast<float>(side_) - 0.5f, 0.0f, static_cast<float>(side_ - 1));
  const float y = std::clamp((std::abs(at.v - 0.5f)) * static_cast<float>(side_) - 0.5f, 0.0f,
                             static_cast<float>(side_ / 2 - 1));
  const int i = std::min(static_cast<int>(x), side_ - 2), j = std::min(static_cast<int>(y), std::max(side_ / 2 - 2, 0));
  const int below = std::min(j + 1, side_ / 2 - 1);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const glm::vec3* rows = values_.data() + angle * static_cast<std::size_t>(side_ * (side_ / 2));
  const glm::vec3 *top = rows + j * side_ + i, *bottom = rows + below * side_ + i;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
}

glm::vec3 Colour::eval(const std::vector<float>& stack_angles, float theta_i, SquarePoint<float> at) const noexcept {
  const int count = static_cast<int>(stack_angles.size());
  if (count == 1) return bilinear(0, at);
  const int k = find_cell(stack_angles.data(), count, theta_i);
  const float alpha = std::clamp((theta_i - stack_angles[k]) / (stack_angles[k + 1] - stack_angles[k]), 0.0f, 1.0f);
  return (1 - alpha) * bilinear(k, at) + alpha * bilinear(k + 1, at);
}

}  // namespace gonio
