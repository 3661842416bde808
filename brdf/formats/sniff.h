#pragma once

#include <filesystem>
#include <string>

#include <gonio/mapping/base/problem.h>

namespace gonio {

enum class TableFormat { merl, rgl, mbsdf, unknown };

/// The format of a table by its first bytes and size. A damaged file is still assigned to the
/// format that it resembles, so that the reader of that format can say what is wrong. @throws Error
/// if the file cannot be read.
TableFormat sniff_format(const std::filesystem::path& path);

/// What a file is, as far as its first bytes tell, and the command that takes it: "a luminaire, IES (gonio light
/// info takes it)". @throws Error if the file cannot be read.
std::string describe_file(const std::filesystem::path& path);

/// What to report about a file whose format is unknown: what it is, by describe_file(), and
/// what was expected.
Problem unknown_format(const std::filesystem::path& path);

}  // namespace gonio
