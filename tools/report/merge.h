#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

namespace gonio {

/// Several report.json as one: materials and lights in the order of the files; of everything else the
/// first file's, but for the machine, whose parts name every value that occurs.
/// @throws Error naming the file that cannot be read, is no report, or is of another version
nlohmann::json merge_reports(const std::vector<std::filesystem::path>& paths);

/// `gonio report --merge`: writes report.json, report.html and report.md of the merged report. report.md
/// has a line for each material and links to the page that its file lay beside.
/// @throws Error as above, or if the folder cannot be written
void write_merged_report(const std::filesystem::path& directory, const std::vector<std::filesystem::path>& paths);

}  // namespace gonio
