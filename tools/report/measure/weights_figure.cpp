#include "tools/report/measure/weights_figure.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <ostream>

#include <gonio/mapping/base/atomic_file.h>

#include "tools/report/measure/report_data.h"

namespace gonio {
namespace {

constexpr double panel = 144, gap = 16, left = 176, top = 74;

/// The colour of a weight: saturated at half and at twice the mean.
void fill(std::ostream& out, float weight) {
  const double t = std::clamp(std::log2(std::max(static_cast<double>(weight), 1e-9)), -1.0, 1.0),
               keep = 1 - std::abs(t);
  const auto towards = [&](int full) { return static_cast<int>(full + keep * (255 - full)); };
  if (t < 0)
    out << "rgb(" << towards(33) << ',' << towards(102) << ',' << towards(172) << ')';
  else
    out << "rgb(" << towards(178) << ',' << towards(24) << ',' << towards(43) << ')';
}

}  // namespace

WeightMap weight_map(const proof::Subject& subject, double theta_i) {
  constexpr int side = WeightMap::side, points = 4;
  const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
  WeightMap map;
  double total = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      double sum = 0;
      for (int a = 0; a < points; ++a)
        for (int b = 0; b < points; ++b) {
          const auto at = [&](int cell, int point) {
            return (static_cast<float>(cell) + (static_cast<float>(point) + 0.5f) / points) / side;
          };
          const auto s = subject.sample(wi, {at(i, a), at(j, b)});
          if (s) sum += static_cast<double>(luminance(s->weight));
        }
      map.weight.push_back(static_cast<float>(sum / (points * points)));
      total += sum / (points * points);
    }
  const double mean = total / static_cast<double>(map.weight.size());
  if (mean > 0)
    for (float& w : map.weight) w = static_cast<float>(w / mean);
  return map;
}

void write_weights_figure(const std::filesystem::path& path, const std::string& title,
                          const std::vector<WeightRow>& rows) {
  constexpr double angles = std::size(report_angles);
  const double width = left + angles * (panel + gap),
               height = top + static_cast<double>(rows.size()) * (panel + gap + 18) + 10;
  write_stream_atomically(path, [&](std::ostream& out) {
    out << std::fixed << std::setprecision(2) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width
        << ' ' << height << "\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"" << width << "\" height=\""
        << height << "\" fill=\"white\"/>\n<text x=\"10\" y=\"26\" font-size=\"17\">";
    for (const char c : title) c == '&' ? out << "&amp;" : c == '<' ? out << "&lt;" : out << c;
    out << "</text>\n<text x=\"10\" y=\"46\" fill=\"#555\">weights over the unit square (u to the right, v upwards), "
           "as multiples of their mean: white 1, "
           "blue 1/2 and less, red 2 and more</text>\n";
    for (std::size_t k = 0; k < std::size(report_angles); ++k)
      out << "<text x=\"" << left + static_cast<double>(k) * (panel + gap) + panel / 2 << "\" y=\"" << top - 8
          << "\" text-anchor=\"middle\">θi = " << std::setprecision(0) << report_angles[k] << std::setprecision(2)
          << "°</text>\n";
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const double y0 = top + static_cast<double>(row) * (panel + gap + 18);
      out << "<text x=\"10\" y=\"" << y0 + panel / 2 << "\">" << rows[row].name << "</text>\n";
      for (std::size_t k = 0; k < rows[row].maps.size(); ++k) {
        const double x0 = left + static_cast<double>(k) * (panel + gap), cell = panel / WeightMap::side;
        const auto& weight = rows[row].maps[k].weight;
        out << "<g shape-rendering=\"crispEdges\">";
        for (int i = 0; i < WeightMap::side; ++i)
          for (int j = 0; j < WeightMap::side; ++j) {
            const float w = weight[static_cast<std::size_t>(i * WeightMap::side + j)];
            if (std::abs(w - 1) < 0.01f) continue;  // white
            out << "<path fill=\"";
            fill(out, w);
            out << "\" d=\"M" << x0 + i * cell << ' ' << y0 + panel - (j + 1) * cell << 'h' << cell << 'v' << cell
                << "h-" << cell << "z\"/>";
          }
        out << "</g>\n<rect x=\"" << x0 << "\" y=\"" << y0 << "\" width=\"" << panel << "\" height=\"" << panel
            << "\" fill=\"none\" stroke=\"#222\"/>\n<text x=\"" << x0 + panel / 2 << "\" y=\"" << y0 + panel + 15
            << "\" text-anchor=\"middle\" fill=\"#555\" font-size=\"11\">relvar " << std::setprecision(4)
            << rows[row].relvar[k] << std::setprecision(2) << "</text>\n";
      }
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio
