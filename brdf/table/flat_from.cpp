#include <algorithm>
#include <cmath>

#include <gonio/brdf/table/flat_from.h>

namespace gonio {
namespace {

constexpr float degree = 0.01745329252f;

glm::vec3 direction(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

bool same(const glm::vec3& a, const glm::vec3& b) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(a[c] - b[c]) > 1e-4f * std::max(a[c], b[c])) return false;
  return true;
}

// `f_r` of the angle that varies, of the other one and of the azimuth between them.
template <class Reflectance>
int first_flat(const Reflectance& f_r) {
  constexpr int last = 89, side = 8;
  const auto as_at_the_end = [&](int degrees) {
    for (int i = 0; i < side * side; ++i) {
      const float other = (static_cast<float>(i / side) + 0.5f) * (90.0f / side) * degree;
      const float phi = (static_cast<float>(i % side) + 0.5f) * (180.0f / side) * degree;
      if (!same(f_r(static_cast<float>(degrees) * degree, other, phi), f_r(last * degree, other, phi))) return false;
    }
    return true;
  };
  int first = last;
  while (first > 0 && as_at_the_end(first - 1)) --first;
  return first < last ? first : 90;
}

}  // namespace

FlatFrom flat_from(const BrdfTable& table) {
  FlatFrom result;
  result.theta_i = first_flat([&](float theta_i, float theta_o, float phi) {
    return table.eval(direction(theta_i, 0), direction(theta_o, phi));
  });
  result.theta_o = first_flat([&](float theta_o, float theta_i, float phi) {
    return table.eval(direction(theta_i, 0), direction(theta_o, phi));
  });
  return result;
}

}  // namespace gonio
