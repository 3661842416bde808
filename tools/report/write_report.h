#pragma once

#include <filesystem>
#include <iosfwd>

#include <gonio/tools/report/report_data.h>

namespace gonio {

/// The report with stable keys; see docs/tool.md.
nlohmann::json to_json(const Report& report);

/// Writes report.json, report.md, report.html and a figure per material into `directory`, which is made if need be; each file is
/// replaced as a whole. @throws Error if that fails.
void write_report(const std::filesystem::path& directory, const Report& report);

/// A table of one line per material and method.
void print_summary(std::ostream& out, const Report& report);

}  // namespace gonio
