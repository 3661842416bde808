#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gonio {

/// Called before long work. @throws Error if `output` is the same file as one of `inputs`, by whatever
/// name or link, so that writing it would replace what was read. It need not exist; nor need they.
void check_not_input(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// The same for every file `names` in `folder`.
void check_not_input(const std::filesystem::path& folder, const std::vector<std::string>& names,
                     const std::vector<std::filesystem::path>& inputs);

}  // namespace gonio
