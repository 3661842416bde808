#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// Not installed: keeps nlohmann::json out of the public headers.
namespace gonio {

/// Objects and arrays inside each other, at most: what takes a value apart may then call itself.
inline constexpr std::size_t max_json_depth = 64;

/// The text of a file as JSON; every file of it that gonio reads comes through here.
/// @param where name for messages
/// @throws Error for what is no JSON, is nested deeper than max_json_depth, or names a member twice
nlohmann::json parse_json(std::string_view text, const std::string& where);

/// A value as text for a message, cut at some 40 bytes.
std::string shown(const nlohmann::json& value);

}  // namespace gonio
