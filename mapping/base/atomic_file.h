#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <ostream>

namespace gonio {

/// @throws Error if there is no such folder.
void check_folder(const std::filesystem::path& folder);

/// Replaces `target` as a whole or leaves it as it was: calls `write` with the path of a new
/// temporary file beside it, and renames that to `target` when `write` returns. If anything throws,
/// the temporary file is removed and the exception passed on. A symbolic link is followed.
/// @throws Error if the folder does not exist, `target` is something other than a file, or the
/// rename
///   fails.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// write_atomically for a binary stream. @throws Error also if the stream fails (disk full).
void write_stream_atomically(const std::filesystem::path& target,
                             const std::function<void(std::ostream& stream)>& write);

}  // namespace gonio
