#include "tools/stability/figures.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/charts/concentric.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

void begin(std::ostream& out, double width, double height, const std::string& title, const std::string& subtitle) {
  out << std::fixed << std::setprecision(1) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width
      << ' ' << height << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"" << width << "\" height=\""
      << height << "\" fill=\"white\"/>\n<text x=\"20\" y=\"26\" font-size=\"17\">" << title
      << "</text>\n<text x=\"20\" y=\"45\" fill=\"#555\">" << subtitle << "</text>\n";
}

void text(std::ostream& out, double x, double y, const std::string& what, const char* anchor = "start",
          const char* more = "") {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\" " << more << '>' << what
      << "</text>\n";
}

std::string fixed(double x, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << x;
  return out.str();
}

/// Axes of a plot over theta from 0 to 90 degrees.
struct Plot {
  double x, y, width, height, low, high;

  double px(double theta) const { return x + width * theta / (90 * degree); }
  double py(double value) const { return y + height * (high - value) / (high - low); }

  void axes(std::ostream& out, const std::string& caption, double step, int digits) const {
    out << "<g stroke=\"#ccc\">\n";
    for (int t = 0; t <= 90; t += 15) out << "<path d=\"M" << px(t * degree) << ' ' << y << 'v' << height << "\"/>\n";
    for (double v = low; v < high + step / 2; v += step)
      out << "<path d=\"M" << x << ' ' << py(v) << 'h' << width << "\"/>\n";
    out << "</g>\n";
    for (int t = 0; t <= 90; t += 15) text(out, px(t * degree), y + height + 16, std::to_string(t), "middle");
    for (double v = low; v < high + step / 2; v += step) text(out, x - 6, py(v) + 4, fixed(v, digits), "end");
    text(out, x, y - 8, caption);
    text(out, x + width / 2, y + height + 32, "theta [degrees]", "middle");
  }

  template <class Function>
  void curve(std::ostream& out, const char* colour, const Function& function) const {
    out << "<polyline fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"1.6\" points=\"";
    constexpr int steps = 900;
    for (int k = 0; k < steps; ++k) {
      const double theta = 90 * degree * (k + 0.5) / steps;  // never on a parallel
      out << px(theta) << ',' << std::setprecision(2) << py(function(theta)) << std::setprecision(1) << ' ';
    }
    out << "\"/>\n";
  }
};

/// The worst case of `intervals` steps: every step falls from 1 to 0.
ReadingError falling(double theta, int intervals) {
  const double step = pi<double> / 2 / intervals;
  const double k = std::min(std::floor(theta / step), intervals - 1.0);
  return reading_error(theta, k * step, (k + 1) * step, 1, 0);
}

}  // namespace

ReadingError reading_error(double theta, double theta1, double theta2, double d1, double d2) {
  const double r1 = theta_to_radius(theta1), r2 = theta_to_radius(theta2);
  ReadingError e;
  e.correct = d1 + (theta - theta1) / (theta2 - theta1) * (d2 - d1);
  e.real = d1 + (d2 - d1) * (theta_to_radius(theta) - r1) / (r2 - r1);
  e.absolute = (e.real - e.correct) / std::max(d1, d2);
  e.relative = e.correct > 0 ? (e.real - e.correct) / e.correct : 0;
  return e;
}

WorstReading worst_reading_error(int intervals) {
  WorstReading worst{};
  constexpr int steps = 20000;
  for (int k = 0; k < intervals; ++k) {
    const double a = pi<double> / 2 * k / intervals, b = pi<double> / 2 * (k + 1) / intervals;
    for (int n = 0; n < steps; ++n) {
      const double theta = a + (b - a) * (n + 0.5) / steps;
      for (const bool falls : {true, false}) {
        const ReadingError e = reading_error(theta, a, b, falls, !falls);
        if (std::abs(e.absolute) > worst.absolute) worst.absolute = std::abs(e.absolute), worst.absolute_at = theta;
        if (std::abs(e.relative) > worst.relative) worst.relative = std::abs(e.relative), worst.relative_at = theta;
      }
    }
  }
  return worst;
}

