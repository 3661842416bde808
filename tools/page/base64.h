#pragma once

#include <string>

namespace gonio {

/// Bytes as base64, for data: addresses.
std::string base64(std::string bytes);

}  // namespace gonio
