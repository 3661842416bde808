#include <gonio/brdf/batch/batch_layout.h>

#include <algorithm>
#include <limits>

#include <gonio/mapping/error.h>

namespace gonio {

namespace {

/// Vector code has offsets in bytes of 32 bits.
void check_size(std::size_t values) {
  constexpr std::size_t most = std::numeric_limits<int>::max() / sizeof(float);
  if (values > most) throw Error("batch: found " + std::to_string(values) + " values, expected at most " + std::to_string(most));
}

}  // namespace

BatchLayout::BatchLayout(const Stack<float>& stack)
    : angles(static_cast<int>(stack.theta_i().size())),
      meridians(0),
      parallels(0),
      stride(0),
      half_azimuth(stack.diagrams().front().azimuth() == Azimuth::half),
      half_chart(stack.chart() == Chart::half),
      interpolation(stack.interpolation()),
      values(stack.theta_i()),
      guide_steps(0) {
  if (interpolation == Interpolation::mixture)
    throw Error("batch: interpolation: found mixture, expected nearest, displacement or blend");
  for (const Diagram<float>& d : stack.diagrams()) {
    meridians = std::max(meridians, d.meridians());
    parallels = std::max(parallels, d.parallels());
  }
  const std::size_t m = static_cast<std::size_t>(meridians), n = static_cast<std::size_t>(parallels);
  const std::size_t block = 3 * m + n + 2 * m * n, size = values.size() + values.size() * block;
  check_size(size);
  stride = static_cast<int>(block);
  values.reserve(size);
  for (const Diagram<float>& d : stack.diagrams()) {
    const std::size_t rows = static_cast<std::size_t>(d.meridians()), columns = static_cast<std::size_t>(d.parallels());
    const float* const own = d.values().data();
    const float *own_r = own + 2 * rows, *own_density = own_r + columns, *own_cumulative = own_density + rows * columns;
    const auto row = [&](std::size_t i) { return std::min(i, rows - 1); };
    const auto column = [&](std::size_t j) { return std::min(j, columns - 1); };
    for (std::size_t i = 0; i < m; ++i) values.push_back(own[row(i)]);
    for (std::size_t i = 0; i < m; ++i) values.push_back(own[rows + row(i)]);
    for (std::size_t i = 0; i < m; ++i) values.push_back(own_cumulative[row(i) * columns + columns - 1]);
    for (std::size_t j = 0; j < n; ++j) values.push_back(own_r[column(j)]);
    for (const float* own_rows : {own_density, own_cumulative})
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < m; ++i) values.push_back(own_rows[row(i) * columns + column(j)]);
  }
  if (angles == 1) return;
  // A little wider than they are: vectors may round an angle into the next part.
  constexpr float part = pi<float> / 2 / guide_parts, margin = 1e-3f * part;
  for (int k = 0; k < guide_parts; ++k) {
    guide.push_back(find_cell(values.data(), angles, static_cast<float>(k) * part - margin));
    const float end = k + 1 < guide_parts ? static_cast<float>(k + 1) * part + margin : 4;
    guide_steps = std::max(guide_steps, find_cell(values.data(), angles, end) - guide.back());
  }
}

std::size_t BatchLayout::bytes() const noexcept { return values.capacity() * sizeof(float) + guide.capacity() * sizeof(int); }

BatchColour::BatchColour(const Colour& colour) : side(colour.side()), theta_i(colour.theta_i()) {
  check_size(4 * colour.cells());
  for (const glm::vec3& w : colour.values())
    for (const float channel : {w.r, w.g, w.b, 0.0f}) values.push_back(channel);
}

}  // namespace gonio
