#pragma once

#include <nlohmann/json.hpp>

#include <gonio/brdf/proof/measure.h>
#include <gonio/fitting/model/model.h>

namespace gonio {

/// The incident angles of the curves in degrees, some of report_angles.
inline constexpr double curve_angles[] = {10, 30, 50, 80};

// What the page draws, as JSON with four digits, for wi at theta_i [deg] in [0, 90). Keys and units
// are listed in docs/guide/report.md. All are deterministic.

/// The table itself: `theta_o_deg`, `table` and `disk`. @param f_r in 1/sr, as Subject has it.
/// @param albedo luminance of the albedo at theta_i; of a black table all values are 0.
nlohmann::json table_curves(const proof::Subject& subject, double theta_i, double albedo);

/// One method: `pdf` at the given directions of the plane of incidence [deg], `weights`, and if
/// `with_grid`, `grid`.
nlohmann::json method_curves(const proof::Subject& subject, double theta_i, const nlohmann::json& theta_o_deg,
                             bool with_grid);

/// A fitted model: `model`, luminance of its f_r cos(theta_o) over the table's albedo at these directions.
nlohmann::json model_curves(const LobeModel& model, double theta_i, const nlohmann::json& theta_o_deg, double albedo);

}  // namespace gonio
