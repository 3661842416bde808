#pragma once

#include <vector>

#include <ceres/ceres.h>

#include <gonio/fitting/fit/fit.h>

/// The pieces of a fit, apart so that tests can check them; not installed.
namespace gonio::detail {

/// One pair of directions with what the table says of it.
struct FitSample {
  Angles<double> angles;
  glm::dvec3 value;  ///< f_r cos_o
  double weight;     ///< square root of the share of the solid angles
};

/// The pairs of a half-difference grid inside the cut-off where f is not NaN.
std::vector<FitSample> fit_samples(const BrdfFunction& f, const FitOptions& options);

/// C(x), and its derivative where it is asked for.
double compress(Compression compression, double x, double* slope = nullptr) noexcept;

/// Where each parameter of a model lies in the vector that Ceres sees: per lobe the shape
/// parameters (one or three values each) and then the colours (three each). Logarithmic ones are
/// stored as logarithms.
class ParameterLayout {
 public:
  struct Entry {
    int lobe, index, channel;  ///< channel -1: shared by the three
    bool color;
    const Parameter* parameter;
  };

  ParameterLayout(const LobeModel& form, bool separate_channels);

  std::vector<double> pack(const LobeModel& model) const;
  void unpack(const double* x, LobeModel& model) const;
  /// Derivative of the parameter's value by the stored number.
  double scale(const Entry& entry, double x) const;
  double lower(const Entry& entry) const;
  double upper(const Entry& entry) const;

  int size() const { return static_cast<int>(entries_.size()); }
  const std::vector<Entry>& entries() const { return entries_; }
  const LobeModel& form() const { return form_; }
  bool separate_channels() const { return separate_channels_; }

 private:
  LobeModel form_;
  bool separate_channels_;
  std::vector<Entry> entries_;
};

/// weight (C(model) - C(table)) for the three channels of one sample.
class SampleResidual : public ceres::CostFunction {
 public:
  SampleResidual(const FitSample& sample, const ParameterLayout& layout, Compression compression);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const FitSample& sample_;
  const ParameterLayout& layout_;
  Compression compression_;
  glm::dvec3 target_;
};

}  // namespace gonio::detail
