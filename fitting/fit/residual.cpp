#include <cmath>

#include <Eigen/Core>

#include <gonio/fitting/fit/residual.h>
#include <gonio/mapping/base/error.h>

namespace gonio::detail {

namespace {
constexpr double cube_root_offset = 1e-4, log_factor = 1000;
}

double compress(Compression compression, double x, double* slope) noexcept {
  switch (compression) {
    case Compression::none:
      if (slope) *slope = 1;
      return x;
    case Compression::cube_root: {
      const double root = std::cbrt(x + cube_root_offset);
      if (slope) *slope = 1 / (3 * root * root);
      return root;
    }
    case Compression::log:
      break;
  }
  if (slope) *slope = log_factor / (1 + log_factor * x);
  return std::log1p(log_factor * x);
}

std::vector<FitSample> fit_samples(const BrdfFunction& f, const FitOptions& options) {
  std::vector<FitSample> samples;
  const double lowest = std::cos(options.grazing_cutoff);
  double total = 0;
  for (int h = 0; h < options.theta_h; ++h) {
    const double s = (h + 0.5) / options.theta_h, theta_h = s * s * pi<double> / 2;
    const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
    for (int d = 0; d < options.theta_d; ++d) {
      const double theta_d = (d + 0.5) / options.theta_d * pi<double> / 2;
      for (int p = 0; p < options.phi_d; ++p) {
        const double phi_d = (p + 0.5) / options.phi_d * pi<double>;
        const glm::dvec3 diff(std::sin(theta_d) * std::cos(phi_d), std::sin(theta_d) * std::sin(phi_d),
                              std::cos(theta_d));
        const glm::dvec3 wi(cos_h * diff.x + sin_h * diff.z, diff.y, cos_h * diff.z - sin_h * diff.x);
        const glm::dvec3 wo = reflect_about(wi, glm::dvec3(sin_h, 0, cos_h));
        if (!(wi.z >= lowest && wo.z >= lowest)) continue;
        const glm::dvec3 value = glm::dvec3(f(glm::vec3(wi), glm::vec3(wo))) * wo.z;
        if (!(value.r >= 0 && value.g >= 0 && value.b >= 0) || !std::isfinite(value.r + value.g + value.b)) {
          continue;
        }
        // dwi dwo = 4 cos_d dwh dwd; d(theta_h) = pi s ds.
        const double area = options.solid_angle_weights ? std::cos(theta_d) * std::sin(theta_d) * sin_h * s : 1.0;
        samples.push_back({Angles<double>(wi, wo), value, area});
        total += area;
      }
    }
  }
  for (FitSample& sample : samples) sample.weight = std::sqrt(sample.weight / total);
  return samples;
}

ParameterLayout::ParameterLayout(const LobeModel& form, bool separate_channels)
    : form_(form), separate_channels_(separate_channels) {
  for (int l = 0; l < static_cast<int>(form.lobes.size()); ++l) {
    const Lobe& lobe = form.lobes[l];
    const std::vector<Parameter>& shape = lobe_info(lobe.kind).shape;
    for (int i = 0; i < static_cast<int>(shape.size()); ++i) {
      const int first = separate_channels ? 0 : -1, last = separate_channels ? 2 : -1;
      for (int c = first; c <= last; ++c) entries_.push_back({l, i, c, false, &shape[i]});
    }
    const std::vector<Parameter>& colors = color_parameters(lobe.kind, lobe.fresnel);
    for (int i = 0; i < static_cast<int>(colors.size()); ++i) {
      for (int c = 0; c < 3; ++c) entries_.push_back({l, i, c, true, &colors[i]});
    }
  }
}

std::vector<double> ParameterLayout::pack(const LobeModel& model) const {
  std::vector<double> x;
  x.reserve(entries_.size());
  for (const Entry& e : entries_) {
    const Lobe& lobe = model.lobes[e.lobe];
    const double value = (e.color ? lobe.color[e.index] : lobe.shape[e.index])[std::max(e.channel, 0)];
    const double kept = std::fmin(std::fmax(value, e.parameter->min), e.parameter->max);
    x.push_back(e.parameter->logarithmic ? std::log(kept) : kept);
  }
  return x;
}

void ParameterLayout::unpack(const double* x, LobeModel& model) const {
  for (const Entry& e : entries_) {
    const double value = e.parameter->logarithmic ? std::exp(*x) : *x;
    ++x;
    glm::dvec3& target = (e.color ? model.lobes[e.lobe].color : model.lobes[e.lobe].shape)[e.index];
    if (e.channel < 0) {
      target = glm::dvec3(value);
    } else {
      target[e.channel] = value;
    }
  }
}

double ParameterLayout::scale(const Entry& entry, double x) const {
  return entry.parameter->logarithmic ? std::exp(x) : 1;
}

double ParameterLayout::lower(const Entry& entry) const {
  return entry.parameter->logarithmic ? std::log(entry.parameter->min) : entry.parameter->min;
}

double ParameterLayout::upper(const Entry& entry) const {
  return entry.parameter->logarithmic ? std::log(entry.parameter->max) : entry.parameter->max;
}

SampleResidual::SampleResidual(const FitSample& sample, const ParameterLayout& layout, Compression compression)
    : sample_(sample), layout_(layout), compression_(compression) {
  set_num_residuals(3);
  mutable_parameter_block_sizes()->push_back(layout.size());
  for (int c = 0; c < 3; ++c) target_[c] = compress(compression, sample.value[c]);
}

bool SampleResidual::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  using Jet = ceres::Jet<double, 2>;  // two shape parameters, or the two of a Fresnel term
  static_assert(max_shape == 2);
  const double* x = parameters[0];
  const bool derive = jacobians && jacobians[0];
  Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> jacobian(derive ? jacobians[0] : nullptr, 3,
                                                                                 layout_.size());
  if (derive) jacobian.setZero();
  const std::vector<ParameterLayout::Entry>& entries = layout_.entries();

