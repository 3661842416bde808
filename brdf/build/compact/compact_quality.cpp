#include <algorithm>
#include <cmath>
#include <random>

#include <gonio/brdf/build/compact/compact_quality.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

/// Every 2.5 degrees, and those of the reports, which are round.
std::vector<double> angles_looked_at() {
  std::vector<double> angles{2 * degree, 10 * degree, 30 * degree, 50 * degree, 70 * degree, 80 * degree};
  for (double theta = 0.5; theta < 80; theta += 2.5) angles.push_back(theta * degree);
  std::sort(angles.begin(), angles.end());
  return angles;
}

}  // namespace

double incidence_weight(const Incidence& incidence, double theta_i) {
  if (incidence.empty()) return 1;
  double sum = 0;
  for (const double share : incidence) sum += share;
  if (!(sum > 0)) return 1;
  const double bins = static_cast<double>(incidence.size());
  const double bin = std::clamp(std::floor(theta_i / (pi<double> / 2) * bins), 0.0, bins - 1);
  return std::max(0.02, incidence[static_cast<std::size_t>(bin)] * bins / sum);
}

CompactDraws::CompactDraws(const BrdfTable& table, const DirectionMap& map, const Incidence& incidence) {
  constexpr int side = 64;
  for (const double theta_i : angles_looked_at())
    angles_.push_back({theta_i, incidence_weight(incidence, theta_i), 0, {}});
  parallel_for(angles_.size(), [&](std::size_t k) {
    Angle& angle = angles_[k];
    const float theta_i = static_cast<float>(angle.theta_i);
    const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    std::mt19937 random(1);
    const auto jittered = [&](int i) {
      return (static_cast<float>(i) + static_cast<float>(random() >> 8) * 0x1p-24f) / side;
    };
    double sum = 0, sum2 = 0;
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const SquarePoint<float> at{jittered(i), jittered(j)};
        const auto s = map(theta_i, at.u, at.v);
        const glm::vec3 weight = s.pdf > 0 && s.wo.z > 0 ? table.eval(wi, s.wo) * (s.wo.z / s.pdf) : glm::vec3(0);
        angle.draws.push_back({at, glm::vec3(s.wo), s.pdf, weight});
        const double w = static_cast<double>(luminance(weight));
        sum += w;
        sum2 += w * w;
      }
    }
    angle.relvar = sum > 0 ? std::max(0.0, sum2 * side * side / (sum * sum) - 1) : 0;
  });
}

CompactQuality CompactDraws::quality(const Colour& colour) const {
  return quality([&](float theta_i, const CompactDraw& d) { return colour.eval(theta_i, d.at); });
}

CompactQuality CompactDraws::quality(const std::function<glm::vec3(float, const CompactDraw&)>& weight) const {
  CompactQuality q;
  double incidence = 0, difference = 0, all = 0;
  std::vector<double> differences(angles_.size()), alls(angles_.size()), albedo_errors(angles_.size());
  parallel_for(angles_.size(), [&](std::size_t k) {
    const Angle& angle = angles_[k];
    glm::dvec3 table(0), compact(0);
    double off = 0;
    for (const CompactDraw& d : angle.draws) {
      const glm::vec3 w = weight(static_cast<float>(angle.theta_i), d);
      if (std::isnan(w.r + w.g + w.b)) continue;
      table += glm::dvec3(d.weight);
      compact += glm::dvec3(w);
      for (int c = 0; c < 3; ++c) off += static_cast<double>(std::abs(w[c] - d.weight[c]));
    }
    const double solid_angle = std::sin(angle.theta_i) * std::cos(angle.theta_i);
    differences[k] = off * solid_angle;
    alls[k] = (table.x + table.y + table.z) * solid_angle;
    const double largest = std::max({table.x, table.y, table.z});
    for (int c = 0; c < 3; ++c)
      if (largest > 0) albedo_errors[k] = std::max(albedo_errors[k], std::abs(compact[c] - table[c]) / largest);
  });
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    q.worst_relvar = std::max(q.worst_relvar, angles_[k].relvar);
    q.mean_relvar += angles_[k].incidence * angles_[k].relvar;
    incidence += angles_[k].incidence;
    difference += differences[k];
    all += alls[k];
    q.albedo_error = std::max(q.albedo_error, albedo_errors[k]);
  }
  q.mean_relvar /= incidence;
  q.eval_error = all > 0 ? difference / all : 0;
  return q;
}

std::vector<double> CompactDraws::worst_angles(double limit, std::size_t count) const {
  std::vector<const Angle*> over;
  for (const Angle& a : angles_)
    if (a.relvar > limit) over.push_back(&a);
  std::stable_sort(over.begin(), over.end(), [](const Angle* a, const Angle* b) { return a->relvar > b->relvar; });
  std::vector<double> found;
  for (const Angle* a : over) {
    const bool apart =
        std::all_of(found.begin(), found.end(), [a](double f) { return std::abs(f - a->theta_i) > 3 * degree; });
    if (apart && found.size() < count) found.push_back(a->theta_i);
  }
  return found;
}

}  // namespace gonio
