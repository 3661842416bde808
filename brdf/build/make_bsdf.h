#pragma once

#include <memory>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/build/stack/bsdf_options.h>
#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/progress.h>

namespace gonio {

/// Makes the BSDF of a table. Takes seconds, on all cores; deterministic. A BSDF that is to be loaded in milliseconds
/// is saved once by save_stack(). With BsdfValue::table the BSDF shares the ownership of the table.
///
/// If the variance asked for is out of reach within the budget, the BSDF is the nearest to it that fits.
/// @throws Error if `table` is null, and for sizes, a variance or a budget out of range.
Bsdf make_bsdf(std::shared_ptr<const BrdfTable> table, const BsdfOptions& options = {}, const Progress& progress = {});

}  // namespace gonio
