#include <algorithm>
#include <cctype>
#include <cstddef>

#include <gonio/mapping/base/did_you_mean.h>

namespace gonio {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Optimal string alignment: Levenshtein's distance with swaps of neighbours.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string one_of(const std::vector<std::string>& known, const std::string& found) {
  std::string text, nearest;
  std::size_t least = std::max<std::size_t>(found.size() / 3, 1) + 1;
  for (const std::string& word : known) {
    text += (text.empty() ? "one of " : ", ") + word;
    // A word of another length is as far away as its length says: no need to look at it, however long it is.
    if (std::max(word.size(), found.size()) - std::min(word.size(), found.size()) >= least) continue;
    const std::size_t away = distance(lower(found), lower(word));
    if (away >= least) continue;
    least = away;
    nearest = word;
  }
  return nearest.empty() ? text : text + "; did you mean " + nearest + "?";
}

}  // namespace gonio
