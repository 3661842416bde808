#include <algorithm>
#include <cmath>

#include <gonio/brdf/proof/edges.h>
#include <gonio/brdf/proof/incident.h>
#include <gonio/brdf/proof/measure.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/value/frame.h>

namespace gonio::proof {
namespace {

/// invert() of a stack with directions of the surface.
template <class S>
auto inverse_of(const S& stack) {
  return [&stack](const glm::vec3& wi, const glm::vec3& wo) -> std::optional<glm::vec2> {
    const IncidentFrame frame(wi);
    const auto inverse = stack.invert(frame.theta_i, frame.to_diagram(wo));
    if (!inverse) return std::nullopt;
    return glm::vec2(inverse->at.u, inverse->at.v);
  };
}

template <class S>
Subject subject_of_stack(const S& stack) {
  Subject subject;
  subject.sample = [&stack](const glm::vec3& wi, const glm::vec2& u) -> std::optional<BsdfSample> {
    const IncidentFrame frame(wi);
    const auto s = stack.sample(frame.theta_i, u.x, u.y);
    if (!(s.pdf > 0)) return std::nullopt;
    return BsdfSample{frame.to_surface(s.wo), s.pdf, glm::vec3(1)};
  };
  subject.pdf = [&stack](const glm::vec3& wi, const glm::vec3& wo) {
    const IncidentFrame frame(wi);
    return static_cast<double>(stack.pdf(frame.theta_i, frame.to_diagram(wo)));
  };
  subject.invert = inverse_of(stack);
  return subject;
}

}  // namespace

Subject subject_of(const StackBsdf& bsdf) {
  Subject subject = subject_of<StackBsdf>(bsdf);
  subject.direction = [&stack = bsdf.stack()](const glm::vec3& wi, const glm::vec2& u) -> std::optional<glm::vec3> {
    const IncidentFrame frame(wi);
    const auto s = stack.sample(frame.theta_i, u.x, u.y);
    if (!(wi.z > 0 && s.pdf > 0 && s.wo.z > 0)) return std::nullopt;
    return frame.to_surface(s.wo);
  };
  subject.invert = inverse_of(bsdf.stack());
  return subject;
}

Subject subject_of(const Stack<float>& stack) { return subject_of_stack(stack); }

glm::dvec3 albedo(const Subject& subject, double theta_i) {
  const glm::vec3 wi = incident(theta_i);
  const auto value = [&](const glm::vec3& wo) { return subject.f_r(wi, wo) * wo.z; };
  return Bins::adapted([&](const glm::vec3& wo) { return static_cast<double>(luminance(value(wo))); })
      .integrate_rgb(value);
}

Quality measure(const Subject& subject, double theta_i, const MeasureOptions& options) {
  const glm::vec3 wi = incident(theta_i);
  Quality q{};
  q.theta_i = theta_i;

  Random random(options.seed);
  double sum = 0, sum2 = 0, largest = 0;
  std::uint64_t empty = 0;
  const float side = static_cast<float>(options.grid);
  for (int i = 0; i < options.grid; ++i) {
    for (int j = 0; j < options.grid; ++j) {
      const glm::vec2 jitter = random.pair();
      const auto s =
          subject.sample(wi, {(static_cast<float>(i) + jitter.x) / side, (static_cast<float>(j) + jitter.y) / side});
      if (!s) {
        ++empty;
        continue;
      }
      const double w = luminance(s->weight);
      sum += w;
      sum2 += w * w;
      largest = std::max(largest, w);
      q.albedo += glm::dvec3(s->weight);
    }
  }
  const double count = static_cast<double>(options.grid) * options.grid;
  q.albedo /= count;
  q.invalid_fraction = static_cast<double>(empty) / count;
  if (sum > 0) {
    q.relvar = std::max(0.0, sum2 * count / (sum * sum) - 1);
    q.max_weight = largest * count / sum;
  }

  const auto value = [&](const glm::vec3& wo) { return subject.f_r(wi, wo) * wo.z; };
  const Density pdf = [&](const glm::vec3& wo) { return subject.pdf(wi, wo); };
  const double mean = sum > 0 ? sum / count : 1;
  const Bins bins = Bins::adapted([&](const glm::vec3& wo) { return pdf(wo) + luminance(value(wo)) / mean; });
  q.albedo_table = options.albedo_table ? *options.albedo_table : bins.integrate_rgb(value);
  q.chi2 = chi_square(
      [&](std::uint64_t) -> std::optional<glm::vec3> {
        const glm::vec2 u = random.pair();
        if (subject.direction) return subject.direction(wi, u);
        const auto s = subject.sample(wi, u);
        return s ? std::optional(s->wo) : std::nullopt;
      },
      pdf, bins, options.chi2_draws);
  q.pdf_integral = q.chi2.pdf_integral;
  q.max_direction_weight = scan_directions(subject, theta_i, 128).largest_weight;
  return q;
}

}  // namespace gonio::proof
