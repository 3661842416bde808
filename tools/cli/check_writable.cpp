#include "tools/cli/check_writable.h"

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

void check_writable(const std::filesystem::path& file) {
  // By trying, up to the first byte: permissions alone say little for root, or on a file system that takes no files.
  struct Writable {};
  try {
    write_stream_atomically(file, [](std::ostream&) { throw Writable(); });
  } catch (const Writable&) {  // the file is as it was
  }
}

void make_folder(const std::filesystem::path& folder, const std::string& file) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(folder.string() + ": cannot be made a folder: " + failed.message());
  check_writable(folder / file);
}

}  // namespace gonio
