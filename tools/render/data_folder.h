#pragma once

#include <filesystem>

namespace gonio {

/// The folder of materials, lamps and scenes that comes with the program: data/ of the source tree beside its build, or
/// share/gonio/data of an install.
/// @throws Error if neither is there.
std::filesystem::path data_folder();

}  // namespace gonio
