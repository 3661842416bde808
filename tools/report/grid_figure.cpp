#include "tools/report/grid_figure.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include <gonio/mapping/base/atomic_file.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
constexpr double angles[] = {5, 30, 60, 80};
constexpr double radius = 150, gap = 20, top = 60;

struct Panel {
  double cx, cy;
  float theta_i;
  const Stack<float>& stack;
};

/// White at and below a thousandth of the peak, dark blue at the peak, logarithmic between.
void shade(std::ostream& out, const Panel& panel) {
  constexpr int sectors = 60, rings = 24;
  double density[sectors][rings], peak = 0;
  for (int i = 0; i < sectors; ++i)
    for (int j = 0; j < rings; ++j) {
      const Polar<float> at{(static_cast<float>(j) + 0.5f) / rings,
                            2 * pi<float> * (static_cast<float>(i) + 0.5f) / sectors};
      density[i][j] = panel.stack.pdf(panel.theta_i, polar_to_direction(at));
      peak = std::max(peak, density[i][j]);
    }
  for (int i = 0; i < sectors; ++i)
    for (int j = 0; j < rings; ++j) {
      const double t = std::clamp(1 + std::log10(std::max(density[i][j] / peak, 1e-9)) / 3, 0.0, 1.0);
      if (t < 0.02) continue;
      const double a = 2 * pi<double> * i / sectors, b = 2 * pi<double> * (i + 1) / sectors;
      const double r0 = radius * j / rings, r1 = radius * (j + 1) / rings;
      const auto blend = [&](int from, int to) { return static_cast<int>(from + t * (to - from)); };
      out << "<path fill=\"rgb(" << blend(255, 33) << ',' << blend(255, 102) << ',' << blend(255, 172) << ")\" d=\"M"
          << panel.cx + r0 * std::cos(a) << ' ' << panel.cy - r0 * std::sin(a) << 'L' << panel.cx + r1 * std::cos(a)
          << ' ' << panel.cy - r1 * std::sin(a) << 'L' << panel.cx + r1 * std::cos(b) << ' '
          << panel.cy - r1 * std::sin(b) << 'L' << panel.cx + r0 * std::cos(b) << ' ' << panel.cy - r0 * std::sin(b)
          << "Z\"/>\n";
    }
}

void draw_grid(std::ostream& out, const Panel& panel) {
  constexpr int lines = 16, steps = 64;
  for (int direction = 0; direction < 2; ++direction) {
    for (int line = 0; line <= lines; ++line) {
      out << "<polyline points=\"";
      for (int step = 0; step <= steps; ++step) {
        const float a = static_cast<float>(line) / lines, b = static_cast<float>(step) / steps;
        const auto s =
            direction == 0 ? panel.stack.sample(panel.theta_i, a, b) : panel.stack.sample(panel.theta_i, b, a);
        const Polar<float> p = direction_to_polar(s.wo);
        out << panel.cx + radius * p.r * std::cos(p.phi) << ',' << panel.cy - radius * p.r * std::sin(p.phi) << ' ';
      }
      out << "\"/>\n";
    }
  }
}

}  // namespace

void write_grid_figure(const std::filesystem::path& path, const std::string& title, const Stack<float>& stack) {
  constexpr double count = std::size(angles);
  const double width = count * (2 * radius + gap) + gap, height = top + 2 * radius + 50;
  write_stream_atomically(path, [&](std::ostream& out) {
    out << std::fixed << std::setprecision(1) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width
        << ' ' << height << "\" font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"" << width << "\" height=\""
        << height << "\" fill=\"white\"/>\n<text x=\"" << gap << "\" y=\"26\" font-size=\"17\">";
    for (const char c : title) c == '&' ? out << "&amp;" : c == '<' ? out << "&lt;" : out << c;
    out << "</text>\n<text x=\"" << gap
        << "\" y=\"46\" fill=\"#555\">a 16 x 16 grid of the unit square, carried to the hemisphere (seen from above; "
           "light comes from the right, "
           "the mirror direction is left)</text>\n";
    double cx = gap + radius;
    for (const double angle : angles) {
      const Panel panel{cx, top + radius, static_cast<float>(angle * degree), stack};
      out << "<g shape-rendering=\"crispEdges\">\n";
      shade(out, panel);
      out << "</g>\n";
      out << "<g fill=\"none\" stroke=\"#b2182b\" stroke-width=\"0.6\">\n";
      draw_grid(out, panel);
      out << "</g>\n<circle cx=\"" << cx << "\" cy=\"" << panel.cy << "\" r=\"" << radius
          << "\" fill=\"none\" stroke=\"#222\"/>\n<text x=\"" << cx << "\" y=\"" << top + 2 * radius + 26
          << "\" text-anchor=\"middle\">incident angle " << std::setprecision(0) << angle << std::setprecision(1)
          << "°</text>\n";
      cx += 2 * radius + gap;
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio
