#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <type_traits>

#include <ceres/ceres.h>

#include <gonio/fitting/fit/half_vectors.h>
#include <gonio/fitting/sampling/proposal.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio::detail {
namespace {

constexpr int shape_size = 3;
constexpr double min_alpha = 0.002, max_alpha = 4, max_shear = 2;
constexpr double least_cos_d = 1e-4;  // of the half vectors that the quadratures look at

glm::dvec3 incident(double theta_i) { return {std::sin(theta_i), 0, std::cos(theta_i)}; }

double density(const Quadrature& quadrature, const Quadrature::Point& point, const Proposal& proposal) {
  double sum = proposal.weight[0] * cosine_pdf(point.wo.z);
  for (size_t k = 0; k < proposal.shape.size(); ++k)
    sum += proposal.weight[k + 1] * proposal.shape[k].pdf(quadrature.wi, point.wo);
  return sum;
}

// (target - p) / sqrt(p) at every point: the sum of squares is the chi-square divergence, plus what
// the mixture loses below the horizon, which is the relative variance of a draw. Parameters: square
// roots of the weights before normalisation (the least share of the cosine apart), then per lobe
// log alpha_x, log alpha_y and shear.
//
// Jets carry the derivatives of one lobe by its own three parameters, and the mixture is
// differentiated by hand: most of a jet of all parameters would be zeros.
class Divergence : public ceres::CostFunction {
 public:
  Divergence(const Quadrature& quadrature, size_t lobes, double cosine_share)
      : quadrature_(quadrature), lobes_(lobes), cosine_share_(cosine_share) {
    set_num_residuals(static_cast<int>(quadrature.points.size()));
    *mutable_parameter_block_sizes() = {static_cast<int>(1 + lobes), static_cast<int>(shape_size * lobes)};
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    if (jacobians && jacobians[1]) {
      fill<ceres::Jet<double, shape_size>>(x, residuals, jacobians[0], jacobians[1]);
    } else {
      fill<double>(x, residuals, jacobians ? jacobians[0] : nullptr, nullptr);
    }
    return true;
  }

  /// Sums to 1.
  PerPart weights(const PerPart& root) const {
    PerPart weight = (1 - cosine_share_) * root.square() / root.square().sum();
    weight[0] += cosine_share_;
    return weight;
  }

 private:
  template <class T>
  void fill(double const* const* x, double* residual, double* by_root, double* by_shape) const {
    using std::exp;
    const PerPart root = Eigen::Map<const PerPart>(x[0], 1 + lobes_), weight = weights(root);
    const double root_sum = root.square().sum();
    ShearedGgx<T> shape[LobeSampler::max_lobes];
    for (size_t k = 0; k < lobes_; ++k) {
      T p[shape_size];
      for (int i = 0; i < shape_size; ++i) p[i] = parameter<T>(x[1][k * shape_size + i], i);
      shape[k] = {exp(p[0]), exp(p[1]), p[2]};
    }
    for (const Quadrature::Point& point : quadrature_.points) {
      T part[LobeSampler::max_lobes];
      // Sums of so few terms are faster in one loop than as Eigen's of a size known at run time.
      double value[1 + LobeSampler::max_lobes] = {cosine_pdf(point.wo.z)};
      double p = weight[0] * value[0] + 1e-12;
      double mean = (weight[0] - cosine_share_) * value[0];  // with the weights that x decides
      for (size_t k = 0; k < lobes_; ++k) {
        part[k] = shape[k].pdf(quadrature_.wi, point.wo);
        value[k + 1] = plain(part[k]);
        p += weight[k + 1] * value[k + 1];
        mean += weight[k + 1] * value[k + 1];
      }
      const double scale = std::sqrt(point.solid_angle / p);
      *residual++ = scale * (point.target - p);
      const double slope = -0.5 * scale * (point.target + p) / p;  // of the residual by p
      if (by_root) {
        for (size_t k = 0; k <= lobes_; ++k)
          *by_root++ = slope * 2 * root[k] / root_sum * ((1 - cosine_share_) * value[k] - mean);
      }
      if constexpr (!std::is_same_v<T, double>) {
        for (size_t k = 0; k < lobes_; ++k, by_shape += shape_size)
          Eigen::Vector3d::Map(by_shape) = slope * weight[k + 1] * part[k].v;
      }
    }
  }

