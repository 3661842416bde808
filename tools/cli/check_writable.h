#pragma once

#include <filesystem>

namespace gonio {

/// Called before long work, so that it is not in vain. @throws Error if `file` could not be written.
void check_writable(const std::filesystem::path& file);

}  // namespace gonio
