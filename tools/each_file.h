#pragma once

#include <functional>
#include <string>
#include <vector>

namespace gonio {

/// Calls `work` for each of the files in turn. One that fails does not keep the others from being done.
/// @throws Error at the end if some failed: the error itself if there is only one file, else one that says how many
///   failed, which, and why.
void for_each_file(const std::vector<std::string>& files, const std::function<void(const std::string& file)>& work);

}  // namespace gonio
