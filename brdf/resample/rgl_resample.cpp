#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/brdf/resample/rgl_resample.h>
#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {
namespace {

constexpr int radial_nodes = 256;      // of ndf and sigma
constexpr double ndf_floor = 0.01;     // share of a Lambertian's normals
constexpr double cosine_floor = 1e-3;  // share of a cosine lobe in both densities
constexpr double last_incident = 89 * pi<double> / 180;
constexpr std::size_t first_incident = 24;  // every four degrees and the last
constexpr double least_interval = 0.1 * pi<double> / 180;
constexpr double mass_tolerance = 0.0005;  // of the pdf below the horizon, between incident angles
constexpr int samples_per_cell = 3;        // along each side

// A normal of the file's chart, u_theta = sqrt(2 theta / pi), u_phi = (phi + pi) / (2 pi), and what
// it reflects.
struct Reflection {
  Reflection(const glm::dvec3& wi, double u_theta, double u_phi) {
    const double theta = pi<double> / 2 * u_theta * u_theta, phi = (2 * u_phi - 1) * pi<double>;
    const glm::dvec3 m(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    cosine = glm::dot(wi, m);
    wo = 2.0 * cosine * m - wi;
    jacobian = 4 * cosine * 2 * pi<double> * pi<double> * u_theta * std::sin(theta);
  }
  bool above() const { return cosine > 0 && wo.z > 0; }

  glm::dvec3 wo;
  double cosine;    // wi . m
  double jacobian;  // solid angle of wo per unit area of the chart
};

double lerp_row(const RglFile::Grid& grid, double x) {
  const double at = std::clamp(x, 0.0, 1.0) * (grid.width - 1);
  const auto i = static_cast<std::size_t>(std::min(static_cast<int>(at), grid.width - 2));
  const double t = at - static_cast<double>(i);
  return (1 - t) * grid.values[i] + t * grid.values[i + 1];
}

glm::vec3 incident(double theta) { return glm::vec3(glm::dvec3(std::sin(theta), 0.0, std::cos(theta))); }

// One incident angle of the file.
struct Slice {
  double theta_i;
  std::vector<float> vndf, luminance;
  std::vector<glm::vec3> colour;
};

class Resampler {
 public:
  Resampler(const Reflectance& f_r, std::string description, const RglSize& size) : f_r_(f_r), size_(size) {
    head_.description = std::move(description);
    const RadialNdf ndf = microfacets();
    head_.ndf = head_.sigma = {1, 2, radial_nodes, {}};
    for (int row = 0; row < 2; ++row) {
      for (int k = 0; k < radial_nodes; ++k) {
        const double u = k / (radial_nodes - 1.0);
        head_.ndf.values.push_back(static_cast<float>(ndf.eval(pi<double> / 2 * u * u)));
        head_.sigma.values.push_back(static_cast<float>(ndf.sigma(pi<double> / 2 * u * u)));
      }
    }
  }

  Slice slice(double theta_i) const {
    Slice slice{theta_i, vndf(theta_i), {}, {}};
    const Warp2d warp(1, size_.vndf, size_.vndf, slice.vndf);
    fill(slice, warp);
    return slice;
  }

  RglFile join(const std::vector<const Slice*>& slices) const {
    RglFile file = head_;
    const int n = static_cast<int>(slices.size());
    file.vndf = {n, size_.vndf, size_.vndf, {}};
    file.luminance = {n, size_.side, size_.side, {}};
    file.colour_height = file.colour_width = size_.side;
    for (const Slice* slice : slices) {
      file.theta_i.push_back(static_cast<float>(slice->theta_i));
      const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
      append(file.vndf.values, slice->vndf);
      append(file.luminance.values, slice->luminance);
      append(file.colour, slice->colour);
    }
    return file;
  }

  struct Error {
    double value;  // relative L1 of f_r cos(theta_o)
    double mass;   // of the pdf, that is below the horizon
  };

  // What a file of these slices misses at an incident angle, by half vectors crowded at the pole.
  Error error(const std::vector<const Slice*>& slices, double theta_i) const {
    const RglTable table(join(slices), {});
    const glm::vec3 wi = incident(theta_i);
    constexpr int n = 96;
    double error = 0, sum = 0;
    int lost = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto at = [](int k) { return (static_cast<float>(k) + 0.5f) / n; };
        if (!table.sample(wi, at(i), at(j))) ++lost;
        const Reflection r(glm::dvec3(wi), (i + 0.5) / n, (j + 0.5) / n);
        if (!r.above()) continue;
        const glm::vec3 wo(r.wo), expected = f_r_(wi, wo) * wo.z;
        const glm::vec3 difference = glm::abs(table.eval_cosine(wi, wo) - expected);
        error += r.jacobian * (difference.r + difference.g + difference.b);
        sum += r.jacobian * (expected.r + expected.g + expected.b);
      }
    }
    return {sum > 0 ? error / sum : 0.0, static_cast<double>(lost) / (n * n)};
  }

