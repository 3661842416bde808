#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include <gonio/fitting/fit/delta_e.h>
#include <gonio/fitting/fit/errors.h>
#include <gonio/fitting/fit/half_vectors.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {

struct Sums {
  double measure = 0, square = 0, log_square = 0, difference = 0, table = 0;
  Sums& operator+=(const Sums& o) {
    measure += o.measure, square += o.square, log_square += o.log_square;
    difference += o.difference, table += o.table;
    return *this;
  }
};

struct Row {  // of one incident angle
  Sums inside, beyond;
};

bool measured(const glm::dvec3& f) { return !std::isnan(f.r + f.g + f.b); }

Row integrate_row(const BrdfFunction& table, const BrdfFunction& model, double theta_i, double cutoff) {
  constexpr double log_offset = 1e-3;
  const double lowest = std::cos(cutoff);
  const glm::dvec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
  Row row;
  detail::for_half_vectors(wi, 0, [&](const glm::dvec3& wo, double d_wo) {
    const double d_wi = std::sin(theta_i);
    const glm::dvec3 a = glm::dvec3(table(glm::vec3(wi), glm::vec3(wo))) * wo.z;
    if (!measured(a)) return;
    const glm::dvec3 b = glm::dvec3(model(glm::vec3(wi), glm::vec3(wo))) * wo.z;
    Sums& sums = wi.z >= lowest && wo.z >= lowest ? row.inside : row.beyond;
    for (int c = 0; c < 3; ++c) {
      const double logarithm = std::log((b[c] + log_offset) / (a[c] + log_offset));
      sums.measure += d_wo * d_wi;
      sums.square += (b[c] - a[c]) * (b[c] - a[c]) * d_wo * d_wi;
      sums.log_square += logarithm * logarithm * d_wo * d_wi;
      sums.difference += std::fabs(b[c] - a[c]) * wi.z * d_wo * d_wi;
      sums.table += a[c] * wi.z * d_wo * d_wi;
    }
  });
  return row;
}

void store(const Sums& sums, FitErrors& errors) {
  if (!(sums.measure > 0)) return;
  errors.cosine_rms = std::sqrt(sums.square / sums.measure);
  errors.log_rms = std::sqrt(sums.log_square / sums.measure);
  if (sums.table > 0) errors.relative_l1 = sums.difference / sums.table;
}

// The difference of the albedos at one incident angle, the largest over the channels; -1 where nothing
// was measured.
double albedo_difference(const BrdfFunction& table, const BrdfFunction& model, double theta_i) {
  const glm::dvec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
  glm::dvec3 sum(0);
  bool any = false;
  detail::for_half_vectors(wi, 0, [&](const glm::dvec3& wo, double d_wo) {
    const glm::dvec3 a(table(glm::vec3(wi), glm::vec3(wo)));
    if (!measured(a)) return;
    any = true;
    sum += (glm::dvec3(model(glm::vec3(wi), glm::vec3(wo))) - a) * (wo.z * d_wo);
  });
  const glm::dvec3 size = glm::abs(sum);
  return any ? std::max({size.r, size.g, size.b}) : -1;
}

// The largest of them from first to last: the best of equal steps, ends included, then nearer and
// nearer about it.
double largest_albedo_difference(const BrdfFunction& table, const BrdfFunction& model, double first, double last) {
  constexpr int steps = 32, rounds = 3;
  double largest = -1;
  for (int round = 0; round < rounds && first < last; ++round) {
    const double step = (last - first) / steps;
    std::vector<double> found(steps + 1);
    parallel_for(found.size(),
                 [&](size_t i) { found[i] = albedo_difference(table, model, first + static_cast<double>(i) * step); });
    const auto best = std::max_element(found.begin(), found.end());
    largest = std::max(largest, *best);
    const double at = first + static_cast<double>(best - found.begin()) * step;
    first = std::max(first, at - step), last = std::min(last, at + step);
  }
  return largest < 0 ? FitErrors::none : largest;
}

// The sphere is seen from +z; a pixel's normal is its place on the sphere.
void sphere(const BrdfFunction& table, const BrdfFunction& model, double cutoff, FitErrorReport& report) {
  constexpr int size = 64;
  const double lowest = std::cos(cutoff);
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (double angle : {10.0, 50.0, 90.0}) {
    const glm::dvec3 light(std::sin(angle * pi<double> / 180), 0, std::cos(angle * pi<double> / 180));
    const glm::dvec3 view(0, 0, 1);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const double px = (x + 0.5) / size * 2 - 1, py = (y + 0.5) / size * 2 - 1;
        const double rest = 1 - px * px - py * py;
        if (!(rest > 0)) continue;
        const glm::dvec3 n(px, py, std::sqrt(rest));
        const double cos_light = glm::dot(n, light);
        if (!(cos_light > 0)) continue;
        // Any frame about n: both BRDFs are isotropic.
        const glm::dvec3 t = glm::normalize(glm::cross(glm::dvec3(0.3, 1, 0.2), n)), b = glm::cross(n, t);
        const auto local = [&](const glm::dvec3& w) {
          return glm::vec3(glm::dvec3(glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)));
        };
        const glm::vec3 wi = local(light), wo = local(view);
        if (!(wi.z > 0 && wo.z > 0)) continue;
        const glm::dvec3 a(table(wi, wo)), m(model(wi, wo));
        if (!measured(a)) continue;
        const auto pixel = [&](const glm::dvec3& f) {
          return lab_from_rgb(glm::min(f * (pi<double> * cos_light), glm::dvec3(1)));
        };
        const int region = wi.z >= lowest && wo.z >= lowest ? 0 : 1;
        sum[region] += delta_e_2000(pixel(a), pixel(m));
        ++count[region];
      }
    }
  }
  if (count[0] > 0) report.inside.delta_e = sum[0] / count[0];
  if (count[1] > 0) report.beyond.delta_e = sum[1] / count[1];
}

}  // namespace

FitErrorReport fit_errors(const BrdfFunction& table, const BrdfFunction& model, double cutoff) {
  constexpr int rows = 90;
  const auto angle = [](size_t i) { return (static_cast<double>(i) + 0.5) / rows * pi<double> / 2; };
  std::vector<Row> results(rows);
  parallel_for(rows, [&](size_t i) { results[i] = integrate_row(table, model, angle(i), cutoff); });
  FitErrorReport report;
  Sums inside, beyond;
  for (size_t i = 0; i < rows; ++i) {
    inside += results[i].inside;
    beyond += results[i].beyond;
  }
  store(inside, report.inside);
  store(beyond, report.beyond);
  const double middle = std::min(cutoff, last_albedo_angle);
  report.inside.albedo = largest_albedo_difference(table, model, 0, middle);
  report.beyond.albedo = largest_albedo_difference(table, model, middle, last_albedo_angle);
  sphere(table, model, cutoff, report);
  return report;
}

}  // namespace gonio
