#pragma once

#include <filesystem>

#include <gonio/brdf/table/table.h>
#include <gonio/fitting/model/model.h>

namespace gonio {

/// True if the file holds a model, such as the fit.json of `gonio fit`: known by its content, which
/// begins as a JSON object does. @throws Error if the file cannot be read.
bool is_model_file(const std::filesystem::path& path);

/// A table file; or a model file, as the table that synthesize_merl() makes of it (180 phi_d bins,
/// which hold a reciprocal model without loss), with format "model". Warns on standard error of
/// transmission that the file has and the table has not.
/// @throws Error if it is neither.
BrdfTable load_input(const std::filesystem::path& path, const CellPolicies& policies = {});

}  // namespace gonio
