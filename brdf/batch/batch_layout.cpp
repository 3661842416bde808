#include <algorithm>
#include <limits>
#include <string>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/code16.h>

namespace gonio {

namespace {

/// Vector code has offsets in bytes of 32 bits.
void check_size(std::size_t values) {
  constexpr std::size_t most = std::numeric_limits<int>::max() / 8;
  if (values > most)
    throw Error("batch: found " + std::to_string(values) + " values, expected at most " + std::to_string(most));
}

constexpr int at_once = 16;  // floats that searches read, at most: as many may be read behind an array

/// Groups along a meridian, and what a diagram has of everything.
struct Sizes {
  int groups, codes, floats, lines;

  Sizes(int m, int n)
      : groups((n + BatchLayout::group - 2) / BatchLayout::group),
        codes(groups * m * BatchLayout::group_codes),
        floats(2 + m * (groups + 1)),
        lines(m + groups * BatchLayout::group + 1) {}
};

}  // namespace

BatchAngles::BatchAngles(const std::vector<float>& theta_i) : count(static_cast<int>(theta_i.size())), values(theta_i) {
  radii.reserve(theta_i.size());
  for (const float theta : theta_i) radii.push_back(static_cast<float>(theta_to_radius(double{theta})));
  if (count < 2) return;
  if (count > std::numeric_limits<std::uint16_t>::max())
    throw Error("batch: found " + std::to_string(count) + " incident angles, expected fewer than 65536");
  for (guide_parts = 16; guide_steps != 1 && guide_parts < 1024;) {
    guide_parts *= 2, guide_steps = 0;
    guide.clear();
    // A little wider than they are: vectors may round a radius into the next part.
    const float part = 1.0f / static_cast<float>(guide_parts), margin = 1e-3f * part;
    for (int k = 0; k < guide_parts; ++k) {
      const int first = find_cell(radii.data(), count, static_cast<float>(k) * part - margin);
      const float end = k + 1 < guide_parts ? static_cast<float>(k + 1) * part + margin : 4;
      guide_steps = std::max(guide_steps, find_cell(radii.data(), count, end) - first);
      guide.push_back(static_cast<std::uint16_t>(first));
    }
    if (guide_steps == 0) break;
  }
  guide.push_back(0);
  guide.shrink_to_fit();
}

std::size_t BatchAngles::bytes() const noexcept {
  return (values.capacity() + radii.capacity()) * sizeof(float) + guide.capacity() * sizeof(std::uint16_t);
}

std::size_t BatchLayout::diagram_bytes(int meridians, int parallels) noexcept {
  const Sizes of(meridians, parallels);
  return static_cast<std::size_t>(of.codes) * sizeof(std::uint16_t) +
         static_cast<std::size_t>(of.floats) * sizeof(float);
}

std::size_t BatchLayout::lines_bytes(int meridians, int parallels) noexcept {
  return static_cast<std::size_t>(Sizes(meridians, parallels).lines) * sizeof(float);
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
  const auto& diagrams = stack.diagrams();
  bool shared = true;
  for (const Diagram<float>& d : diagrams) {
    meridians = std::max(meridians, d.meridians());
    parallels = std::max(parallels, d.parallels());
    shared = shared && d.same_lines(diagrams.front());
  }
  const std::size_t count = diagrams.size();
  const Sizes each(meridians, parallels);
  const int lines = each.lines;
  check_size(count * static_cast<std::size_t>(each.codes));
  groups = each.groups, code_stride = each.codes, stride = each.floats, lines_stride = shared ? 0 : lines;
  before = 1, along = before + meridians + 1, starts = along + meridians;
  r = meridians;

  codes_.assign(count * static_cast<std::size_t>(code_stride) + group_codes, 0);
  floats_.assign(count * static_cast<std::size_t>(stride) + at_once, beyond);
  lines_.assign((shared ? 1 : count) * static_cast<std::size_t>(lines) + at_once, beyond);
  for (std::size_t k = 0; k < count; ++k) {
    const Diagram<float>& d = diagrams[k];
    const int m = d.meridians(), n = d.parallels();
    float* own_lines = lines_.data() + k * static_cast<std::size_t>(lines_stride);
    std::copy_n(d.phi(), m, own_lines);
    std::fill(std::copy_n(d.r(), n, own_lines + r), own_lines + lines, 1.0f);

    std::uint16_t* own_codes = codes_.data() + k * static_cast<std::size_t>(code_stride);
    float* own = floats_.data() + k * static_cast<std::size_t>(stride);
    const double largest = *std::max_element(d.density(0), d.density(m));
    std::vector<double> mass_at(static_cast<std::size_t>(stride), beyond);  // in units of the largest density
    double sum = 0, previous = 0;
    for (int i = 0; i < m; ++i) {
      std::vector<double> density;
      for (int j = 0; j < n; ++j) {
        const std::uint16_t code = encode16(d.density(i)[j] / largest);
        density.push_back(decode16(code));
        // The crossing between two groups belongs to both.
        const int g = j / group, in_group = j % group;
        if (g < groups) own_codes[(g * meridians + i) * group_codes + in_group] = code;
        if (g > 0 && in_group == 0) own_codes[((g - 1) * meridians + i) * group_codes + group] = code;
      }
      double mass = 0;
      for (int j = 0; j + 1 < n; ++j) {
        if (j > 0 && j % group == 0)
          mass_at[static_cast<std::size_t>(starts + i * (groups - 1) + j / group - 1)] = mass;
        const double r0 = d.r()[j];
        mass += RadialCell<double>{r0, d.r()[j + 1] - r0, density[static_cast<std::size_t>(j)],
                                   density[static_cast<std::size_t>(j) + 1]}
                    .mass(1);
      }
      if (i > 0) sum += (double{d.phi()[i]} - d.phi()[i - 1]) * (previous + mass) / 2;
      mass_at[static_cast<std::size_t>(before + i)] = sum, mass_at[static_cast<std::size_t>(along + i)] = mass;
      previous = mass;
    }
    // From what is stored: the pdf is that of the draws whatever rounding did.
    const double scale = whole_mass() / sum;
    if (!(scale < 1e38))
      throw Error("batch: diagram " + std::to_string(k) + ": found a mass of " + std::to_string(sum) +
                  " of its largest density, expected more");
    for (int x = before; x < stride; ++x)
      own[x] = static_cast<float>(std::min(mass_at[static_cast<std::size_t>(x)] * scale, double{beyond}));
    own[0] = static_cast<float>(scale) * half_unit;
  }
}

std::size_t BatchLayout::bytes() const noexcept {
  return angles.bytes() + codes_.capacity() * sizeof(std::uint16_t) +
         (floats_.capacity() + lines_.capacity()) * sizeof(float);
}

BatchColour::BatchColour(const Colour& colour, const BatchLayout& stack)
    : side(colour.side()),
      unit(colour.largest() * half_unit),
      angles(colour.theta_i()),
      same_angles(angles.values == stack.angles.values),
      layer(side * (side / 2)),
      last_row(std::max(side / 2 - 2, 0)),
      next_row(side > 2 ? side : 0),
      next_layer(angles.count > 1 ? layer : 0) {
  check_size(3 * colour.cells());
  if (colour.empty()) return;
  codes.reserve(3 * colour.cells() + 2);
  codes.assign(colour.codes().begin(), colour.codes().begin() + static_cast<std::ptrdiff_t>(3 * colour.cells()));
  codes.resize(codes.size() + 2);
}

}  // namespace gonio
