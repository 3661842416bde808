#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include <glm/common.hpp>

#include <gonio/brdf/proof/edges.h>
#include <gonio/brdf/proof/incident.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio::proof {
namespace {

constexpr float margin = 0x1p-10f;  // of the interior

/// Numbers in [0, 1) next to both ends, at all scales.
std::vector<float> edge_numbers() {
  std::vector<float> x{0, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::min()};
  for (int k = 3; k <= 32; ++k) x.push_back(std::ldexp(1.0f, -k));
  for (int k = 40; k < 149; k += 18) x.push_back(std::ldexp(1.0f, -k));
  for (int k = 3; k <= 24; ++k) x.push_back(1 - std::ldexp(1.0f, -k));
  return x;
}

std::string text(const glm::vec2& u) {
  std::ostringstream out;
  out.precision(9);
  out << "(u, v) = (" << u.x << ", " << u.y << ')';
  return out.str();
}

bool good(const BsdfSample& s, Domain domain) {
  const double length2 = static_cast<double>(s.wo.x) * s.wo.x + static_cast<double>(s.wo.y) * s.wo.y +
                         static_cast<double>(s.wo.z) * s.wo.z;
  const float least = std::min({s.weight.x, s.weight.y, s.weight.z});
  return std::abs(length2 - 1) < 1e-5 && (s.wo.z > 0 || domain == Domain::sphere) && s.pdf > 0 &&
         std::isfinite(s.pdf) && least >= 0 && std::isfinite(s.weight.x + s.weight.y + s.weight.z);
}

}  // namespace

EdgeScan scan_edges(const Subject& subject, double theta_i, const EdgeOptions& options) {
  const glm::vec3 wi = incident(theta_i);
  Random random(options.seed);
  double interior = 0;
  for (int i = 0; i < options.interior; ++i)
    for (int j = 0; j < options.interior; ++j) {
      const glm::vec2 u = (glm::vec2(static_cast<float>(i), static_cast<float>(j)) + random.pair()) /
                          static_cast<float>(options.interior);
      if (const auto s = subject.sample(wi, glm::clamp(u, margin, 1 - margin)))
        interior = std::max<double>(interior, luminance(s->weight));
    }

  EdgeScan scan;
  const auto look = [&](const glm::vec2& u) {
    ++scan.draws;
    const auto s = subject.sample(wi, u);
    if (!s) {
      ++scan.empty;
    } else if (!good(*s, options.domain)) {
      ++scan.bad, scan.where_bad = text(u);
    } else {
      const double weight = luminance(s->weight);
      const double times = weight > 0 ? weight / interior : 0;
      if (times > scan.largest_weight) scan.largest_weight = times, scan.where_weight = text(u);
      const double pdf = subject.pdf(wi, s->wo);
      const double factor = std::max(pdf / s->pdf, s->pdf / pdf);
      if (!(factor <= scan.pdf_factor)) scan.pdf_factor = factor, scan.where_pdf = text(u);
    }
  };
  const std::vector<float> edge = edge_numbers();
  for (const float x : edge) {
    for (const float y : edge) look({x, y});
    for (int k = 0; k < options.along; ++k) {
      const float y = (static_cast<float>(k) + random()) / static_cast<float>(options.along);
      look({x, y}), look({y, x});
    }
  }
  return scan;
}

DirectionScan scan_directions(const Subject& subject, double theta_i, int side) {
  const glm::vec3 wi = incident(theta_i);
  DirectionScan scan;
  double largest = 0, lost = 0, all = 0;
  const auto look = [&](float r2, float turn, double area) {
    const glm::vec3 wo = polar_to_direction(Polar<float>{std::sqrt(r2), 2 * pi<float> * (turn - 0.5f)});
    if (!(wo.z > 0)) return;
    const double reflected = luminance(subject.f_r(wi, wo)) * wo.z;
    if (!(reflected > 0)) return;
    all += reflected * area;
    const double pdf = subject.pdf(wi, wo);
    if (!(pdf > 0)) {
      lost += reflected * area;
    } else if (reflected / pdf > largest) {
      largest = reflected / pdf;
      std::ostringstream out;
      out << "wo = (" << wo.x << ", " << wo.y << ", " << wo.z << ')';
      scan.where = out.str();
    }
  };
  const double cell = 2 * pi<double> / (static_cast<double>(side) * side);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      look((static_cast<float>(j) + 0.5f) / static_cast<float>(side),
           (static_cast<float>(i) + 0.5f) / static_cast<float>(side), cell);
  for (int k = 0; k < side; ++k) {
    const float z = std::exp2(-6 - 17 * static_cast<float>(k) / static_cast<float>(side));
    for (int i = 0; i < side; i += 8) look(1 - z, (static_cast<float>(i) + 0.5f) / static_cast<float>(side), 0);
  }
  scan.largest_weight = all > 0 ? largest / all : 0;
  scan.without_pdf = all > 0 ? lost / all : 0;
  return scan;
}

}  // namespace gonio::proof
