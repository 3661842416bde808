#include <cerrno>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace fs = std::filesystem;

void check_folder(const fs::path& folder) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) throw Error(folder.string() + ": no such folder");
}

void write_atomically(const fs::path& target, const std::function<void(const fs::path& temporary)>& write) {
  std::error_code code;
  const bool exists = fs::exists(target, code);
  if (code == std::errc::filename_too_long) throw Error(target.string() + ": cannot be written: " + code.message());
  if (exists && !fs::is_regular_file(target, code)) {
    throw Error(target.string() + ": found " +
                (fs::is_directory(target, code) ? "a folder" : "something that is not a file") +
                ", expected a file or nothing");
  }
  // A rename over a link would replace the link.
  const fs::path file = exists ? fs::canonical(target) : target;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  check_folder(folder);
  // Not the name of the file with something added: that may be longer than a name can be.
  const fs::path temporary = folder / ("gonio.part-" + std::to_string(std::random_device{}()));
  try {
    write(temporary);
    fs::rename(temporary, file, code);
    if (code) throw Error(target.string() + ": cannot be replaced: " + code.message());
  } catch (...) {
    fs::remove(temporary, code);
    throw;
  }
}

void write_stream_atomically(const fs::path& target, const std::function<void(std::ostream& stream)>& write) {
  write_atomically(target, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (!stream)
      throw Error(target.string() + ": folder: found one that takes no files (" +
                  std::generic_category().message(errno) + "), expected one that does");
    write(stream);
    stream.close();
    if (!stream) throw Error(target.string() + ": writing failed (is the disk full?)");
  });
}

}  // namespace gonio
