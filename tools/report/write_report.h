#pragma once

#include <filesystem>
#include <iosfwd>

#include "tools/report/measure/report_data.h"

namespace gonio {

/// Adds a material, under a name that no other of the report has: with a number after its own if need be. Materials in
/// the tables, and their pictures, are told apart by it.
void add_material(Report& report, MaterialReport material);

/// The report with stable keys; see docs/guide/tool.md.
nlohmann::json to_json(const Report& report);

/// Writes report.json, report.md, report.html and the figures of each material into `directory`, which must
/// exist; each file is replaced as a whole. @throws Error if that fails.
void write_report(const std::filesystem::path& directory, const Report& report);

/// A table of one line per material and method.
void print_summary(std::ostream& out, const Report& report);

}  // namespace gonio
