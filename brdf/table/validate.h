#pragma once

#include <filesystem>
#include <vector>

#include <gonio/mapping/base/problem.h>

namespace gonio {

/// Everything that is wrong or doubtful about a table file, not only the first thing: structure,
/// cells that a reader would repair (with their number), and a directional albedo above 1 at 2, 10,
/// 30, 50, 70, 80 or 85 degrees. Empty for a faultless file. Never throws for what a file holds or
/// lacks: an unreadable file is a fatal problem too.
Problems validate_table(const std::filesystem::path& path);

}  // namespace gonio
