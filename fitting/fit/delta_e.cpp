#include <cmath>

#include <gonio/fitting/fit/delta_e.h>
#include <gonio/mapping/charts/concentric.h>

namespace gonio {

glm::dvec3 lab_from_rgb(const glm::dvec3& rgb) noexcept {
  // ITU-R BT.709-6; each row divided by its sum, which is the white.
  const double x = (0.4124564 * rgb.r + 0.3575761 * rgb.g + 0.1804375 * rgb.b) / 0.9504700;
  const double y = 0.2126729 * rgb.r + 0.7151522 * rgb.g + 0.0721750 * rgb.b;
  const double z = (0.0193339 * rgb.r + 0.1191920 * rgb.g + 0.9503041 * rgb.b) / 1.0888300;
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

double delta_e_2000(const glm::dvec3& lab1, const glm::dvec3& lab2) noexcept {
  constexpr double turn = 2 * pi<double>, degree = pi<double> / 180;
  const auto seventh = [](double c) { return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7))); };
  const double c_mean = (std::hypot(lab1.y, lab1.z) + std::hypot(lab2.y, lab2.z)) / 2;
  const double g = 0.5 * (1 - seventh(c_mean));
  const double a1 = (1 + g) * lab1.y, a2 = (1 + g) * lab2.y;
  const double c1 = std::hypot(a1, lab1.z), c2 = std::hypot(a2, lab2.z);
  const auto hue = [&](double a, double b) {
    const double h = a == 0 && b == 0 ? 0 : std::atan2(b, a);
    return h < 0 ? h + turn : h;
  };
  const double h1 = hue(a1, lab1.z), h2 = hue(a2, lab2.z);
  double dh = 0, h_mean = h1 + h2;
  if (c1 * c2 != 0) {
    dh = h2 - h1;
    if (dh > pi<double>) dh -= turn;
    if (dh < -pi<double>) dh += turn;
    if (std::fabs(h1 - h2) <= pi<double>) {
      h_mean = (h1 + h2) / 2;
    } else {
      h_mean = (h1 + h2 < turn ? h1 + h2 + turn : h1 + h2 - turn) / 2;
    }
  }
  const double dl = lab2.x - lab1.x, dc = c2 - c1, dhh = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2);
  const double l_mean = (lab1.x + lab2.x) / 2, cp_mean = (c1 + c2) / 2;
  const double t = 1 - 0.17 * std::cos(h_mean - 30 * degree) + 0.24 * std::cos(2 * h_mean) +
                   0.32 * std::cos(3 * h_mean + 6 * degree) - 0.20 * std::cos(4 * h_mean - 63 * degree);
  const double bell = (h_mean / degree - 275) / 25;
  const double rotation = -std::sin(60 * degree * std::exp(-bell * bell)) * 2 * seventh(cp_mean);
  const double l50 = (l_mean - 50) * (l_mean - 50);
  const double sl = 1 + 0.015 * l50 / std::sqrt(20 + l50), sc = 1 + 0.045 * cp_mean;
  const double sh = 1 + 0.015 * cp_mean * t;
  const double l = dl / sl, c = dc / sc, h = dhh / sh;
  return std::sqrt(l * l + c * c + h * h + rotation * c * h);
}

}  // namespace gonio