  template <class T>
  static T parameter(double value, [[maybe_unused]] int index) {
    if constexpr (std::is_same_v<T, double>) {
      return value;
    } else {
      return T(value, index);
    }
  }
  static double plain(double x) { return x; }
  static double plain(const ceres::Jet<double, shape_size>& x) { return x.a; }

  const Quadrature& quadrature_;
  size_t lobes_;
  double cosine_share_;
};

// About the width of a GGX with the same peak of its slope distribution.
double ggx_width(LobeKind kind, double first) {
  const bool exponent = std::string_view(lobe_info(kind).shape[0].name) == "exponent";
  return exponent ? std::sqrt(2 / (first + 2)) : first;
}

// Other ways to lay out the lobes than the model's: nested widths, and leaning to either side.
std::vector<Proposal> other_starts(const Proposal& model, double cosine_share) {
  const size_t lobes = model.shape.size();
  std::vector<Proposal> starts;
  const double widest[] = {0.8, 0.3, 0.1}, lean[] = {0, 0.4};
  for (double alpha : widest) {
    for (double shear : lean) {
      Proposal start;
      start.weight = PerPart::Constant(lobes + 1, (1 - cosine_share) / static_cast<double>(lobes + 1));
      start.weight[0] += cosine_share;
      for (size_t k = 0; k < lobes; ++k) {
        const double width = alpha / std::pow(2.5, static_cast<double>(k));
        start.shape.push_back({width, width, shear * (k % 2 == 0 ? 1 : -1)});
      }
      starts.push_back(start);
    }
  }
  return starts;
}

// A lobe without weight has no gradient to bring it back, and a shape of no meaning.
constexpr double dead_weight = 0.02;

size_t heaviest(const Proposal& p) {
  Eigen::Index lobe = 0;
  p.weight.tail(p.shape.size()).maxCoeff(&lobe);
  return static_cast<size_t>(lobe);
}

// Dead lobes start again beside the heaviest one, narrower and wider in turn.
Proposal revived(Proposal p) {
  const ShearedGgx<double> model = p.shape[heaviest(p)];
  bool narrower = true;
  for (size_t k = 0; k < p.shape.size(); ++k) {
    if (p.weight[k + 1] >= dead_weight) continue;
    const double factor = narrower ? 0.6 : 1.7;
    p.shape[k] = {factor * model.alpha_x, factor * model.alpha_y, model.shear};
    p.weight[k + 1] = 0.15;
    narrower = !narrower;
  }
  p.weight /= p.weight.sum();
  return p;
}

Proposal refine_from(const Quadrature& quadrature, const Proposal& start, double cosine_share) {
  Proposal best = refine_proposal(quadrature, start, true, cosine_share);
  if (!quadrature.points.empty() && (best.weight.tail(best.shape.size()) < dead_weight).any()) {
    const Proposal other = refine_proposal(quadrature, revived(best), true, cosine_share);
    if (relative_variance(quadrature, other) < relative_variance(quadrature, best)) best = other;
  }
  return best;
}

// A dead lobe takes the shape that it has at the nearest angle where it lives, so that between the
// two angles only its weight changes.
void lend_shapes(std::vector<Proposal>& proposals) {
  const int n = static_cast<int>(proposals.size());
  for (size_t k = 0; k < proposals[0].shape.size(); ++k) {
    std::vector<int> living;
    for (int i = 0; i < n; ++i) {
      if (proposals[i].weight[k + 1] >= dead_weight) living.push_back(i);
    }
    for (int i = 0; i < n && !living.empty(); ++i) {
      const int nearest = *std::min_element(living.begin(), living.end(),
                                            [&](int a, int b) { return std::abs(a - i) < std::abs(b - i); });
      proposals[i].shape[k] = proposals[nearest].shape[k];
    }
  }
}

}  // namespace

Quadrature quadrature(const BrdfFunction& f, double theta_i) {
  Quadrature result;
  result.wi = incident(theta_i);
  double total = 0;
  for_half_vectors(result.wi, least_cos_d, [&](const glm::dvec3& wo, double solid_angle) {
    const double value = luminance(f(glm::vec3(result.wi), glm::vec3(wo))) * wo.z;
    result.points.push_back({wo, solid_angle, value});
    total += value * solid_angle;
  });
  if (!(total > 0)) result.points.clear();
  for (Quadrature::Point& point : result.points) point.target /= total;
  return result;
}

