#pragma once

#include <vector>

#include <Eigen/Core>

#include <gonio/fitting/fit/residual.h>

namespace gonio::detail {

/// Sets the colours of the model for the shapes it has: the amplitudes are linear (F0 and F90 of
/// the Schlick term included), so that they are a non-negative least-squares problem per channel.
/// Compression is met by reweighting with the slope of C between model and table, four times.
/// Conductors take the eta and k that give the F0 found, with eta = 1.
void solve_colors(const std::vector<FitSample>& samples, Compression compression, LobeModel& model);

/// Minimises |A x - b|^2 over x >= 0.
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace gonio::detail