  glm::dvec3 sum(0);
  int at = 0;
  for (const Lobe& lobe : layout_.form().lobes) {
    const int shapes = static_cast<int>(lobe_info(lobe.kind).shape.size());
    const int colors = static_cast<int>(color_parameters(lobe.kind, lobe.fresnel).size());
    const int stride = layout_.separate_channels() ? 3 : 1;
    const int color_at = at + shapes * stride;
    Jet value;
    for (int c = 0; c < 3; ++c) {
      if (c == 0 || stride == 3) {
        Jet shape[max_shape];
        for (int i = 0; i < shapes; ++i) {
          const int k = at + i * stride + (stride == 3 ? c : 0);
          const double scale = layout_.scale(entries[k], x[k]);
          shape[i].a = entries[k].parameter->logarithmic ? scale : x[k];
          shape[i].v[i] = scale;
        }
        if (derive && shapes > 0) {
          value = visit_lobe(lobe.kind, shape, [&](const auto& functor) { return functor.eval(sample_.angles); });
        } else {
          const double plain[max_shape] = {shape[0].a, shape[1].a};
          value = Jet(visit_lobe(lobe.kind, plain, [&](const auto& functor) { return functor.eval(sample_.angles); }));
        }
      }
      Jet factor;
      if (!lobe.specular()) {
        factor = Jet(x[color_at + c], 0);
      } else {
        Jet color[2];
        for (int i = 0; i < 2; ++i) {
          const int k = color_at + 3 * i + c;
          const double scale = layout_.scale(entries[k], x[k]);
          color[i].a = entries[k].parameter->logarithmic ? scale : x[k];
          color[i].v[i] = scale;
        }
        factor = lobe.fresnel == Fresnel::schlick ? schlick(color[0], color[1], sample_.angles.cos_d)
                                                  : conductor(color[0], color[1], sample_.angles.cos_d);
      }
      sum[c] += factor.a * value.a;
      if (!derive) continue;
      for (int i = 0; i < shapes; ++i) {
        jacobian(c, at + i * stride + (stride == 3 ? c : 0)) = factor.a * value.v[i];
      }
      for (int i = 0; i < colors; ++i) jacobian(c, color_at + 3 * i + c) = factor.v[i] * value.a;
    }
    at = color_at + 3 * colors;
  }
  for (int c = 0; c < 3; ++c) {
    const double g = sum[c] * sample_.angles.cos_o;
    double slope = 0;
    residuals[c] = sample_.weight * (compress(compression_, g, derive ? &slope : nullptr) - target_[c]);
    if (derive) jacobian.row(c) *= slope * sample_.weight * sample_.angles.cos_o;
  }
  return true;
}

}  // namespace gonio::detail