Proposal albedo_proposal(const LobeModel& model, double theta_i, double cosine_share) {
  Proposal proposal;
  proposal.weight = PerPart::Zero(1 + model.specular_count());
  const glm::dvec3 wi = incident(theta_i);
  for (const Lobe& lobe : model.lobes) {
    size_t part = 0;
    if (lobe.specular()) {
      // A shape that differs between channels: the proposal takes the mean.
      const double width = ggx_width(lobe.kind, (lobe.shape[0].r + lobe.shape[0].g + lobe.shape[0].b) / 3);
      proposal.shape.push_back({width, width, 0});
      part = proposal.shape.size();
    }
    const LobeModel single{"", {lobe}};
    for_half_vectors(wi, least_cos_d, [&](const glm::dvec3& wo, double solid_angle) {
      proposal.weight[part] += luminance(glm::vec3(single.eval(wi, wo))) * wo.z * solid_angle;
    });
  }
  const double sum = proposal.weight.sum();
  if (sum > 0) {
    proposal.weight *= (1 - cosine_share) / sum;
    proposal.weight[0] += cosine_share;
  } else {
    proposal.weight.setZero();
    proposal.weight[0] = 1;
  }
  return proposal;
}

double relative_variance(const Quadrature& quadrature, const Proposal& proposal) {
  double sum = 0;
  for (const Quadrature::Point& point : quadrature.points) {
    if (!(point.target > 0)) continue;
    sum += point.solid_angle * point.target * point.target / density(quadrature, point, proposal);
  }
  return sum - 1;
}

Proposal refine_proposal(const Quadrature& quadrature, const Proposal& start, bool shapes, double cosine_share) {
  const size_t lobes = start.shape.size();
  if (quadrature.points.empty() || lobes == 0) return start;
  PerPart root = start.weight;
  root[0] -= cosine_share;
  root = root.max(0.02).sqrt();  // not from 0, where the square root has no slope
  std::vector<double> shape;
  for (const ShearedGgx<double>& s : start.shape) {
    for (double alpha : {s.alpha_x, s.alpha_y}) {
      shape.push_back(std::log(std::fmin(std::fmax(alpha, min_alpha), max_alpha)));
    }
    shape.push_back(s.shear);
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new Divergence(quadrature, lobes, cosine_share), nullptr, root.data(), shape.data());
  for (int i = 0; i < static_cast<int>(shape.size()); ++i) {
    const bool shear = i % shape_size == 2;
    problem.SetParameterLowerBound(shape.data(), i, shear ? -max_shear : std::log(min_alpha));
    problem.SetParameterUpperBound(shape.data(), i, shear ? max_shear : std::log(max_alpha));
  }
  if (!shapes) problem.SetParameterBlockConstant(shape.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = 50;
  solver.function_tolerance = 1e-4;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return start;

  Proposal result = start;
  result.weight = Divergence(quadrature, lobes, cosine_share).weights(root);
  for (size_t k = 0; k < lobes; ++k) {
    const double* p = shape.data() + k * shape_size;
    result.shape[k] = {std::exp(p[0]), std::exp(p[1]), p[2]};
  }
  return relative_variance(quadrature, result) < relative_variance(quadrature, start) ? result : start;
}

std::vector<Proposal> refine_all(const std::vector<Quadrature>& quadratures, std::vector<Proposal> start, bool shapes,
                                 double cosine_share) {
  const size_t n = start.size();
  if (!shapes || start[0].shape.empty()) {
    parallel_for(n, [&](size_t i) { start[i] = refine_proposal(quadratures[i], start[i], false, cosine_share); });
    return start;
  }
  const size_t middle = n / 2;
  std::vector<Proposal> candidates = other_starts(start[middle], cosine_share);
  candidates.push_back(start[middle]);
  parallel_for(candidates.size(),
               [&](size_t i) { candidates[i] = refine_from(quadratures[middle], candidates[i], cosine_share); });
  start[middle] = *std::min_element(candidates.begin(), candidates.end(), [&](const Proposal& a, const Proposal& b) {
    return relative_variance(quadratures[middle], a) < relative_variance(quadratures[middle], b);
  });
  parallel_for(2, [&](size_t side) {
    if (side == 0) {
      for (size_t i = middle; i-- > 0;) {
        start[i] = refine_from(quadratures[i], start[i + 1], cosine_share);
      }
    } else {
      for (size_t i = middle + 1; i < n; ++i) {
        start[i] = refine_from(quadratures[i], start[i - 1], cosine_share);
      }
    }
  });
  lend_shapes(start);
  return start;
}

}  // namespace gonio::detail
