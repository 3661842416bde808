#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <Eigen/Core>
#include <ceres/ceres.h>

#include <gonio/fitting/fit/fit.h>
#include <gonio/fitting/fit/linear_start.h>
#include <gonio/fitting/fit/residual.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {

using detail::FitSample;
using detail::ParameterLayout;
using detail::SampleResidual;

void check(const FitOptions& o) {
  const auto require = [](bool good, const std::string& field, double found, const std::string& expected) {
    if (!good) throw Error("fit option " + field + " is " + std::to_string(found) + "; expected " + expected);
  };
  require(o.grazing_cutoff > 0 && o.grazing_cutoff <= pi<double> / 2, "grazing_cutoff", o.grazing_cutoff,
          "radians in (0, pi/2]");
  require(o.robust_width >= 0, "robust_width", o.robust_width, "0 or more");
  require(o.starts >= 1, "starts", o.starts, "1 or more");
  require(o.max_iterations >= 1, "max_iterations", o.max_iterations, "1 or more");
  require(o.theta_h >= 4, "theta_h", o.theta_h, "4 or more");
  require(o.theta_d >= 2, "theta_d", o.theta_d, "2 or more");
  require(o.phi_d >= 2, "phi_d", o.phi_d, "2 or more");
}

struct Attempt {
  LobeModel model;
  double initial_cost = 0, cost = std::numeric_limits<double>::infinity();
  int iterations = 0;
  Termination termination = Termination::failed;
};

class Fitter {
 public:
  Fitter(std::vector<FitSample> samples, const FitOptions& options)
      : samples_(std::move(samples)), options_(options), random_(options.seed) {}

  Fit stage(const LobeModel& form, const LobeModel* previous) {
    std::vector<Attempt> attempts = best_candidates(form, previous);
    const ParameterLayout layout(form, options_.separate_channels);
    if (previous) {
      // The smaller model with a lobe of no amplitude costs exactly the same, and refining
      // never raises a cost: so no stage can lose.
      Attempt same;
      same.model = form;
      std::copy(previous->lobes.begin(), previous->lobes.end(), same.model.lobes.begin());
      Lobe& added = same.model.lobes.back();
      added.shape = previous->lobes.back().shape;
      if (added.kind != previous->lobes.back().kind) added.shape = Lobe::initial(added.kind).shape;
      added.color = {};
      if (added.fresnel == Fresnel::conductor) added.color[0] = glm::dvec3(1);  // eta of vacuum
      same.initial_cost = cost(layout, same.model);
      attempts.push_back(same);
    }
    parallel_for(attempts.size(), [&](size_t i) { refine(layout, attempts[i]); });
    return summarise(layout, attempts);
  }

 private:
  double random() { return static_cast<double>(random_()) / 4294967296.0; }

