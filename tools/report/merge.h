#pragma once

#include <filesystem>
#include <vector>

#include "tools/cli/failures.h"

namespace gonio {

/// `gonio report --merge`: writes several report.json as one, as report.json, report.html and report.md. Materials and
/// lights are in the order of the files; everything else is the first file's, but for the machine, whose parts name
/// every value that occurs. report.md has a line for each material and links to the page that its file lay beside.
/// @param failures gets the files that cannot be read, are no report, or are of another version: they are left out
/// @throws Error if none is left, or the folder cannot be written
void write_merged_report(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& paths,
                         Failures& failures);

}  // namespace gonio
