#pragma once

#include <cstddef>
#include <filesystem>

namespace gonio {

/// Builds a stack file for every material of a scene manifest, of the sizes at which the summed variance
/// is least for the total of `bytes`, in the folder `out`, with scene-budget.json; prints the table of
/// docs/guide/scene.md. Nothing is written unless all stacks could be built.
/// @throws Error
void convert_scene(const std::filesystem::path& scene, std::size_t bytes, const std::filesystem::path& out);

}  // namespace gonio