  // A scan over the widths of the added lobe, and as many random sets of all shapes; the colours
  // are solved for, and the cheapest go on to be refined.
  std::vector<Attempt> best_candidates(const LobeModel& form, const LobeModel* previous) {
    std::vector<Attempt> candidates;
    Attempt base;
    base.model = form;
    for (Lobe& lobe : base.model.lobes) lobe = Lobe::initial(lobe.kind, lobe.fresnel);
    if (previous) std::copy(previous->lobes.begin(), previous->lobes.end(), base.model.lobes.begin());
    if (form.lobes.back().specular()) {
      const std::vector<Parameter>& shape = lobe_info(form.lobes.back().kind).shape;
      const int widths = 10;
      for (int i = 0; i < widths; ++i) {
        for (int j = 0; j < (shape.size() > 1 ? 3 : 1); ++j) {
          Attempt attempt = base;
          Lobe& lobe = attempt.model.lobes.back();
          const double low = 2 * shape[0].min, high = shape[0].max / 2;
          lobe.shape[0] = glm::dvec3(low * std::pow(high / low, i / (widths - 1.0)));
          if (j > 0) {
            lobe.shape[1] = glm::dvec3(std::sqrt(shape[1].initial * (j == 1 ? shape[1].min : shape[1].max)));
          }
          candidates.push_back(attempt);
        }
      }
      for (int i = 0; i < widths; ++i) {
        Attempt attempt = base;
        for (Lobe& lobe : attempt.model.lobes) randomise(lobe);
        candidates.push_back(attempt);
      }
    } else {
      candidates.push_back(base);
      for (int i = 1; i < options_.starts; ++i) {
        Attempt attempt = base;
        for (Lobe& lobe : attempt.model.lobes) randomise(lobe);
        candidates.push_back(attempt);
      }
    }
    const ParameterLayout layout(form, options_.separate_channels);
    parallel_for(candidates.size(), [&](size_t i) {
      detail::solve_colors(samples_, options_.compression, candidates[i].model);
      candidates[i].initial_cost = cost(layout, candidates[i].model);
    });
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Attempt& a, const Attempt& b) { return a.initial_cost < b.initial_cost; });
    if (static_cast<int>(candidates.size()) > options_.starts) candidates.resize(options_.starts);
    return candidates;
  }

  void randomise(Lobe& lobe) {
    const std::vector<Parameter>& shape = lobe_info(lobe.kind).shape;
    for (size_t i = 0; i < shape.size(); ++i) {
      const double t = random();
      lobe.shape[i] = glm::dvec3(shape[i].logarithmic ? shape[i].min * std::pow(shape[i].max / shape[i].min, t)
                                                      : shape[i].min + t * (shape[i].max - shape[i].min));
    }
  }

  double cost(const ParameterLayout& layout, const LobeModel& model) const {
    const std::vector<double> x = layout.pack(model);
    const double* parameters[1] = {x.data()};
    double sum = 0;
    for (const FitSample& sample : samples_) {
      Eigen::Vector3d residual;
      SampleResidual(sample, layout, options_.compression).Evaluate(parameters, residual.data(), nullptr);
      const double square = residual.squaredNorm();
      const double width = options_.robust_width * sample.weight;
      sum += width > 0 && square > width * width ? 2 * width * std::sqrt(square) - width * width : square;
    }
    return sum / 2;
  }

  void refine(const ParameterLayout& layout, Attempt& attempt) const {
    std::vector<double> x = layout.pack(attempt.model);
    ceres::Problem::Options problem_options;
    problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(problem_options);
    // Residuals carry the square root of a share; the width is meant for one unweighted residual.
    std::vector<std::unique_ptr<ceres::LossFunction>> losses;
    for (const FitSample& sample : samples_) {
      ceres::LossFunction* loss = nullptr;
      if (options_.robust_width > 0 && sample.weight > 0) {
        losses.push_back(std::make_unique<ceres::HuberLoss>(options_.robust_width * sample.weight));
        loss = losses.back().get();
      }
      problem.AddResidualBlock(new SampleResidual(sample, layout, options_.compression), loss, x.data());
    }
    for (int k = 0; k < layout.size(); ++k) {
      problem.SetParameterLowerBound(x.data(), k, layout.lower(layout.entries()[k]));
      problem.SetParameterUpperBound(x.data(), k, layout.upper(layout.entries()[k]));
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = options_.max_iterations;
    solver.function_tolerance = 1e-7;
    solver.parameter_tolerance = 1e-7;
    solver.gradient_tolerance = 1e-14;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (!summary.IsSolutionUsable()) return;
    layout.unpack(x.data(), attempt.model);
    attempt.cost = summary.final_cost;
    attempt.iterations = static_cast<int>(summary.iterations.size());
    attempt.termination =
        summary.termination_type == ceres::CONVERGENCE ? Termination::converged : Termination::iteration_limit;
  }

  // Lobes of one kind have no order of their own: widest first, so that starts can be compared.
  static void sort_lobes(LobeModel& model) {
    const auto first =
        std::find_if(model.lobes.begin(), model.lobes.end(), [](const Lobe& lobe) { return lobe.specular(); });
    if (first == model.lobes.end()) return;
    if (std::any_of(first, model.lobes.end(),
                    [&](const Lobe& lobe) { return lobe.kind != first->kind || lobe.fresnel != first->fresnel; })) {
      return;
    }
    const bool exponent = std::string(lobe_info(first->kind).shape[0].name) == "exponent";
    std::stable_sort(first, model.lobes.end(), [&](const Lobe& a, const Lobe& b) {
      return exponent ? a.shape[0].r < b.shape[0].r : a.shape[0].r > b.shape[0].r;
    });
  }

  Fit summarise(const ParameterLayout& layout, std::vector<Attempt>& attempts) const {
    const Attempt& best = *std::min_element(attempts.begin(), attempts.end(),
                                            [](const Attempt& a, const Attempt& b) { return a.cost < b.cost; });
    if (!std::isfinite(best.cost)) throw Error("fit: no start led to a usable solution");
    Fit fit;
    fit.model = best.model;
    sort_lobes(fit.model);
    fit.summary.termination = best.termination;
    fit.summary.iterations = best.iterations;
    fit.summary.initial_cost = best.initial_cost;
    fit.summary.cost = best.cost;
    fit.summary.samples = static_cast<int>(samples_.size());
    const std::vector<double> values = layout.pack(fit.model);
    std::vector<double> low = values, high = values;
    for (const Attempt& attempt : attempts) {
      fit.summary.costs.push_back(attempt.cost);
      if (!(attempt.cost <= 1.01 * best.cost)) continue;
      ++fit.summary.agreeing_starts;
      LobeModel other = attempt.model;
      sort_lobes(other);
      const std::vector<double> x = layout.pack(other);
      for (int k = 0; k < layout.size(); ++k) {
        low[k] = std::fmin(low[k], x[k]);
        high[k] = std::fmax(high[k], x[k]);
      }
    }
    for (int k = 0; k < layout.size(); ++k) {
      const ParameterLayout::Entry& e = layout.entries()[k];
      const auto plain = [&](double x) { return e.parameter->logarithmic ? std::exp(x) : x; };
      std::string name =
          std::to_string(e.lobe) + "." + lobe_info(fit.model.lobes[e.lobe].kind).id + "." + e.parameter->name;
      if (e.channel >= 0) name += std::string(".") + "rgb"[e.channel];
      fit.summary.parameters.push_back({name, plain(values[k]), plain(low[k]), plain(high[k])});
    }
    return fit;
  }

  std::vector<FitSample> samples_;
  FitOptions options_;
  std::mt19937 random_;
};

}  // namespace

