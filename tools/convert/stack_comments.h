#pragma once

#include <string>

#include <gonio/brdf/build/compact/compact_quality.h>

namespace gonio {

/// Variance and errors, in words.
std::string describe(const CompactQuality& quality);

/// The comments of a stack file made by this program.
/// @param source file that it was made of, without its folder
/// @param made options and result
std::string stack_comments(const std::string& source, const std::string& made);

/// Adds a line. @throws Error for a text of no or of several lines.
void add_comment(std::string& comments, const std::string& line);

}  // namespace gonio
