#pragma once

#include <filesystem>
#include <string>

#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// Writes an SVG that shows what the mapping does (Havran et al. 2003, Fig. 6): a 16 x 16 grid of the
/// unit square as it lies on the flattened hemisphere, for several incident angles, over the density.
void write_grid_figure(const std::filesystem::path& path, const std::string& title, const Stack<float>& stack);

}  // namespace gonio
