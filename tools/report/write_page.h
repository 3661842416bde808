#pragma once

#include <iosfwd>

#include <nlohmann/json.hpp>

namespace gonio {

/// Writes the report as one HTML file that needs no other and no network.
/// @param report what to_json(const Report&) makes, all of it; it is embedded as it is.
void write_page(std::ostream& out, const nlohmann::json& report);

}  // namespace gonio
