#include "tools/render/data_folder.h"

#include <system_error>

#include <gonio/mapping/base/error.h>

namespace gonio {

std::filesystem::path data_folder() {
  std::error_code failed;
  const std::filesystem::path above =
      std::filesystem::read_symlink("/proc/self/exe", failed).parent_path().parent_path();
  if (failed) throw Error("/proc/self/exe: cannot be read: " + failed.message());
  const std::filesystem::path built = above / "data", installed = above / "share/gonio/data";
  for (const std::filesystem::path& folder : {built, installed})
    if (std::filesystem::is_directory(folder / "materials", failed)) return folder;
  throw Error("SCENE: found none, and neither " + built.string() + " nor " + installed.string() +
              ", which come with gonio, expected SCENE.json or --material FILE");
}

}  // namespace gonio
