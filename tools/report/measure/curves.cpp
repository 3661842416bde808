#include "tools/report/measure/curves.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

glm::vec3 incident(double theta_i) {
  return {static_cast<float>(std::sin(theta_i * degree)), 0, static_cast<float>(std::cos(theta_i * degree))};
}

/// In the plane of incidence; positive angles lie on the side of the mirror direction.
glm::vec3 in_plane(double theta_o) {
  return {static_cast<float>(-std::sin(theta_o * degree)), 0, static_cast<float>(std::cos(theta_o * degree))};
}

double rounded(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return std::strtod(text, nullptr);
}

/// Luminance of f_r cos(theta_o).
double transfer(const proof::Subject& subject, const glm::vec3& wi, const glm::vec3& wo) {
  return static_cast<double>(luminance(subject.f_r(wi, wo))) * static_cast<double>(wo.z);
}

/// Every two degrees, and every quarter around the peak, which may be no wider than a degree.
std::vector<double> section_angles(const proof::Subject& subject, const glm::vec3& wi) {
  constexpr double fine = 0.25, coarse = 2, last = 89.75, around = 10;
  double peak = 0, largest = -1;
  for (double t = -last; t <= last; t += fine)
    if (const double value = transfer(subject, wi, in_plane(t)); value > largest) largest = value, peak = t;
  std::vector<double> angles{-last};
  for (int k = -359; k < 359; ++k) {
    const double t = k * fine;
    if (std::fmod(t, coarse) == 0 || std::abs(t - peak) <= around) angles.push_back(t);
  }
  angles.push_back(last);
  return angles;
}

/// Common logarithm of the density over its peak on the half disk phi in [0, pi]: 0 is the peak, -100
/// a thousandth and less.
nlohmann::json disk(const proof::Subject& subject, const glm::vec3& wi) {
  constexpr int sectors = 36, rings = 24;
  std::vector<double> density;
  for (int i = 0; i < sectors; ++i)
    for (int j = 0; j < rings; ++j) {
      const Polar<float> at{(static_cast<float>(j) + 0.5f) / rings,
                            pi<float> * (static_cast<float>(i) + 0.5f) / sectors};
      density.push_back(transfer(subject, wi, polar_to_direction(at)));
    }
  const double peak = *std::max_element(density.begin(), density.end());
  nlohmann::json levels = nlohmann::json::array();
  for (const double d : density)
    levels.push_back(d > 0 ? static_cast<int>(std::round(std::max(-100.0, 100.0 / 3 * std::log10(d / peak)))) : -100);
  return {{"sectors", sectors}, {"rings", rings}, {"levels", std::move(levels)}};
}

/// Shares of the weights over their mean w, in bins of log10 w that are 1/40 wide, from -1.5 to 1.5;
/// the outer bins take what is beyond.
nlohmann::json weights(const proof::Subject& subject, const glm::vec3& wi) {
  constexpr int side = 128, bins = 120;
  std::vector<double> drawn;
  double sum = 0;
  proof::Random random(1);
  for (int k = 0; k < side * side; ++k) {
    const glm::vec2 jitter = random.pair();
    const glm::vec2 u{(static_cast<float>(k / side) + jitter.x) / side,
                      (static_cast<float>(k % side) + jitter.y) / side};
    const auto s = subject.sample(wi, u);
    drawn.push_back(s ? static_cast<double>(luminance(s->weight)) : 0);
    sum += drawn.back();
  }
  std::vector<int> counts(bins, 0);
  int zero = 0;
  for (const double w : drawn) {
    if (!(w > 0)) {
      ++zero;
      continue;
    }
    const double bin = std::floor((std::log10(w * side * side / sum) + 1.5) * bins / 3);
    ++counts[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1.0))];
  }
  nlohmann::json shares = nlohmann::json::array();
  for (const int n : counts)
    n == 0 ? shares.push_back(0) : shares.push_back(rounded(static_cast<double>(n) / (side * side)));
  return {{"zero", rounded(static_cast<double>(zero) / (side * side))}, {"shares", std::move(shares)}};
}

/// Draws lines as the data of one SVG path in thousandths of the disk's radius; y points down, as SVG
/// has it.
class Path {
 public:
  /// The line through place(0) ... place(1): steps are halved where the ends lie far apart, and where
  /// they stay so, the map is torn and the line ends. So it does at a draw without a direction.
  template <class Place>
  void add_line(const Place& place) {
    constexpr int steps = 16;
    drawing_ = false;
    std::optional<Point> from = place(0.0f);
    if (from) draw(*from);
    for (int k = 0; k < steps; ++k)
      from = add_step(place, static_cast<float>(k) / steps, from, static_cast<float>(k + 1) / steps, 0);
  }

