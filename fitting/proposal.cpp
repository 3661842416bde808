#include <ceres/ceres.h>
#include <gonio/fitting/proposal.h>

#include <algorithm>
#include <cmath>

namespace gonio::detail {
namespace {

const Parameter& shape_parameter(LobeKind kind, size_t i) { return lobe_info(kind).shape[i]; }

// Half vectors about the normal, theta_h spaced as the cube; phi over half the circle by mirror
// symmetry.
template <class F>
void for_half_vectors(double theta_i, const F& f) {
  constexpr int n_theta = 96, n_phi = 24;
  const glm::dvec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
  for (int i = 0; i < n_theta; ++i) {
    const double s = (i + 0.5) / n_theta, theta = s * s * s * pi<double> / 2;
    const double d_theta = 3 * s * s * pi<double> / 2 / n_theta;
    for (int j = 0; j < n_phi; ++j) {
      const double phi = pi<double> * (j + 0.5) / n_phi;
      const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
      const double cos_d = glm::dot(wi, h);
      if (!(cos_d > 1e-4)) continue;
      const double solid_angle = 4 * cos_d * std::sin(theta) * d_theta * 2 * pi<double> / n_phi;
      f(wi, reflect_about(wi, h), solid_angle);
    }
  }
}

template <class T>
T density(const std::vector<LobeKind>& kinds, const T* weight, const T* shape,
          const Angles<double>& angles) {
  T sum = weight[0] * T(cosine_pdf(angles.cos_o));
  for (size_t k = 0; k < kinds.size(); ++k) {
    sum += weight[k + 1] * visit_lobe(kinds[k], shape + k * max_shape,
                                      [&](const auto& lobe) { return lobe.pdf(angles); });
  }
  return sum;
}

// (target - p) / sqrt(p) at every point: the sum of squares is the chi-square divergence, plus what
// the mixture loses below the horizon, which is the relative variance of a draw. Parameters: square
// roots of the weights before normalisation (all but the least share of the cosine), then
// logarithms of the shapes.
class Divergence {
 public:
  Divergence(const std::vector<QuadraturePoint>& points, const std::vector<LobeKind>& kinds,
             double cosine_share)
      : points_(points), kinds_(kinds), cosine_share_(cosine_share) {}

  template <class T>
  bool operator()(T const* const* x, T* residual) const {
    using std::exp;
    using std::sqrt;
    const size_t parts = kinds_.size() + 1;
    std::array<T, 1 + LobeSampler::max_lobes> weight{};
    weights(x[0], weight.data());
    std::array<T, max_shape * LobeSampler::max_lobes> shape{};
    for (size_t i = 0; i < max_shape * (parts - 1); ++i) shape[i] = exp(x[1][i]);
    for (size_t i = 0; i < points_.size(); ++i) {
      const QuadraturePoint& point = points_[i];
      const T p = density(kinds_, weight.data(), shape.data(), point.angles) + T(1e-12);
      residual[i] = T(std::sqrt(point.solid_angle)) * (T(point.target) - p) / sqrt(p);
    }
    return true;
  }

  template <class T>
  void weights(const T* x, T* weight) const {
    const size_t parts = kinds_.size() + 1;
    T sum(0);
    for (size_t k = 0; k < parts; ++k) sum += x[k] * x[k];
    for (size_t k = 0; k < parts; ++k) weight[k] = T(1 - cosine_share_) * x[k] * x[k] / sum;
    weight[0] += T(cosine_share_);
  }

