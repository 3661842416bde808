#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gonio {

/// SHA-256 of a file in hexadecimal digits, as sha256sum prints it. @throws Error if it cannot be read.
std::string sha256_of(const std::filesystem::path& path);

/// "gonio" and the arguments, quoted where a shell needs it.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace gonio
