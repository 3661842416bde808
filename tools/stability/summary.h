#pragma once

#include <filesystem>
#include <iosfwd>

#include <nlohmann/json.hpp>

namespace gonio {

/// The stability.json that `gonio stability` wrote. @throws Error if it cannot be read or lacks a key.
nlohmann::json read_stability(const std::filesystem::path& path);

/// As a Markdown table: one line for each variant with how often it fails, its worst values and why.
void write_stability_summary(std::ostream& out, const nlohmann::json& stability);

}  // namespace gonio