 private:
  const std::vector<QuadraturePoint>& points_;
  const std::vector<LobeKind>& kinds_;
  double cosine_share_;
};

}  // namespace

std::vector<QuadraturePoint> quadrature(const BrdfFunction& f, double theta_i) {
  std::vector<QuadraturePoint> points;
  double total = 0;
  for_half_vectors(theta_i, [&](const glm::dvec3& wi, const glm::dvec3& wo, double solid_angle) {
    const double value = wo.z > 0 ? luminance(f(glm::vec3(wi), glm::vec3(wo))) * wo.z : 0.0;
    points.push_back({Angles<double>(wi, wo), solid_angle, value});
    total += value * solid_angle;
  });
  if (!(total > 0)) return {};
  for (QuadraturePoint& point : points) point.target /= total;
  return points;
}

Proposal albedo_proposal(const LobeModel& model, double theta_i, double cosine_share) {
  Proposal proposal;
  proposal.weight.push_back(0);
  std::vector<size_t> part;  // of each lobe
  for (const Lobe& lobe : model.lobes) {
    if (lobe.specular()) {
      // A shape that differs between channels: the proposal takes the mean.
      std::array<double, max_shape> shape{};
      for (int i = 0; i < max_shape; ++i) {
        shape[i] = (lobe.shape[i].r + lobe.shape[i].g + lobe.shape[i].b) / 3;
      }
      proposal.shape.push_back(shape);
      proposal.weight.push_back(0);
    }
    part.push_back(lobe.specular() ? proposal.weight.size() - 1 : 0);
  }
  for (size_t l = 0; l < model.lobes.size(); ++l) {
    LobeModel single;
    single.lobes = {model.lobes[l]};
    for_half_vectors(theta_i, [&](const glm::dvec3& wi, const glm::dvec3& wo, double solid_angle) {
      if (wo.z > 0) {
        proposal.weight[part[l]] += luminance(glm::vec3(single.eval(wi, wo))) * wo.z * solid_angle;
      }
    });
  }
  double sum = 0;
  for (double w : proposal.weight) sum += w;
  for (double& w : proposal.weight) w = sum > 0 ? (1 - cosine_share) * w / sum : 0;
  proposal.weight[0] += sum > 0 ? cosine_share : 1;
  return proposal;
}

double relative_variance(const std::vector<QuadraturePoint>& points,
                         const std::vector<LobeKind>& kinds, const Proposal& proposal) {
  double sum = 0;
  for (const QuadraturePoint& point : points) {
    if (!(point.target > 0)) continue;
    const double* shape = proposal.shape.empty() ? nullptr : proposal.shape[0].data();
    const double p = density(kinds, proposal.weight.data(), shape, point.angles);
    sum += point.solid_angle * point.target * point.target / p;
  }
  return sum - 1;
}

Proposal refine_proposal(const std::vector<QuadraturePoint>& points,
                         const std::vector<LobeKind>& kinds, const Proposal& start, bool shapes,
                         double cosine_share) {
  const Divergence divergence(points, kinds, cosine_share);
  const size_t parts = kinds.size() + 1;
  std::vector<double> weight_root(parts),
      log_shape(max_shape * std::max<size_t>(kinds.size(), 1), 0.0);
  for (size_t k = 0; k < parts; ++k) {
    // Not from 0, where the square root has no slope.
    weight_root[k] = std::sqrt(std::fmax(start.weight[k] - (k == 0 ? cosine_share : 0), 0.02));
  }
  for (size_t k = 0; k < kinds.size(); ++k) {
    for (size_t i = 0; i < lobe_info(kinds[k]).shape.size(); ++i) {
      log_shape[k * max_shape + i] = std::log(start.shape[k][i]);
    }
  }
  ceres::Problem problem;
  auto* cost = new ceres::DynamicAutoDiffCostFunction<Divergence, 4>(new Divergence(divergence));
  cost->AddParameterBlock(static_cast<int>(weight_root.size()));
  cost->AddParameterBlock(static_cast<int>(log_shape.size()));
  cost->SetNumResiduals(static_cast<int>(points.size()));
  problem.AddResidualBlock(cost, nullptr, weight_root.data(), log_shape.data());
  for (size_t k = 0; k < kinds.size(); ++k) {
    for (size_t i = 0; i < lobe_info(kinds[k]).shape.size(); ++i) {
      const Parameter& parameter = shape_parameter(kinds[k], i);
      const int index = static_cast<int>(k * max_shape + i);
      problem.SetParameterLowerBound(log_shape.data(), index, std::log(parameter.min));
      problem.SetParameterUpperBound(log_shape.data(), index, std::log(parameter.max));
    }
  }
  if (!shapes || kinds.empty()) problem.SetParameterBlockConstant(log_shape.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 60;
  solver.function_tolerance = 1e-4;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return start;

  Proposal result = start;
  divergence.weights(weight_root.data(), result.weight.data());
  for (size_t k = 0; k < kinds.size(); ++k) {
    for (size_t i = 0; i < lobe_info(kinds[k]).shape.size(); ++i) {
      result.shape[k][i] = std::exp(log_shape[k * max_shape + i]);
    }
  }
  return relative_variance(points, kinds, result) < relative_variance(points, kinds, start) ? result
                                                                                            : start;
}

}  // namespace gonio::detail
