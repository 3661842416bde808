#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/table/table.h>

#include "tools/measure/table_fits.h"

namespace gonio {

/// One of the forms that a material could have, measured.
struct FrontPoint {
  std::string id;     ///< compact/CHART or lobesN
  std::size_t bytes;  ///< all memory that it holds, a table apart
  double ns;          ///< nanoseconds a sample, one thread
  double relvar;      ///< worst relative variance of sampling the table, up to 80 degrees
  double eval_error;  ///< relative L1 to the table, see CompactQuality
  bool chosen = false;
};

/// The point of a compact fit.
FrontPoint front_point(const CompactFit& fit);

/// The point of a fitted model: its LobeSampler samples the table, the model alone is the BSDF.
FrontPoint front_point(const std::shared_ptr<const BrdfTable>& table, const StageFit& stage);

/// The points as JSON, ascending bytes: the members of FrontPoint and `on_front`, whether none of the others is at
/// least as good in bytes, ns, relvar and eval_error and better in one.
nlohmann::json front_json(std::vector<FrontPoint> points);

}  // namespace gonio
