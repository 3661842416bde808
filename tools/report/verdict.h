#pragma once

#include <string>

#include "tools/report/measure/report_data.h"

namespace gonio {

/// 1 / (ns of a sample x (mean_relvar + 0.001)): what a method is chosen by, larger is better. The
/// constant is the noise that is never alone: light adds more than a thousandth.
double efficiency(const MethodReport& method);

/// The method with the largest efficiency; null if there is none.
const MethodReport* best_method(const MaterialReport& material);

/// `displacement (outgoing)`; the chart only where there is one.
std::string title(const MethodReport& method);

/// Plain sentences: what to sample this material with, and whether fitted lobes would do.
std::string verdict(const MaterialReport& material);

}  // namespace gonio
