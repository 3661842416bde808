#pragma once

#include <filesystem>
#include <string>

namespace gonio {

// Both are called before long work, so that it is not in vain.

/// @throws Error if `file` could not be written.
void check_writable(const std::filesystem::path& file);

/// Makes a folder for results, if it is not there.
/// @throws Error if the folder cannot be made, or if `file` could not be written there.
void make_folder(const std::filesystem::path& folder, const std::string& file);

}  // namespace gonio
