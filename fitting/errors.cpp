#include <gonio/brdf/parallel.h>
#include <gonio/fitting/delta_e.h>
#include <gonio/fitting/errors.h>
#include <gonio/fitting/half_vectors.h>

#include <cmath>
#include <glm/common.hpp>

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
  glm::dvec3 albedo_difference{0};
};

Row integrate_row(const BrdfFunction& table, const BrdfFunction& model, double theta_i,
                  double cutoff) {
  constexpr double log_offset = 1e-3;
  const double lowest = std::cos(cutoff);
  const glm::dvec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
  Row row;
  detail::for_half_vectors(wi, 0, [&](const glm::dvec3& wo, double d_wo) {
    const double d_wi = std::sin(theta_i);
    const glm::dvec3 a = glm::dvec3(table(glm::vec3(wi), glm::vec3(wo))) * wo.z;
    const glm::dvec3 b = glm::dvec3(model(glm::vec3(wi), glm::vec3(wo))) * wo.z;
    Sums& sums = wi.z >= lowest && wo.z >= lowest ? row.inside : row.beyond;
    for (int c = 0; c < 3; ++c) {
      const double logarithm = std::log((b[c] + log_offset) / (a[c] + log_offset));
      sums.measure += d_wo * d_wi;
      sums.square += (b[c] - a[c]) * (b[c] - a[c]) * d_wo * d_wi;
      sums.log_square += logarithm * logarithm * d_wo * d_wi;
      sums.difference += std::fabs(b[c] - a[c]) * wi.z * d_wo * d_wi;
      sums.table += a[c] * wi.z * d_wo * d_wi;
      row.albedo_difference[c] += (b[c] - a[c]) * d_wo;
    }
  });
  return row;
}

void store(const Sums& sums, FitErrors& errors) {
  if (!(sums.measure > 0)) return;
  errors.cosine_rms = std::sqrt(sums.square / sums.measure);
  errors.log_rms = std::sqrt(sums.log_square / sums.measure);
  errors.relative_l1 = sums.table > 0 ? sums.difference / sums.table : 0;
}

// The sphere is seen from +z; a pixel's normal is its place on the sphere.
void sphere(const BrdfFunction& table, const BrdfFunction& model, double cutoff,
            FitErrorReport& report) {
  constexpr int size = 64;
  const double lowest = std::cos(cutoff);
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (double angle : {10.0, 50.0, 90.0}) {
    const glm::dvec3 light(std::sin(angle * pi<double> / 180), 0,
                           std::cos(angle * pi<double> / 180));
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
        const glm::dvec3 t = glm::normalize(glm::cross(glm::dvec3(0.3, 1, 0.2), n)),
                         b = glm::cross(n, t);
        const auto local = [&](const glm::dvec3& w) {
          return glm::vec3(glm::dvec3(glm::dot(w, t), glm::dot(w, b), glm::dot(w, n)));
        };
        const glm::vec3 wi = local(light), wo = local(view);
        if (!(wi.z > 0 && wo.z > 0)) continue;
        const auto pixel = [&](const BrdfFunction& f) {
          return lab_from_rgb(
              glm::min(glm::dvec3(f(wi, wo)) * (pi<double> * cos_light), glm::dvec3(1)));
        };
        const int region = wi.z >= lowest && wo.z >= lowest ? 0 : 1;
        sum[region] += delta_e_2000(pixel(table), pixel(model));
        ++count[region];
      }
    }
  }
  if (count[0] > 0) report.inside.delta_e = sum[0] / count[0];
  if (count[1] > 0) report.beyond.delta_e = sum[1] / count[1];
}

}  // namespace

FitErrorReport fit_errors(const BrdfFunction& table, const BrdfFunction& model, double cutoff) {
  constexpr int rows = 30;
  const auto angle = [](size_t i) {
    return (static_cast<double>(i) + 0.5) / rows * pi<double> / 2;
  };
  std::vector<Row> results(rows);
  parallel_for(rows, [&](size_t i) { results[i] = integrate_row(table, model, angle(i), cutoff); });
  FitErrorReport report;
  Sums inside, beyond;
  for (size_t i = 0; i < rows; ++i) {
    inside += results[i].inside;
    beyond += results[i].beyond;
    double& worst = angle(i) <= cutoff ? report.inside.albedo : report.beyond.albedo;
    for (int c = 0; c < 3; ++c)
      worst = std::fmax(worst, std::fabs(results[i].albedo_difference[c]));
  }
  store(inside, report.inside);
  store(beyond, report.beyond);
  sphere(table, model, cutoff, report);
  return report;
}

}  // namespace gonio
