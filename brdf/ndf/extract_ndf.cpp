#include <algorithm>
#include <cmath>
#include <numeric>

#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/brdf/ndf/radial_nodes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using detail::for_each_point;
using detail::over_azimuth;
using detail::theta_of;

constexpr double degree = pi<double> / 180;

/// The power iteration for D at nodes, see extract_ndf(). A solver of eigenvalues would not do: how D goes on beyond
/// the measured angles is not linear in D, and neither is independent masking.
class Extraction {
 public:
  Extraction(const std::function<double(double)>& retro_reflection, int nodes)
      : n_(static_cast<std::size_t>(detail::checked_nodes(nodes))), kernel_(n_ * n_) {
    for (std::size_t i = 0; i < n_; ++i) {
      const double theta = node(i);
      cosine_.push_back(std::cos(theta));
      retro_.push_back(theta <= last_angle ? retro_reflection(theta) : std::nan(""));
      if (!std::isnan(retro_[i])) measured_.push_back(i);
      for_each_point(nodes, [&](int k, double t, double theta_h, double solid_angle) {
        const double value = over_azimuth(theta, theta_h) * solid_angle;
        const std::size_t j = i * n_ + static_cast<std::size_t>(k);
        kernel_[j] += (1 - t) * value;
        kernel_[j + 1] += t * value;
      });
    }
    if (measured_.empty())
      throw Error("retro-reflection: found none that was measured, expected some to extract normals from");
  }

  ExtractedNdf iterate(Masking masking) const {
    std::vector<double> d(n_, 1.0);
    int iterations = 0;
    double change = 1;
    while (iterations < 1000 && change > 1e-12) {
      ++iterations;
      std::vector<double> next = step(d, masking);
      const double largest = *std::max_element(next.begin(), next.end());
      if (!(largest > 0)) throw Error("retro-reflection: found none, expected some to extract normals from");
      change = 0;
      for (std::size_t i = 0; i < n_; ++i) {
        next[i] /= largest;
        change = std::max(change, std::abs(next[i] - d[i]) / std::max(next[i], 1e-12));
      }
      d.swap(next);
    }
    RadialNdf ndf(static_cast<int>(n_), [&](double theta) {
      return d[static_cast<std::size_t>(std::lround(std::sqrt(theta * 2 / pi<double>) * static_cast<double>(n_ - 1)))];
    });
    ndf.normalise();
    return {std::move(ndf), masking, node(measured_.back()), iterations, change};
  }

 private:
  static constexpr double last_angle = 89 * degree;

  double node(std::size_t i) const { return theta_of(static_cast<double>(i) / static_cast<double>(n_ - 1)); }

  double sigma(const std::vector<double>& d, std::size_t i) const {
    return std::inner_product(d.begin(), d.end(), kernel_.begin() + static_cast<std::ptrdiff_t>(i * n_), 0.0);
  }

  std::vector<double> step(const std::vector<double>& d, Masking masking) const {
    const double area = sigma(d, 0);  // of the surface itself: the normal sees all of it
    std::vector<double> next(n_);
    for (const std::size_t i : measured_)
      next[i] = retro_[i] * cosine_[i] * cosine_over_g2(masking, sigma(d, i), area, cosine_[i]);
    for (std::size_t i = 0; i < measured_.front(); ++i) next[i] = next[measured_.front()];
    for (std::size_t m = 0; m + 1 < measured_.size(); ++m) {
      const std::size_t a = measured_[m], b = measured_[m + 1];
      for (std::size_t i = a + 1; i < b; ++i)
        next[i] = next[a] + (next[b] - next[a]) * static_cast<double>(i - a) / static_cast<double>(b - a);
    }
    continue_beyond(next);
    return next;
  }

  /// cos area / G2(k, k), with G1 = cos area / sigma: of the first degree in D.
  static double cosine_over_g2(Masking masking, double sigma, double area, double cosine) {
    switch (masking) {
      case Masking::height_correlated:
        return 2 * sigma - cosine * area;
      case Masking::independent:
        return sigma * sigma / (cosine * area);
      case Masking::full:
        break;
    }
    return sigma;
  }

  /// 1 / sqrt(D) goes on linearly in cos^2, as it does for GGX, with its slope over the outer quarter
  /// of the measured angles; D rises sixteenfold at most.
  void continue_beyond(std::vector<double>& d) const {
    const std::size_t last = measured_.back();
    if (!(d[last] > 0)) return;
    const double x_last = cosine_[last] * cosine_[last], y_last = 1 / std::sqrt(d[last]);
    double xy = 0, xx = 0;
    for (const std::size_t i : measured_) {
      if (node(i) < 0.75 * node(last) || !(d[i] > 0)) continue;
      const double x = cosine_[i] * cosine_[i] - x_last;
      xy += x * (1 / std::sqrt(d[i]) - y_last);
      xx += x * x;
    }
    const double slope = xx > 0 ? xy / xx : 0;
    for (std::size_t i = last + 1; i < n_; ++i) {
      const double y = y_last + slope * (cosine_[i] * cosine_[i] - x_last);
      d[i] = std::pow(std::max(y, y_last / 4), -2);
    }
  }

