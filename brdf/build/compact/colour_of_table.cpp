#include <algorithm>
#include <cmath>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {

Colour colour_of_table(const BrdfTable& table, const DirectionMap& map, const std::vector<float>& theta_i, int side) {
  const int samples = std::max(2, 128 / side);
  const std::size_t columns = static_cast<std::size_t>(side), rows = columns / 2;
  std::vector<glm::vec3> values(theta_i.size() * rows * columns, glm::vec3(0));
  parallel_for(theta_i.size(), [&](std::size_t k) {
    const glm::vec3 wi(std::sin(theta_i[k]), 0, std::cos(theta_i[k]));
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        glm::vec3 sum(0);
        for (int s = 0; s < samples * samples; ++s) {
          const float x = (static_cast<float>(s % samples) + 0.5f) / static_cast<float>(samples);
          const float y = (static_cast<float>(s / samples) + 0.5f) / static_cast<float>(samples);
          const float u = (static_cast<float>(column) + x) / static_cast<float>(side);
          const float v = 0.5f + (static_cast<float>(row) + y) / static_cast<float>(side);
          const auto drawn = map(theta_i[k], u, v);
          if (!(drawn.pdf > 0)) continue;
          // Both signs of phi: a table need not be as symmetric as its diagrams.
          const glm::vec3 mirror(drawn.wo.x, -drawn.wo.y, drawn.wo.z);
          sum += (table.eval(wi, drawn.wo) + table.eval(wi, mirror)) * (0.5f * drawn.wo.z / drawn.pdf);
        }
        values[(k * rows + row) * columns + column] = sum / static_cast<float>(samples * samples);
      }
    }
  });
  return Colour(theta_i, side, values);
}

}  // namespace gonio
