#pragma once

#include <filesystem>

#include <gonio/brdf/build/stack/build_stack.h>

#include "tools/report/measure/report_data.h"

namespace gonio {

struct ReportOptions {
  BsdfOptions stack;
  CellPolicies policies;
};

/// Measures every method on one input: a table file, or a stack file (then as the self-contained
/// sampler that it is). Quality on all cores, times on one. @throws Error if the file cannot be used.
MaterialReport measure_material(const std::filesystem::path& path, const ReportOptions& options,
                                const Progress& progress);

Machine this_machine();

}  // namespace gonio
