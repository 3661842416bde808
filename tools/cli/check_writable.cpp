#include "tools/cli/check_writable.h"

#include <gonio/mapping/base/atomic_file.h>

namespace gonio {

void check_writable(const std::filesystem::path& file) {
  // By trying, up to the first byte: permissions alone say little for root, or on a file system that takes no files.
  struct Writable {};
  try {
    write_stream_atomically(file, [](std::ostream&) { throw Writable(); });
  } catch (const Writable&) {  // the file is as it was
  }
}

}  // namespace gonio