DiagramGrid figure_6_grid(bool zero_patch) {
  DiagramGrid grid;
  grid.azimuth = Azimuth::full;
  for (int i = 0; i < 7; ++i) grid.phi.push_back(2 * pi<double> * i / 6);
  for (int j = 0; j < 6; ++j) grid.r.push_back(theta_to_radius(90 * degree * j / 5));
  grid.r.back() = 1;
  proof::Random random(7);
  const double pole = 0.55;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 6; ++j) grid.density.push_back(j == 0 ? pole : 0.1 + 0.9 * static_cast<double>(random()));
  for (std::size_t j = 0; j < 6; ++j) grid.at(6, j) = grid.at(0, j);
  if (zero_patch)
    for (const std::size_t i : {1u, 2u})
      for (const std::size_t j : {2u, 3u}) grid.at(i, j) = 0;
  return grid;
}

void write_chart(const std::filesystem::path& path, const std::vector<StabilityRow>& rows) {
  std::vector<std::string> variants, inputs;
  for (const StabilityRow& row : rows) {
    if (std::find(variants.begin(), variants.end(), row.variant) == variants.end()) variants.push_back(row.variant);
    if (std::find(inputs.begin(), inputs.end(), row.input) == inputs.end()) inputs.push_back(row.input);
  }
  const auto index = [](const std::vector<std::string>& names, const std::string& name) {
    return static_cast<double>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  constexpr double left = 190, top = 175, cell_width = 46, cell_height = 24;
  const double width = left + cell_width * static_cast<double>(inputs.size()) + 90;
  const double height = top + cell_height * static_cast<double>(variants.size()) + 65;
  write_stream_atomically(path, [&](std::ostream& out) {
    begin(out, width, height, "Where methods fail",
          "Decimal logarithm of the largest error over the bound; red cells fail: e by that error, b by bias, c by "
          "chi-square.");
    for (const std::string& name : inputs) {
      const double x = left + cell_width * (index(inputs, name) + 0.6);
      out << "<text transform=\"translate(" << x << ' ' << top - 8 << ") rotate(-50)\">" << name << "</text>\n";
    }
    for (const std::string& name : variants) {
      const bool library = name.rfind("gonio-", 0) == 0;
      text(out, left - 8, top + cell_height * (index(variants, name) + 0.7), name, "end",
           library ? "font-weight=\"bold\"" : "");
    }
    for (const StabilityRow& row : rows) {
      const double x = left + cell_width * index(inputs, row.input),
                   y = top + cell_height * index(variants, row.variant);
      const double excess = std::log10(std::max(row.max_error / row.bound, 1e-3));
      const double t = std::clamp(0.25 + 0.75 * excess / 6, 0.25, 1.0);
      const auto blend = [&](int to) { return static_cast<int>(255 + t * (to - 255)); };
      out << "<rect x=\"" << x << "\" y=\"" << y << "\" width=\"" << cell_width - 2 << "\" height=\"" << cell_height - 2
          << "\" fill=\"";
      if (row.fails())
        out << "rgb(" << blend(200) << ',' << blend(30) << ',' << blend(40) << ")\"/>\n";
      else
        out << "#cfe8d3\"/>\n";
      std::string label = row.max_error > 0 && excess > -3 ? fixed(excess, 1) : "";
      if (row.fails())
        label +=
            std::string(" ") + (row.error_fails ? "e" : "") + (row.bias_fails ? "b" : "") + (row.chi2_fails ? "c" : "");
      text(out, x + cell_width / 2 - 1, y + 15, label, "middle",
           row.fails() && t > 0.6 ? "font-size=\"9.5\" fill=\"white\"" : "font-size=\"9.5\"");
    }
    const double y = height - 35;
    text(out, left, y, "Green: all three hold. A blank or negative number: below the bound. Bold: the library's own.");
    out << "</svg>\n";
  });
}

void write_figure_3(const std::filesystem::path& path) {
  write_stream_atomically(path, [](std::ostream& out) {
    begin(out, 1250, 385, "The error of M_E (Havran et al. 2003, Fig. 3)",
          "A density that falls from 1 to 0 between neighbouring parallels, linear in theta (d_C), is read as linear "
          "in sqrt(1 - cos theta) "
          "(d_R). Errors: absolute black, relative orange.");
    const Plot density{60, 95, 340, 230, 0, 1};
    density.axes(out, "density, N = 2: d_C blue, d_R red", 0.2, 1);
    density.curve(out, "#2166ac", [](double t) { return falling(t, 1).correct; });
    density.curve(out, "#b2182b", [](double t) { return falling(t, 1).real; });
    double x = 470;
    for (const int intervals : {1, 10}) {
      const WorstReading worst = worst_reading_error(intervals);
      const Plot error{x, 95, 340, 230, 0, intervals == 1 ? 25.0 : 5.0};
      error.axes(out,
                 std::string(intervals == 1 ? "N = 2" : "ten intervals") + ", error [%]: to " +
                     fixed(100 * worst.absolute, 2) + " and " + fixed(100 * worst.relative, 1),
                 intervals == 1 ? 5 : 1, 0);
      error.curve(out, "#222", [&](double t) { return 100 * std::abs(falling(t, intervals).absolute); });
      error.curve(out, "#d95f02", [&](double t) { return 100 * std::abs(falling(t, intervals).relative); });
      x += 410;
    }
    out << "</svg>\n";
  });
}

void write_figure_6(const std::filesystem::path& path) {
  constexpr double radius = 170, gap = 30, top = 70;
  write_stream_atomically(path, [&](std::ostream& out) {
    begin(out, 4 * 2 * radius + 5 * gap, top + 2 * radius + 60, "The maps at work (Havran et al. 2003, Fig. 6)",
          "A 24 x 24 grid of the unit square (red) and 1024 points of a Hammersley set, as diagrams of N = 6 parallels "
          "and M = 7 "
          "meridians (grey) carry them to the disk.");
    const char* const captions[] = {"(a) the unit square", "(b) constant density", "(c) random densities",
                                    "(d) as (c), one patch of zeros"};
    for (int panel = 0; panel < 4; ++panel) {
      DiagramGrid grid = figure_6_grid(panel == 3);
      if (panel < 2) std::fill(grid.density.begin(), grid.density.end(), 1.0);
      const Diagram<double> diagram(grid);
      const double cx = gap + radius + panel * (2 * radius + gap), cy = top + radius;
      const auto carry = [&](double u, double v) -> std::pair<double, double> {
        if (panel == 0) return {cx + radius * (2 * u - 1), cy - radius * (2 * v - 1)};
        const DiskPoint<double> disk = square_to_disk(u, v);
        const Polar<double> at = diagram.sample(disk.turn, disk.r2).at;
        return {cx + radius * at.r * std::cos(at.phi), cy - radius * at.r * std::sin(at.phi)};
      };
      if (panel == 0) {
        out << "<rect x=\"" << cx - radius << "\" y=\"" << cy - radius << "\" width=\"" << 2 * radius << "\" height=\""
            << 2 * radius << "\" fill=\"none\" stroke=\"#222\"/>\n";
      } else {
        if (panel == 3) {  // the patch
          out << "<path fill=\"#fee8a0\" d=\"";
          for (int k = 0; k <= 40; ++k) {
            const bool back = k > 20;
            const double a = grid.phi[1] + (grid.phi[2] - grid.phi[1]) * (back ? 40 - k : k) / 20.0,
                         r = radius * grid.r[back ? 3 : 2];
            out << (k == 0 ? 'M' : 'L') << cx + r * std::cos(a) << ' ' << cy - r * std::sin(a);
          }
          out << "Z\"/>\n";
        }
        out << "<g fill=\"none\" stroke=\"#999\">\n";
        for (const double r : grid.r)
          out << "<circle cx=\"" << cx << "\" cy=\"" << cy << "\" r=\"" << radius * r << "\"/>\n";
        for (const double a : grid.phi)
          out << "<path d=\"M" << cx << ' ' << cy << 'L' << cx + radius * std::cos(a) << ' '
              << cy - radius * std::sin(a) << "\"/>\n";
        out << "</g>\n";
      }
      out << "<g fill=\"none\" stroke=\"#b2182b\" stroke-width=\"0.6\">\n";
      constexpr int lines = 24, steps = 192;
      for (int line = 0; line <= lines; ++line)
        for (const bool across : {true, false}) {
          out << "<polyline points=\"";
          for (int step = 0; step <= steps; ++step) {
            const double a = static_cast<double>(line) / lines, b = static_cast<double>(step) / steps;
            const auto [x, y] = across ? carry(a, b) : carry(b, a);
            out << x << ',' << y << ' ';
          }
          out << "\"/>\n";
        }
      out << "</g>\n<g fill=\"#2166ac\">\n";
      for (unsigned k = 0; k < 1024; ++k) {
        unsigned bits = 0;
        for (int b = 0; b < 10; ++b) bits |= (k >> b & 1u) << (9 - b);
        const auto [x, y] = carry((k + 0.5) / 1024, (bits + 0.5) / 1024);
        out << "<circle cx=\"" << x << "\" cy=\"" << y << "\" r=\"1.3\"/>\n";
      }
      out << "</g>\n";
      text(out, cx, cy + radius + 26, captions[panel], "middle", "font-size=\"14\"");
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio
