#pragma once

#include <cstddef>
#include <vector>

#include <gonio/brdf/table/table.h>
#include <gonio/fitting/fit/errors.h>
#include <gonio/fitting/fit/fit.h>

namespace gonio {

/// What is fitted where no model is asked for: one to three GGX lobes over a Lambert lobe.
inline constexpr const char* default_fit_form = "ggx+ggx+ggx+lambert";

struct StageFit {
  Fit fit;
  FitErrorReport errors;
};

struct TableFits {
  std::vector<StageFit> stages;  ///< with one specular lobe, two, and so on
  double seconds = 0;            ///< of all fits together, which build on each other; not the errors
};

/// Fits what of the table was measured, and says how far the fits are from that.
TableFits fit_table(const BrdfTable& table, const LobeModel& form, const FitOptions& options = {});

/// More lobes are worth it only as long as the relative L1 error inside the cut-off falls: the
/// first stage within this factor of the best one is enough.
inline constexpr double enough_factor = 1.1;

/// The index of that stage.
std::size_t enough_lobes(const TableFits& fits);

}  // namespace gonio
