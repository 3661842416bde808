#include <algorithm>
#include <cmath>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/photometry.h>

namespace gonio {
namespace {

constexpr double turn = 2 * pi<double>;

struct Point {
  double angle, cd;
};

/// The intensities of a whole plane as a closed polyline in the angle from the nadir: positive in
/// the half plane C, negative in C + 180.
std::vector<Point> plane_profile(const LightDiagram& d, double c) {
  std::vector<Point> points;
  for (double side : {1.0, -1.0}) {
    const double half_plane = side > 0 ? c : c + pi<double>;
    for (double g : d.gamma) points.push_back({side * g, d.intensity({half_plane, g})});
    // Where only one hemisphere is covered the rest is dark up to its edge.
    for (double edge : {d.gamma.front() - 1e-9, d.gamma.back() + 1e-9})
      if (edge > 0.1 && edge < 3) points.push_back({side * edge, 0});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.angle < b.angle; });
  return points;
}

/// The smallest arc that holds all of a closed polyline that is at least `level`.
double arc_above(const std::vector<Point>& points, double level) {
  std::vector<double> rise, fall;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& a = points[k];
    Point b = points[(k + 1) % points.size()];
    if (k + 1 == points.size()) b.angle += turn;
    if ((a.cd >= level) == (b.cd >= level)) continue;
    const double t = (level - a.cd) / (b.cd - a.cd);
    (b.cd >= level ? rise : fall).push_back(a.angle + t * (b.angle - a.angle));
  }
  if (rise.empty()) return points.front().cd >= level ? turn : 0;
  double widest_gap = 0;
  for (double from : fall) {
    double gap = turn;
    for (double to : rise) {
      double distance = to - from;
      while (distance < 0) distance += turn;
      gap = std::min(gap, distance);
    }
    widest_gap = std::max(widest_gap, gap);
  }
  return turn - widest_gap;
}

Photometry::Spread spread(const LightDiagram& d, double c) {
  const std::vector<Point> points = plane_profile(d, c);
  double largest = 0;
  for (const Point& p : points) largest = std::max(largest, p.cd);
  if (!(largest > 0)) return {0, 0};
  return {arc_above(points, largest / 2), arc_above(points, largest / 10)};
}

}  // namespace

Photometry photometry(const LightDiagram& diagram) {
  const LightDiagram d = in_frame(diagram, LightFrame{});
  Photometry p;
  p.flux = flux(diagram);  // the same in every frame
  p.downward_flux = flux(d, 0, pi<double> / 2);
  const std::size_t best =
      static_cast<std::size_t>(std::max_element(diagram.cd.begin(), diagram.cd.end()) - diagram.cd.begin());
  p.max_cd = diagram.cd[best];
  const std::size_t n = diagram.gamma.size();
  p.max_at = to_light_angles(LightFrame{}, diagram.frame.direction(diagram.c[best / n], diagram.gamma[best % n]));
  if (std::sin(p.max_at.gamma) < 1e-9) p.max_at.c = 0;
  p.c0 = spread(d, 0);
  p.c90 = spread(d, pi<double> / 2);
  for (int k = 0; k < 18; ++k) p.zones.push_back(flux(d, pi<double> * k / 18, pi<double> * (k + 1) / 18));
  return p;
}

std::optional<double> light_output_ratio(const Luminaire& light) {
  if (light.absolute || !light.lamp_lumens) return {};
  return flux(light.diagram) / *light.lamp_lumens;
}

std::optional<double> efficacy(const Luminaire& light) {
  if (!(light.watts > 0)) return {};
  return flux(light.diagram) / light.watts;
}

std::string flux_unit(const Luminaire& light) {
  const std::string& unit = light.unit;
  if (unit == "cd") return "lm";
  const std::size_t per = unit.rfind("/sr");
  return per != std::string::npos && per + 3 == unit.size() ? unit.substr(0, per) : unit + " sr";
}

LightDiagram normalised(LightDiagram diagram, LightNormalisation mode, double target) {
  if (mode == LightNormalisation::none) return diagram;
  const double now = mode == LightNormalisation::flux ? flux(diagram) : max_intensity(diagram);
  if (!(now > 0)) throw Error("light: normalisation: found a diagram that is dark, expected some light");
  for (double& v : diagram.cd) v *= target / now;
  return diagram;
}

}  // namespace gonio
