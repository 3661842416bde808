#include "tools/cli/written.h"

#include <cstdio>

namespace gonio {

void print_written(const std::filesystem::path& file) { std::printf("written: %s\n", file.c_str()); }

}  // namespace gonio
