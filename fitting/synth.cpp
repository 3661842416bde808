#include <gonio/fitting/synth.h>
#include <gonio/mapping/error.h>

#include <cmath>
#include <fstream>
#include <random>

namespace gonio {
namespace {

// std::normal_distribution differs between standard libraries; Box-Muller on raw words does not.
class Noise {
 public:
  explicit Noise(const SynthOptions& options)
      : sigma_(options.noise_sigma), engine_(options.seed) {}

  double operator()() {
    if (sigma_ == 0) return 1;
    const double u = 1 - uniform(), v = uniform();
    const double normal = std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi<double> * v);
    return std::fmax(0.0, 1 + sigma_ * normal);
  }

 private:
  double uniform() { return engine_() / 4294967296.0; }

  double sigma_;
  std::mt19937 engine_;
};

}  // namespace

std::vector<double> synthesize_merl(const LobeModel& model, const SynthOptions& options) {
  constexpr int kThetaH = 90, kThetaD = 90, kPhiD = 180;
  constexpr double kFileUnit[3] = {1 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
  constexpr double kDegree = kPi<double> / 180;
  constexpr std::size_t kPlane = std::size_t{kThetaH} * kThetaD * kPhiD;
  std::vector<double> values(kMerlCells, -1.0);
  const double lowest = std::fmax(0.0, std::cos(std::fmin(options.measured_to, kPi<double> / 2)));
  Noise noise(options);
  for (int h = 0; h < kThetaH; ++h) {
    const double u = (h + 0.5) / kThetaH, theta_h = u * u * kPi<double> / 2;
    const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
    for (int d = 0; d < kThetaD; ++d) {
      const double theta_d = (d + 0.5) * kDegree;
      for (int p = 0; p < kPhiD; ++p) {
        const double phi_d = (p + 0.5) * kDegree;
        // Rusinkiewicz 1998: the difference vector, turned by theta_h about y.
        const glm::dvec3 diff(std::sin(theta_d) * std::cos(phi_d),
                              std::sin(theta_d) * std::sin(phi_d), std::cos(theta_d));
        const glm::dvec3 wi(cos_h * diff.x + sin_h * diff.z, diff.y,
                            cos_h * diff.z - sin_h * diff.x);
        const glm::dvec3 wo = reflect_about(wi, glm::dvec3(sin_h, 0, cos_h));
        if (!(wi.z > lowest && wo.z > lowest)) continue;
        const glm::dvec3 value = model.eval(wi, wo);
        const std::size_t cell = (std::size_t(h) * kThetaD + d) * kPhiD + p;
        for (int c = 0; c < 3; ++c) values[c * kPlane + cell] = value[c] * noise() / kFileUnit[c];
      }
    }
  }
  return values;
}

void save_merl(const std::filesystem::path& path, const LobeModel& model,
               const SynthOptions& options) {
  const std::vector<double> values = synthesize_merl(model, options);
  const std::int32_t dimensions[3] = {90, 90, 180};
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(dimensions), sizeof dimensions);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(double)));
  file.close();
  if (!file) throw Error(path.string() + ": cannot write the table");
}

}  // namespace gonio
