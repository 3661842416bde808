#pragma once

#include <gonio/brdf/problem.h>

#include <filesystem>

namespace gonio {

enum class TableFormat { merl, rgl, mbsdf, unknown };

/// The format of a table by its first bytes and size. A damaged file is still assigned to the
/// format that it resembles, so that the reader of that format can say what is wrong. @throws Error
/// if the file cannot be read.
TableFormat sniff_format(const std::filesystem::path& path);

/// What to report about a file whose format is unknown: names what it is, where that can be told, and the
/// command that takes it.
Problem unknown_format(const std::filesystem::path& path);

}  // namespace gonio