  std::size_t n_;
  std::vector<double> cosine_, retro_, kernel_;  // kernel: what D at node j adds to sigma at node i
  std::vector<std::size_t> measured_;            // nodes with a known retro-reflection
};

// Of tables no more is used: interpolation between their cells and goniometers are worst beyond.
constexpr double last_table_angle = 75 * degree;
// Retro-reflection is read from pairs so far on either side of k: the first cells of MERL.
constexpr double theta_retro = 0.5 * degree;

/// The mean over the azimuth of the difference vector, as far as the table was measured, of luminance times
/// cos_i cos_o times weight(wi, wo): noise and single cells count less. NaN without a measured pair.
template <class Weight>
double mean_over_phi_d(const BrdfTable& table, double theta_h, double theta_d, const Weight& weight) {
  constexpr int n = 36;
  double sum = 0;
  int count = 0;
  for (int k = 0; k < n; ++k) {
    glm::vec3 wi, wo;
    directions_from_half_difference(theta_h, theta_d, k * 2 * pi<double> / n, wi, wo);
    if (std::min(wi.z, wo.z) < std::cos(last_table_angle + theta_retro) || table.measured(wi, wo) < 0.999f) continue;
    sum += static_cast<double>(luminance(table.eval(wi, wo)) * wi.z * wo.z) * weight(wi, wo);
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

/// f_r(k, k).
double retro_reflection(const BrdfTable& table, double theta) {
  if (theta > last_table_angle) return std::nan("");
  const auto one = [](const glm::vec3&, const glm::vec3&) { return 1.0; };
  return mean_over_phi_d(table, theta, theta_retro, one) / std::pow(std::cos(theta), 2);
}

/// G2(wi, wo). Full masking wears off with the azimuth between them: Heitz 2014, "Understanding the
/// masking-shadowing function", section 5.4, after van Ginneken, Stavridi and Koenderink 1998.
double masking_shadowing(Masking masking, double g1_i, double g1_o, double azimuth) {
  switch (masking) {
    case Masking::height_correlated:
      return 1 / (1 / g1_i + 1 / g1_o - 1);
    case Masking::independent:
      return g1_i * g1_o;
    case Masking::full:
      break;
  }
  const double apart = 4.41 * azimuth / (4.41 * azimuth + 1);
  return apart * g1_i * g1_o + (1 - apart) * std::min(g1_i, g1_o);
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How far D and its masking are from the table between directions that differ, where the
/// retro-reflection that D is from says nothing: the median of |log f_r| over half vectors, apart from a
/// factor, Fresnel's, for each difference angle. 0 if too few can be compared.
double misfit(const BrdfTable& table, const ExtractedNdf& found) {
  constexpr std::size_t least = 5;
  const RadialNdf g1_at_nodes(static_cast<int>(found.ndf.values().size()),
                              [&](double theta) { return found.ndf.g1(theta); });
  const auto unmasked = [&](const glm::vec3& wi, const glm::vec3& wo) {
    const auto g1 = [&](const glm::vec3& w) { return g1_at_nodes.eval(std::acos(static_cast<double>(w.z))); };
    const double azimuth = std::abs(std::remainder(std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x), 2 * pi<double>));
    return 1 / masking_shadowing(found.masking, g1(wi), g1(wo), azimuth);
  };
  std::vector<double> deviations;
  for (const double theta_d : {5.0, 10.0, 20.0, 30.0}) {
    std::vector<double> logarithms;
    for (double theta_h = 2.5; theta_h < 75; theta_h += 2.5) {
      const double ratio =
          mean_over_phi_d(table, theta_h * degree, theta_d * degree, unmasked) / found.ndf.eval(theta_h * degree);
      if (ratio > 0 && std::isfinite(ratio)) logarithms.push_back(std::log(ratio));
    }
    if (logarithms.size() < least) continue;
    const double factor = median(logarithms);
    for (const double x : logarithms) deviations.push_back(std::abs(x - factor));
  }
  return deviations.empty() ? 0 : median(deviations);
}

}  // namespace

const char* to_string(Masking masking) noexcept {
  switch (masking) {
    case Masking::height_correlated:
      return "height-correlated";
    case Masking::independent:
      return "independent";
    case Masking::full:
      break;
  }
  return "full";
}

ExtractedNdf extract_ndf(const std::function<double(double)>& retro_reflection, Masking masking, int nodes) {
  return Extraction(retro_reflection, nodes).iterate(masking);
}

ExtractedNdf extract_ndf(const BrdfTable& table, int nodes) {
  const Extraction extraction([&](double theta) { return retro_reflection(table, theta); }, nodes);
  ExtractedNdf best = extraction.iterate(Masking::full);
  double least = misfit(table, best) / 2;  // surfaces have it: the others must be clearly nearer
  for (const Masking masking : {Masking::height_correlated, Masking::independent}) {
    ExtractedNdf other = extraction.iterate(masking);
    const double found = misfit(table, other);
    if (!(found < least)) continue;
    best = std::move(other);
    least = found;
  }
  return best;
}

}  // namespace gonio
