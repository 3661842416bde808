#pragma once

#include <cstddef>
#include <filesystem>

namespace gonio {

/// Builds a stack file for every material of the scene manifest `path`, of the sizes at which the summed variance
/// is least for the total of `bytes`, in the folder `out`, with scene-budget.json; prints the table of
/// docs/guide/scene.md. A material that fails is left out: the others share the bytes and are written.
/// @throws Error that names the materials that failed, after the others are written
void convert_scene(const std::filesystem::path& path, std::size_t bytes, const std::filesystem::path& out);

}  // namespace gonio
