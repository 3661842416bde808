#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <gonio/brdf/formats/cell_policies.h>

#include "tools/render/scene/scene.h"

namespace gonio {

/// Reads a scene as docs/guide/render.md describes it, with all files that it names; their paths are
/// relative to the scene's folder. Samplers of tables are not built yet: see build_materials().
/// @throws Error naming file and field for whatever is missing, unknown, out of range or unreadable.
Scene read_scene(const std::filesystem::path& path, const CellPolicies& policies = {});

/// The same from JSON in memory. @param where name for messages
Scene make_scene(const nlohmann::json& json, const std::string& where, const std::filesystem::path& folder,
                 const CellPolicies& policies = {});

/// The scene that shows one material, a file of any kind that a scene's material can name: the
/// preview object on a tiled ground under a generated sky.
nlohmann::json default_scene(const std::filesystem::path& material);

}  // namespace gonio
