#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/render/compare/compare_runs.h"

namespace gonio {

/// What compare.json holds (docs/guide/render.md), pictures apart. @param scene name of the scene or material
nlohmann::json to_json(const Comparison& comparison, const std::string& scene, const CompareOptions& options);

/// Writes compare.json, compare.md, compare.html, and the pictures that they refer to, into a folder that exists.
/// @throws Error if it cannot be written to.
void write_comparison(const std::filesystem::path& folder, const Comparison& comparison, const std::string& scene,
                      const CompareOptions& options);

}  // namespace gonio
