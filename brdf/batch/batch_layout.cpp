#include <algorithm>
#include <limits>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

namespace {

/// Vector code has offsets in bytes of 32 bits.
void check_size(std::size_t values) {
  constexpr std::size_t most = std::numeric_limits<int>::max() / sizeof(float);
  if (values > most)
    throw Error("batch: found " + std::to_string(values) + " values, expected at most " + std::to_string(most));
}

/// No mass and no line is above; small enough for weights and sums.
constexpr float beyond = 1e30f;

int round_up(int count, int unit) { return (count + unit - 1) / unit * unit; }

/// What searches read at once, at most: among lines, from the second one on, and among groups.
constexpr int lines_at_once = 16, groups_at_once = 8;
int padded(int lines) { return std::max(lines, 1 + round_up(lines - 2, lines_at_once)); }

}  // namespace

BatchAngles::BatchAngles(const std::vector<float>& theta_i) : count(static_cast<int>(theta_i.size())), values(theta_i) {
  for (const float theta : theta_i) radii.push_back(static_cast<float>(theta_to_radius(double{theta})));
  if (count < 2) return;
  // A little wider than they are: vectors may round a radius into the next part.
  constexpr float part = 1.0f / guide_parts, margin = 1e-3f * part;
  for (int k = 0; k < guide_parts; ++k) {
    guide.push_back(find_cell(radii.data(), count, static_cast<float>(k) * part - margin));
    const float end = k + 1 < guide_parts ? static_cast<float>(k + 1) * part + margin : 4;
    guide_steps = std::max(guide_steps, find_cell(radii.data(), count, end) - guide.back());
  }
}

std::size_t BatchAngles::bytes() const noexcept {
  return (values.capacity() + radii.capacity()) * sizeof(float) + guide.capacity() * sizeof(int);
}

BatchLayout::BatchLayout(const Stack<float>& stack)
    : angles(stack.theta_i()),
      meridians(0),
      parallels(0),
      half_azimuth(stack.diagrams().front().azimuth() == Azimuth::half),
      half_chart(stack.chart() == Chart::half),
      interpolation(stack.interpolation()) {
  if (interpolation == Interpolation::mixture)
    throw Error("batch: interpolation: found mixture, expected nearest, displacement or blend");
  for (const Diagram<float>& d : stack.diagrams()) {
    meridians = std::max(meridians, d.meridians());
    parallels = std::max(parallels, d.parallels());
  }
  across = round_up(meridians - 1, group) / group, along = round_up(parallels - 1, group) / group;
  before_row = round_up(along - 1, groups_at_once);
  r = padded(meridians);
  before_meridians = r + padded(parallels);
  before_parallels = before_meridians + round_up(across - 1, groups_at_once);
  const int of_meridians = across * meridian_group;
  parallel_groups = round_up(before_parallels + meridians * before_row + of_meridians,
                             parallel_group);  // begin with a line of the cache
  meridian_groups = parallel_groups - of_meridians;
  stride = parallel_groups + meridians * along * parallel_group;
  check_size(stack.diagrams().size() * static_cast<std::size_t>(stride));
  lines_.assign(stack.diagrams().size() * static_cast<std::size_t>(stride) / 16, Line{});
  float* block = lines_.data()->x;
  for (const Diagram<float>& d : stack.diagrams()) {
    const int m = d.meridians(), n = d.parallels();
    const float* const phi = d.values().data();
    const float *cumulative_phi = phi + m, *own_r = cumulative_phi + m, *density = own_r + n,
                *cumulative = density + m * n;
    std::fill_n(block, meridian_groups, beyond);
    std::copy_n(phi, m, block), std::copy_n(own_r, n, block + r);
    // The masses before cells: into groups, `step` floats apart, and those before groups apart.
    const auto store = [](const float* mass, int cells, int count, float* before_groups, float* to, int step) {
      for (int g = 0; g < count; ++g, to += step) {
        for (int k = 0; k < group; ++k) to[k] = g * group + k < cells ? mass[g * group + k] : beyond;
        if (g > 0) before_groups[g - 1] = to[0];
      }
    };
    float* to = block + meridian_groups;
    store(cumulative_phi, m - 1, across, block + before_meridians, to, meridian_group);
    for (int g = 0; g < across; ++g, to += meridian_group)
      for (int k = 0; k <= group && g * group + k < m; ++k) {
        const int i = g * group + k;
        to[group + 1 + 2 * k] = phi[i], to[group + 2 + 2 * k] = cumulative[(i + 1) * n - 1];
      }
    for (int i = 0; i < m; ++i, density += n, cumulative += n) {
      to = block + parallel_groups + i * along * parallel_group;
      store(cumulative, n - 1, along, block + before_parallels + i * before_row, to, parallel_group);
      for (int g = 0; g < along; ++g, to += parallel_group)
        for (int k = 0; k <= group && g * group + k < n; ++k) to[group + k] = density[g * group + k];
    }
    block += stride;
  }
}

BatchColour::BatchColour(const Colour& colour, const BatchLayout& stack)
    : side(colour.side()),
      angles(colour.theta_i()),
      same_angles(angles.values == stack.angles.values),
      layer(side * (side / 2)),
      last_row(std::max(side / 2 - 2, 0)),
      next_row(side > 2 ? side : 0),
      next_layer(angles.count > 1 ? layer : 0) {
  check_size(4 * colour.cells());
  for (const glm::vec3& w : colour.values())
    for (const float channel : {w.r, w.g, w.b, 0.0f}) values.push_back(channel);
}

}  // namespace gonio
