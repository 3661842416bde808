#pragma once

#include <string>
#include <vector>

/// Not installed: the end of messages about a word that is not known.
namespace gonio {

/// "one of a, b, c; did you mean b?", where b is the known word that `found` is a slip of the fingers away from: a
/// third of its letters at most, each missing, added, wrong or swapped with the next, whatever their case. Without such
/// a word, "one of a, b, c".
std::string one_of(const std::vector<std::string>& known, const std::string& found);

}  // namespace gonio