const char* to_string(Termination termination) noexcept {
  switch (termination) {
    case Termination::converged:
      return "converged";
    case Termination::iteration_limit:
      return "iteration limit";
    case Termination::failed:
      break;
  }
  return "failed";
}

std::vector<Fit> fit_stages(const BrdfFunction& f, const LobeModel& form, const FitOptions& options) {
  check(options);
  if (form.lobes.empty()) throw Error("fit: the model has no lobe");
  std::vector<FitSample> samples = detail::fit_samples(f, options);
  if (samples.empty()) {
    throw Error("fit: found no pair of directions within " +
                std::to_string(std::lround(options.grazing_cutoff * 180 / pi<double>)) +
                " degrees that was measured, expected some");
  }
  if (std::none_of(samples.begin(), samples.end(), [](const FitSample& s) { return s.value != glm::dvec3(0); })) {
    throw Error("fit: the table is 0 or not finite at all " + std::to_string(samples.size()) + " samples");
  }
  Fitter fitter(std::move(samples), options);

  LobeModel part;
  part.name = form.name;
  std::vector<Lobe> specular;
  for (const Lobe& lobe : form.lobes) (lobe.specular() ? specular : part.lobes).push_back(lobe);
  std::vector<Fit> fits;
  if (specular.empty()) fits.push_back(fitter.stage(part, nullptr));
  for (const Lobe& lobe : specular) {
    part.lobes.push_back(lobe);
    fits.push_back(fitter.stage(part, fits.empty() ? nullptr : &fits.back().model));
  }
  return fits;
}

Fit fit(const BrdfFunction& f, const LobeModel& form, const FitOptions& options) {
  return fit_stages(f, form, options).back();
}

}  // namespace gonio
