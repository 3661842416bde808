#pragma once

#include <iosfwd>

#include <nlohmann/json.hpp>

namespace gonio {

/// Writes the report as one HTML file that needs no other and no network.
/// @param report what to_json(const Report&) makes, all of it; it is embedded as it is.
void write_page(std::ostream& out, const nlohmann::json& report);

/// The page of `gonio compare` likewise. @param comparison what docs/guide/render.md calls compare.json, with
/// pictures as data: addresses
void write_compare_page(std::ostream& out, const nlohmann::json& comparison);

}  // namespace gonio
