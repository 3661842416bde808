#include <gonio/tools/check_writable.h>

#include <fstream>
#include <random>
#include <string>

#include <gonio/mapping/error.h>

namespace gonio {

void check_writable(const std::filesystem::path& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) throw Error(file.string() + ": found a folder, expected a file or nothing");
  // By trying: permissions alone say little for root, or on a file system that takes no files.
  std::filesystem::path probe = file;
  probe += ".part-" + std::to_string(std::random_device{}());
  const bool writable = std::ofstream(probe).is_open();
  std::filesystem::remove(probe, code);
  if (!writable) throw Error(file.string() + ": folder: found none that takes files, expected one");
}

}  // namespace gonio