 private:
  RadialNdf microfacets() const {
    const auto retro = [&](double theta) {
      const glm::vec3 k = incident(theta);
      return static_cast<double>(luminance(f_r_(k, k)));
    };
    double largest = 0;
    for (int degrees = 0; degrees < 89; ++degrees) largest = std::max(largest, retro(degrees * pi<double> / 180));
    // Without retro-reflection the choice is free.
    if (!(largest > 0)) return RadialNdf(radial_nodes, [](double) { return 1 / pi<double>; });
    const RadialNdf found = extract_ndf(retro, Masking::full, radial_nodes).ndf;
    return RadialNdf(radial_nodes,
                     [&](double theta) { return (1 - ndf_floor) * found.eval(theta) + ndf_floor / pi<double>; });
  }

  glm::dvec3 transfer(const glm::vec3& wi, const glm::dvec3& wo) const {
    return glm::dvec3(f_r_(wi, glm::vec3(wo))) * wo.z;
  }

  std::vector<float> vndf(double theta_i) const {
    const glm::vec3 wi = incident(theta_i);
    const int n = size_.vndf;
    std::vector<double> density, cosine;
    double sum = 0, cosine_sum = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Reflection r(glm::dvec3(wi), i / (n - 1.0), j / (n - 1.0));
        const double g = r.above() ? luminance(glm::vec3(transfer(wi, r.wo))) : 0.0;
        density.push_back(r.above() ? std::cbrt(g * r.jacobian) : 0.0);
        cosine.push_back(r.above() ? r.wo.z * r.jacobian : 0.0);
        // The trapezoid rule is the integral of the bilinear density.
        const double area = (i % (n - 1) == 0 ? 0.5 : 1.0) * (j % (n - 1) == 0 ? 0.5 : 1.0);
        sum += area * density.back();
        cosine_sum += area * cosine.back();
      }
    }
    const double share = sum > 0 ? cosine_floor : 1.0, cells = (n - 1.0) * (n - 1.0);
    std::vector<float> values;
    for (std::size_t i = 0; i < density.size(); ++i) {
      const double part = sum > 0 ? (1 - share) * density[i] / sum : 0.0;
      values.push_back(static_cast<float>(cells * (part + share * cosine[i] / cosine_sum)));
    }
    return values;
  }

  // Luminance and colours on the nodes of the unit square that `warp` maps to normals.
  void fill(Slice& slice, const Warp2d& warp) const {
    const glm::vec3 wi = incident(slice.theta_i);
    const int side = size_.side;
    const double area = 4 * lerp_row(head_.sigma, std::sqrt(slice.theta_i * 2 / pi<double>));
    const auto place = [&](double x, double y) {
      constexpr float below_1 = 0.99999994f;
      return warp.sample({0, 0, 0.0f}, std::min(static_cast<float>(x), below_1),
                         std::min(static_cast<float>(y), below_1));
    };
    const auto colour_of = [&](const Reflection& r, double u_theta) {
      // Nodes that reflect below the horizon serve the interpolation above it.
      const glm::dvec3 wo(r.wo.x, r.wo.y, std::max(r.wo.z, 2.0 * RglTable::min_cosine));
      return transfer(wi, glm::normalize(wo)) * (area / lerp_row(head_.ndf, u_theta));
    };
    std::vector<glm::dvec3> colour;
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const Warp2d::Point p = place(i / (side - 1.0), j / (side - 1.0));
        colour.push_back(colour_of({glm::dvec3(wi), p.x, p.y}, p.x));
      }
    }

    // Linear interpolation between samples overshoots on the mean where a function bends: every node
    // takes up the mean difference over its surroundings, twice.
    struct Sample {
      std::size_t cell;
      double x, y, weight;
      glm::dvec3 colour;
    };
    const int n = samples_per_cell * (side - 1);
    std::vector<Sample> samples;
    std::vector<double> density(colour.size()), hats(colour.size());
    const auto spread = [side](const Sample& s, const auto& add) {
      const auto row = static_cast<std::size_t>(side);
      add(s.cell, (1 - s.x) * (1 - s.y));
      add(s.cell + 1, s.x * (1 - s.y));
      add(s.cell + row, (1 - s.x) * s.y);
      add(s.cell + row + 1, s.x * s.y);
    };
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Warp2d::Point p = place((i + 0.5) / n, (j + 0.5) / n);
        const Reflection r(glm::dvec3(wi), p.x, p.y);
        const bool above = r.above() && p.density > 0;
        const auto at = [](int k) { return (k % samples_per_cell + 0.5) / samples_per_cell; };
        Sample s{static_cast<std::size_t>(j / samples_per_cell) * static_cast<std::size_t>(side) +
                     static_cast<std::size_t>(i / samples_per_cell),
                 at(i),
                 at(j),
                 0.0,
                 {}};
        double wanted = 0;
        if (above) {
          s.colour = colour_of(r, p.x);
          s.weight = lerp_row(head_.ndf, p.x) * r.jacobian / p.density;
          wanted = (luminance(glm::vec3(transfer(wi, r.wo))) + 1e-30) * r.jacobian / p.density;
        }
        spread(s, [&](std::size_t node, double hat) {
          density[node] += hat * wanted;
          hats[node] += hat;
        });
        samples.push_back(s);
      }
    }
    for (int pass = 0; pass < 2; ++pass) {
      std::vector<glm::dvec3> differences(colour.size(), glm::dvec3(0.0));
      std::vector<double> weights(colour.size());
      for (const Sample& s : samples) {
        glm::dvec3 value(0.0);
        spread(s, [&](std::size_t node, double hat) { value += hat * colour[node]; });
        spread(s, [&](std::size_t node, double hat) {
          differences[node] += hat * s.weight * (s.colour - value);
          weights[node] += hat * s.weight;
        });
      }
      for (std::size_t k = 0; k < colour.size(); ++k) {
        if (weights[k] > 0) colour[k] = glm::max(colour[k] + differences[k] / weights[k], 0.0);
      }
    }
    for (const glm::dvec3& c : colour) slice.colour.emplace_back(c);

    double sum = 0;
    for (std::size_t k = 0; k < density.size(); ++k) sum += density[k];
    const double cells = (side - 1.0) * (side - 1.0) * samples_per_cell * samples_per_cell;
    for (std::size_t k = 0; k < density.size(); ++k) {
      // The hats of a node sum to the area that it stands for, so that the integral is 1.
      slice.luminance.push_back(static_cast<float>(density[k] / hats[k] * cells / sum));
    }
  }

  const Reflectance& f_r_;
  RglSize size_;
  RglFile head_;  // description, ndf and sigma
};

}  // namespace

