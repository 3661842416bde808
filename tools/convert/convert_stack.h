#pragma once

#include <filesystem>

#include <gonio/brdf/formats/cell_policies.h>

#include "tools/cli/options.h"

namespace gonio {

/// `gonio convert TABLE OUT.exr`: a compact BSDF as a stack file; or, for an `out` without extension, the smallest
/// of fitted lobes (.json) and compact BSDF (.exr) that has the variance asked for. Prints what was chosen and why.
/// @throws Error as load_input(), fit_compact() and save_stack().
void table_to_stack(const CLI::App& verb, const std::filesystem::path& in, const std::filesystem::path& out,
                    const StackRequest& request, const CellPolicies& policies);

}  // namespace gonio
