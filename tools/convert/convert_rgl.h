#pragma once

#include <filesystem>

#include <gonio/brdf/formats/cell_policies.h>

namespace gonio {

/// Writes any input of `gonio convert` as an RGL `.bsdf` file. An RGL file keeps its colours, ndf
/// and sigma (write_rgl()); a self-contained stack file, a table or a model is resampled.
/// @param rgb_only without spectra
/// @throws Error; among others for a spectral RGL file unless `rgb_only`: it is there already
void convert_to_rgl(const std::filesystem::path& in, const std::filesystem::path& out, const CellPolicies& policies,
                    bool rgb_only);

}  // namespace gonio
