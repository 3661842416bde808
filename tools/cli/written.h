#pragma once

#include <filesystem>

namespace gonio {

/// Names a file that was written on standard output.
void print_written(const std::filesystem::path& file);

}  // namespace gonio
