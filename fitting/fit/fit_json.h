#pragma once

#include <string>

#include <gonio/fitting/fit/errors.h>
#include <gonio/fitting/fit/fit.h>

namespace gonio {

/// What `gonio fit` writes: the model as in to_json(const LobeModel&), so that load_model() reads
/// it back, and besides the summary of the fit and its errors with their units.
std::string to_json(const Fit& fit, const FitErrorReport& errors);

}  // namespace gonio
