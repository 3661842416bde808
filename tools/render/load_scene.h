#pragma once

#include <string>

#include <CLI/App.hpp>

#include <gonio/brdf/formats/cell_policies.h>

#include "tools/render/scene/scene.h"
#include "tools/render/trace/film.h"

namespace gonio {

/// What a verb that renders takes: a scene, or one material for the default scene.
struct SceneChoice {
  std::string scene, material, size;
  CellPolicies policies;

  /// Reads it; samplers are not built. @throws Error if there is none or both, or as read_scene().
  Scene load() const;
};

/// SCENE, --material, --size and the policies for cells. `choice` must outlive the parsing.
void add_scene_choice(CLI::App& verb, SceneChoice& choice);

/// --bounces, --seed and --threads. `options` must outlive the parsing.
void add_render_options(CLI::App& verb, RenderOptions& options);

/// @throws Error if one of them is out of range.
void check_render_options(const RenderOptions& options);

}  // namespace gonio
