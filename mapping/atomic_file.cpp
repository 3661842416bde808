#include <gonio/mapping/atomic_file.h>
#include <gonio/mapping/error.h>

#include <fstream>
#include <random>
#include <string>

namespace gonio {
namespace fs = std::filesystem;

void write_atomically(const fs::path& target,
                      const std::function<void(const fs::path& temporary)>& write) {
  std::error_code code;
  const bool exists = fs::exists(target, code);
  if (exists && !fs::is_regular_file(target, code)) {
    throw Error(target.string() +
                ": found something that is not a file, expected a file or nothing");
  }
  // A rename over a link would replace the link.
  const fs::path file = exists ? fs::canonical(target) : target;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    throw Error(target.string() + ": folder: found none, expected " + folder.string());
  }
  fs::path temporary = file;
  temporary += ".part-" + std::to_string(std::random_device{}());
  try {
    write(temporary);
    fs::rename(temporary, file, code);
    if (code) throw Error(target.string() + ": cannot be replaced: " + code.message());
  } catch (...) {
    fs::remove(temporary, code);
    throw;
  }
}

void write_stream_atomically(const fs::path& target,
                             const std::function<void(std::ostream& stream)>& write) {
  write_atomically(target, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream) throw Error(target.string() + ": cannot be opened for writing");
    write(stream);
    stream.close();
    if (!stream) throw Error(target.string() + ": writing failed (is the disk full?)");
  });
}

}  // namespace gonio
