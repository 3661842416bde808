#include <cmath>
#include <limits>
#include <random>

#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

// std::normal_distribution differs between standard libraries; Box-Muller on raw words does not.
class Noise {
 public:
  explicit Noise(const SynthOptions& options) : sigma_(options.noise_sigma), engine_(options.seed) {}

  double operator()() {
    if (sigma_ == 0) return 1;
    const double u = 1 - uniform(), v = uniform();
    const double normal = std::sqrt(-2 * std::log(u)) * std::cos(2 * pi<double> * v);
    return std::fmax(0.0, 1 + sigma_ * normal);
  }

 private:
  double uniform() { return static_cast<double>(engine_()) / 4294967296.0; }

  double sigma_;
  std::mt19937 engine_;
};

// Both directions must be higher than this to count as measured.
double lowest_cosine(const SynthOptions& options) {
  return std::fmax(0.0, std::cos(std::fmin(options.measured_to, pi<double> / 2)));
}

}  // namespace

MerlFile synthesize_merl(const LobeModel& model, const SynthOptions& options) {
  MerlFile file;
  const std::size_t plane = file.cells();
  file.values.assign(3 * plane, -1.0);
  const double lowest = lowest_cosine(options);
  Noise noise(options);
  std::size_t cell = 0;
  for (int h = 0; h < file.n_theta_h; ++h) {
    const double u = (h + 0.5) / file.n_theta_h, theta_h = u * u * pi<double> / 2;
    const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
    for (int d = 0; d < file.n_theta_d; ++d) {
      const double theta_d = (d + 0.5) / file.n_theta_d * pi<double> / 2;
      for (int p = 0; p < file.n_phi_d; ++p, ++cell) {
        const double phi_d = (p + 0.5) / file.n_phi_d * pi<double>;
        // Rusinkiewicz 1998: the difference vector, turned by theta_h about y.
        const glm::dvec3 diff(std::sin(theta_d) * std::cos(phi_d), std::sin(theta_d) * std::sin(phi_d),
                              std::cos(theta_d));
        const glm::dvec3 wi(cos_h * diff.x + sin_h * diff.z, diff.y, cos_h * diff.z - sin_h * diff.x);
        const glm::dvec3 wo = reflect_about(wi, glm::dvec3(sin_h, 0, cos_h));
        if (!(wi.z > lowest && wo.z > lowest)) continue;
        const glm::dvec3 value = model.eval(wi, wo);
        for (int c = 0; c < 3; ++c) file.values[c * plane + cell] = value[c] * noise() / merl_scale[c];
      }
    }
  }
  return file;
}

MbsdfFile synthesize_mbsdf(const LobeModel& model, int n_theta, int n_phi, const SynthOptions& options) {
  if (n_theta < 2 || n_phi < 2) {
    throw Error("synthetic grid: size is " + std::to_string(n_theta) + " x " + std::to_string(n_theta) + " x " +
                std::to_string(n_phi) + "; expected at least 2 in each direction");
  }
  MbsdfFile file;
  file.n_theta_in = file.n_theta_out = n_theta;
  file.n_phi = n_phi;
  file.values.reserve(std::size_t{3} * n_theta * n_theta * n_phi);
  const double lowest = lowest_cosine(options);
  Noise noise(options);
  for (int i = 0; i < n_theta; ++i) {
    const double theta_i = (i + 0.5) / n_theta * pi<double> / 2;
    const glm::dvec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    for (int o = 0; o < n_theta; ++o) {
      const double theta_o = (o + 0.5) / n_theta * pi<double> / 2;
      for (int p = 0; p < n_phi; ++p) {
        const double phi = (p + 0.5) / n_phi * pi<double>;
        const glm::dvec3 wo(std::sin(theta_o) * std::cos(phi), std::sin(theta_o) * std::sin(phi), std::cos(theta_o));
        const bool measured = wi.z > lowest && wo.z > lowest;
        const glm::dvec3 value = model.eval(wi, wo);
        for (int c = 0; c < 3; ++c) {
          file.values.push_back(measured ? static_cast<float>(value[c] * noise())
                                         : std::numeric_limits<float>::quiet_NaN());
        }
      }
    }
  }
  return file;
}

}  // namespace gonio
