#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/text_scanner.h>
#include <gonio/mapping/light/photometry.h>
#include <gonio/mapping/light/polar_svg.h>

namespace gonio {
namespace {

constexpr double radius = 230;  // of the outermost circle
constexpr std::array<const char*, 4> colours{"#b91c1c", "#1d4ed8", "#15803d", "#a16207"};
constexpr std::array<const char*, 4> dashes{"", "9 5", "3 4", "12 4 3 4"};

struct Layout {
  double factor;  // of cd
  double top;     // value of the outermost circle
  double ring;    // distance of circles
  bool upper;
  double x, y;
};

Layout layout(const Luminaire& light, const PolarPlot& plot) {
  if (plot.planes.empty() || plot.planes.size() > colours.size())
    throw Error("polar diagram: found " + std::to_string(plot.planes.size()) + " planes, expected 1 to 4");
  const LightDiagram& d = light.diagram;
  const double total = flux(d);
  if (!(total > 0)) throw Error("polar diagram: the luminaire is dark, expected some light");
  Layout l;
  l.factor = plot.per_klm ? 1000 / total : 1;
  const double largest = max_intensity(d) * l.factor;
  l.upper = false;
  for (double plane : plot.planes)
    for (int k = -720; k <= 720; ++k) {
      const double g = pi<double> * k / 720;
      const double v = d.intensity(LightFrame{}.direction(k < 0 ? plane + pi<double> : plane, std::abs(g)));
      if (std::abs(k) > 364 && v > 0.002 * max_intensity(d)) l.upper = true;
    }
  // Four to six circles at 1, 2, 2.5 or 5 times a power of ten.
  const double power = std::pow(10, std::floor(std::log10(largest / 4)));
  l.ring = power;
  for (double step : {1.0, 2.0, 2.5, 5.0, 10.0})
    if (largest / (l.ring = step * power) <= 6) break;
  l.top = std::ceil(largest / l.ring * (1 - 1e-9)) * l.ring;
  l.x = 300;
  l.y = l.upper ? 310 : 90;
  return l;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : to_utf8(text)) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string degrees(double angle) { return format_number(std::round(angle * 1800 / pi<double>) / 10) + "&#176;"; }

}  // namespace

PolarScale polar_scale(const Luminaire& light, const PolarPlot& plot) {
  const Layout l = layout(light, plot);
  return {radius / l.top, l.x, l.y};
}

std::string polar_svg(const Luminaire& light, const PolarPlot& plot) {
  const Layout l = layout(light, plot);
  const Photometry p = photometry(light.diagram);
  const double plot_bottom = l.y + radius;
  const double height = plot_bottom + 58 + 18 * static_cast<double>(plot.planes.size());
  const std::string unit = plot.per_klm ? light.unit + "/klm" : light.unit;
  std::ostringstream svg;
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 " << number(height)
      << "\" font-family=\"DejaVu Sans, Helvetica, sans-serif\" font-size=\"13\">\n";
  const std::string title = plot.title.empty() ? light.name : plot.title;
  svg << "<title>" << escaped(title) << "</title>\n<rect width=\"600\" height=\"" << number(height)
      << "\" fill=\"#fff\"/>\n<text x=\"300\" y=\"28\" text-anchor=\"middle\" font-size=\"16\">"
      << escaped(shortened(title, 70)) << "</text>\n<text x=\"300\" y=\"48\" text-anchor=\"middle\" fill=\"#555\">"
      << escaped(unit) << ", flux " << format_quantity(p.flux) << " " << escaped(flux_unit(light)) << "</text>\n";

  // Circles and rays.
  const auto ray_end = [&](double gamma, int side, double r) {
    return number(l.x + side * r * std::sin(gamma)) + "\" y2=\"" + number(l.y + r * std::cos(gamma));
  };
  for (double value = l.ring; value < l.top * (1 + 1e-9); value += l.ring) {
    const double r = value / l.top * radius;
    if (l.upper)
      svg << "<circle cx=\"" << number(l.x) << "\" cy=\"" << number(l.y) << "\" r=\"" << number(r) << "\"";
    else
      svg << "<path d=\"M" << number(l.x - r) << " " << number(l.y) << "A" << number(r) << " " << number(r) << " 0 0 0 "
          << number(l.x + r) << " " << number(l.y) << "\"";
    svg << " fill=\"none\" stroke=\"#ccc\"/>\n";
  }
  for (int a = 0; a <= (l.upper ? 180 : 90); a += 30)
    for (int side : {1, -1}) {
      if ((a == 0 || a == 180) && side < 0) continue;
      const double g = a * pi<double> / 180;
      svg << "<line x1=\"" << number(l.x) << "\" y1=\"" << number(l.y) << "\" x2=\"" << ray_end(g, side, radius)
          << "\" stroke=\"#ccc\"/>\n<text x=\"" << number(l.x + side * (radius + 16) * std::sin(g)) << "\" y=\""
          << number(l.y + (radius + 14) * std::cos(g) + 5) << "\" text-anchor=\"middle\" fill=\"#777\">" << a
          << "&#176;</text>\n";
    }

  // Curves; vertices at every parallel of the diagram and at least every half degree.
  std::vector<double> gammas = light.diagram.gamma;
  for (int k = 0; k <= 360; ++k) gammas.push_back(pi<double> * k / 360);
  std::sort(gammas.begin(), gammas.end());
  for (std::size_t k = 0; k < plot.planes.size(); ++k) {
    std::vector<std::pair<double, double>> points;
    const auto add = [&](double g, int side) {
      const double c = side > 0 ? plot.planes[k] : plot.planes[k] + pi<double>;
      const double r = light.diagram.intensity(LightFrame{}.direction(c, g)) * l.factor / l.top * radius;
      points.push_back({l.x + side * r * std::sin(g), l.y + r * std::cos(g)});
    };
    for (auto g = gammas.rbegin(); g != gammas.rend(); ++g) add(*g, -1);
    for (double g : gammas) add(g, 1);
    svg << "<path id=\"plane" << k << "\" d=\"";
    for (std::size_t i = 0; i < points.size(); ++i)
      svg << (i == 0 ? "M" : " L") << number(points[i].first) << " " << number(points[i].second);
    svg << "Z\" fill=\"none\" stroke=\"" << colours[k] << "\" stroke-width=\"2\" stroke-linejoin=\"round\"";
    if (*dashes[k] != 0) svg << " stroke-dasharray=\"" << dashes[k] << "\"";
    svg << "/>\n";
  }
  // Numbers of the circles, over the curves.
  for (double value = l.ring; value < l.top * (1 + 1e-9); value += l.ring)
    svg << "<text x=\"" << number(l.x + 4) << "\" y=\"" << number(l.y + value / l.top * radius - 3)
        << "\" fill=\"#333\" font-size=\"11\" stroke=\"#fff\" stroke-width=\"3\" "
           "paint-order=\"stroke\">"
        << format_number(value) << "</text>\n";

  // The legend: which plane is where, beam and field angle.
  for (std::size_t k = 0; k < plot.planes.size(); ++k) {
    const double y = plot_bottom + 48 + 18 * static_cast<double>(k);
    LightFrame turned;  // the plane as C0-C180 of a turned frame
    turned.c0 = LightFrame{}.direction(plot.planes[k], pi<double> / 2);
    turned.c90 = LightFrame{}.direction(plot.planes[k] + pi<double> / 2, pi<double> / 2);
    LightDiagram d = in_frame(light.diagram, turned);
    d.frame = LightFrame{};
    const Photometry::Spread s = photometry(d).c0;
    const double c = plot.planes[k];
    svg << "<line x1=\"60\" y1=\"" << number(y - 4) << "\" x2=\"100\" y2=\"" << number(y - 4) << "\" stroke=\""
        << colours[k] << "\" stroke-width=\"2\"";
    if (*dashes[k] != 0) svg << " stroke-dasharray=\"" << dashes[k] << "\"";
    svg << "/>\n<text x=\"110\" y=\"" << number(y) << "\">C" << format_number(c * 180 / pi<double>) << " right, C"
        << format_number(std::fmod(c * 180 / pi<double> + 180, 360)) << " left; beam " << degrees(s.beam) << ", field "
        << degrees(s.field) << "</text>\n";
  }
  svg << "</svg>\n";
  return svg.str();
}

}  // namespace gonio
