#pragma once

#include <string>

namespace gonio {

/// Refuses attributes that claim more bytes than the file has, or another size than their type: OpenEXR
/// allocates and clears what they claim, up to 2 GB each, before it finds out. Everything else is
/// left for OpenEXR to judge. @throws Error naming file and attribute
void check_attribute_sizes(const std::string& file);

}  // namespace gonio