RglFile resample_as_rgl(const Reflectance& f_r, std::string description, const RglSize& size,
                        const Progress& progress) {
  if (size.side < 2 || size.vndf < 4 || size.incident < first_incident) {
    throw Error("RGL file: found " + std::to_string(size.side) + " nodes of luminance, " + std::to_string(size.vndf) +
                " of vndf, " + std::to_string(size.incident) + " incident angles, expected at least 2, 4 and 24");
  }
  const Resampler resampler(f_r, std::move(description), size);
  std::vector<std::unique_ptr<Slice>> slices(first_incident);
  parallel_for(slices.size(), [&](std::size_t k) {
    slices[k] =
        std::make_unique<Slice>(resampler.slice(std::min(static_cast<double>(k) * pi<double> / 45, last_incident)));
  });
  // Halves the intervals whose middle gains most from a slice of its own, half of the best gain and
  // above at a time. What did not gain enough is not asked again.
  struct Middle {
    double left;
    std::unique_ptr<Slice> slice;
    double gain;  // over what is tolerated
  };
  std::vector<Middle> middles;
  for (std::size_t k = 0; k + 1 < slices.size(); ++k) middles.push_back({slices[k]->theta_i, {}, 0});
  while (slices.size() < size.incident) {
    if (progress) progress(std::min(1.0, static_cast<double>(slices.size()) / static_cast<double>(size.incident)));
    parallel_for(middles.size(), [&](std::size_t k) {
      Middle& middle = middles[k];
      if (middle.slice) return;
      const auto lower =
          std::find_if(slices.begin(), slices.end(), [&](const auto& slice) { return slice->theta_i == middle.left; });
      const Slice &a = **lower, &b = **(lower + 1);
      const double theta_i = (a.theta_i + b.theta_i) / 2;
      middle.slice = std::make_unique<Slice>(resampler.slice(theta_i));
      const auto own = resampler.error({middle.slice.get()}, theta_i);
      // Tables that are linear between angles of their own may be met by chance at one point.
      for (const double t : {0.25, 0.5, 0.75}) {
        const auto between = resampler.error({&a, &b}, (1 - t) * a.theta_i + t * b.theta_i);
        middle.gain = std::max({middle.gain, std::cos(theta_i) * (between.value - own.value) / size.tolerance,
                                (between.mass - own.mass) / mass_tolerance});
      }
    });
    std::sort(middles.begin(), middles.end(), [](const Middle& a, const Middle& b) { return a.gain > b.gain; });
    const double enough = std::max(middles.front().gain / 2, 1.0);
    std::vector<Middle> next;
    for (Middle& middle : middles) {
      const bool apart = middle.slice->theta_i - middle.left > least_interval;
      if (middle.gain > enough && apart && slices.size() < size.incident) {
        next.push_back({middle.left, {}, 0});
        next.push_back({middle.slice->theta_i, {}, 0});
        slices.push_back(std::move(middle.slice));
      } else if (middle.gain > 1 && apart) {
        next.push_back(std::move(middle));
      }
    }
    if (next.empty()) break;
    middles = std::move(next);
    std::sort(slices.begin(), slices.end(), [](const auto& a, const auto& b) { return a->theta_i < b->theta_i; });
  }
  std::vector<const Slice*> all;
  all.reserve(slices.size());
  for (const auto& slice : slices) all.push_back(slice.get());
  return resampler.join(all);
}

}  // namespace gonio