  std::string text() const { return text_.str(); }

  struct Point {
    long x, y;
  };

 private:
  template <class Place>
  std::optional<Point> add_step(const Place& place, float t0, const std::optional<Point>& from, float t1, int depth) {
    constexpr int deepest = 14;
    constexpr double far = 80;
    const std::optional<Point> to = place(t1);
    if (!from || !to) {
      drawing_ = false;
      if (to) draw(*to);
    } else if (std::hypot(to->x - from->x, to->y - from->y) < far) {
      draw(*to);
    } else if (depth < deepest) {
      const float middle = 0.5f * (t0 + t1);
      return add_step(place, middle, add_step(place, t0, from, middle, depth + 1), t1, depth + 1);
    } else {
      drawing_ = false;
      draw(*to);
    }
    return to;
  }

  void draw(const Point& to) {
    constexpr double near = 8;  // less than a pixel of a small picture
    if (!drawing_) {
      text_ << 'M' << to.x << ',' << to.y;
    } else if (std::hypot(to.x - last_.x, to.y - last_.y) < near) {
      return;
    } else {
      text_ << 'l' << to.x - last_.x << ',' << to.y - last_.y;
    }
    last_ = to;
    drawing_ = true;
  }

  std::ostringstream text_;
  Point last_{};
  bool drawing_ = false;
};

/// Lines of constant u, then of constant v.
std::string grid(const proof::Subject& subject, const glm::vec3& wi) {
  constexpr int lines = 16;
  const auto place = [&](float u, float v) -> std::optional<Path::Point> {
    constexpr float last = 0x1.fffffep-1f;  // samplers take numbers below 1
    const auto s = subject.sample(wi, {std::min(u, last), std::min(v, last)});
    if (!s) return std::nullopt;
    const Polar<float> p = direction_to_polar(s->wo);
    return Path::Point{std::lround(1000 * p.r * std::cos(p.phi)), -std::lround(1000 * p.r * std::sin(p.phi))};
  };
  Path path;
  for (int line = 0; line <= lines; ++line)
    path.add_line([&](float t) { return place(static_cast<float>(line) / lines, t); });
  for (int line = 0; line <= lines; ++line)
    path.add_line([&](float t) { return place(t, static_cast<float>(line) / lines); });
  return path.text();
}

}  // namespace

nlohmann::json table_curves(const proof::Subject& subject, double theta_i, double albedo) {
  const glm::vec3 wi = incident(theta_i);
  const std::vector<double> angles = section_angles(subject, wi);
  nlohmann::json table = nlohmann::json::array();
  for (const double t : angles) table.push_back(albedo > 0 ? rounded(transfer(subject, wi, in_plane(t)) / albedo) : 0);
  return {{"theta_i_deg", theta_i}, {"theta_o_deg", angles}, {"table", std::move(table)}, {"disk", disk(subject, wi)}};
}

nlohmann::json method_curves(const proof::Subject& subject, double theta_i, const nlohmann::json& theta_o_deg,
                             bool with_grid) {
  const glm::vec3 wi = incident(theta_i);
  nlohmann::json pdf = nlohmann::json::array();
  for (const double t : theta_o_deg) pdf.push_back(rounded(subject.pdf(wi, in_plane(t))));
  nlohmann::json curves = {{"theta_i_deg", theta_i}, {"pdf", std::move(pdf)}, {"weights", weights(subject, wi)}};
  if (with_grid) curves["grid"] = grid(subject, wi);
  return curves;
}

nlohmann::json model_curves(const LobeModel& model, double theta_i, const nlohmann::json& theta_o_deg, double albedo) {
  const glm::vec3 wi = incident(theta_i);
  nlohmann::json values = nlohmann::json::array();
  for (const double t : theta_o_deg) {
    const glm::vec3 wo = in_plane(t);
    const double value = static_cast<double>(luminance(glm::vec3(model.eval(wi, wo)))) * static_cast<double>(wo.z);
    values.push_back(albedo > 0 ? rounded(value / albedo) : 0);
  }
  return {{"theta_i_deg", theta_i}, {"model", std::move(values)}};
}

}  // namespace gonio
