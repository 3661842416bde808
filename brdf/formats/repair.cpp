#include <algorithm>
#include <cmath>
#include <string>

#include <glm/common.hpp>

#include <gonio/brdf/formats/repair.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

void reject(const std::string& name, const char* kind, std::uint64_t count, const CellCounts& counts) {
  throw Error(name + ": found " + std::to_string(count) + " " + kind + " of " + std::to_string(counts.total) +
              ", expected none");
}

// Fills the holes of every line along one axis that has a filled cell.
void fill_along(std::vector<glm::vec3>& cells, std::vector<char>& filled, const CellAxis& axis) {
  const auto n = static_cast<std::ptrdiff_t>(axis.n);
  std::vector<std::ptrdiff_t> sources;
  for (std::size_t line = 0; line < axis.outer * axis.inner; ++line) {
    const std::size_t first = line / axis.inner * axis.n * axis.inner + line % axis.inner;
    const auto at = [&](std::ptrdiff_t i) { return first + static_cast<std::size_t>(i) * axis.inner; };
    sources.clear();
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      if (filled[at(i)]) sources.push_back(i);
    }
    if (sources.empty() || sources.size() == axis.n) continue;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      if (filled[at(i)]) continue;
      // The nearest source is a neighbour of i in the sorted list, which closes into a ring.
      const auto above = std::lower_bound(sources.begin(), sources.end(), i);
      std::ptrdiff_t best = -1, best_distance = n + 1;
      const auto consider = [&](std::ptrdiff_t source) {
        std::ptrdiff_t distance = std::abs(source - i);
        if (axis.periodic) distance = std::min(distance, n - distance);
        if (distance < best_distance) best = source, best_distance = distance;
      };
      if (above != sources.begin()) consider(*(above - 1));
      if (above != sources.end()) consider(*above);
      if (axis.periodic) consider(sources.front()), consider(sources.back());
      cells[at(i)] = cells[at(best)];
    }
    for (std::ptrdiff_t i = 0; i < n; ++i) filled[at(i)] = 1;
  }
}

}  // namespace

CellKind kind_of(const glm::vec3& cell) noexcept {
  // No BRDF comes near the bound; differences and products of what is below stay finite.
  constexpr float largest = 1e30f;
  const auto finite = [](float x) { return std::abs(x) <= largest; };  // not of NaN
  if (!finite(cell.r) || !finite(cell.g) || !finite(cell.b)) return CellKind::nonfinite;
  return cell.r < 0.0f || cell.g < 0.0f || cell.b < 0.0f ? CellKind::negative : CellKind::valid;
}

CellCounts repair_cells(std::vector<glm::vec3>& cells, const std::vector<CellKind>& kinds, const CellPolicies& policies,
                        const std::vector<CellAxis>& axes, const std::string& name) {
  CellCounts counts;
  counts.total = cells.size();
  for (const CellKind kind : kinds) {
    counts.negative += kind == CellKind::negative;
    counts.nonfinite += kind == CellKind::nonfinite;
    counts.missing += kind == CellKind::missing;
  }
  const auto check = [&](CellPolicy policy, const char* kind, std::uint64_t count) {
    if (policy == CellPolicy::reject && count > 0) reject(name, kind, count, counts);
  };
  check(policies.negative, "negative", counts.negative);
  check(policies.nonfinite, "not finite", counts.nonfinite);
  check(policies.missing, "missing", counts.missing);

  std::vector<char> filled(cells.size(), 1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    CellPolicy policy = CellPolicy::fill;
    if (kinds[i] == CellKind::negative) policy = policies.negative;
    if (kinds[i] == CellKind::nonfinite) policy = policies.nonfinite;
    if (kinds[i] == CellKind::missing) policy = policies.missing;
    if (kinds[i] == CellKind::valid) continue;
    if (policy == CellPolicy::fill) {
      filled[i] = 0;
    } else {
      cells[i] = kinds[i] == CellKind::negative ? glm::max(cells[i], 0.0f) : glm::vec3(0.0f);
    }
  }
  const auto complete = [&] { return std::find(filled.begin(), filled.end(), 0) == filled.end(); };
  for (const CellAxis& axis : axes) {
    if (complete()) break;
    fill_along(cells, filled, axis);
  }
  if (!complete()) throw Error(name + ": found no valid one, expected at least one");
  return counts;
}

std::vector<CellOrigin> cell_origins(const std::vector<CellKind>& kinds, const CellPolicies& policies) {
  const auto origin = [&](CellKind kind) {
    if (kind == CellKind::outside) return CellOrigin::outside;
    const bool kept = kind == CellKind::valid || (kind == CellKind::negative && policies.negative != CellPolicy::fill);
    return kept ? CellOrigin::measured : CellOrigin::made_up;
  };
  std::vector<CellOrigin> origins;
  origins.reserve(kinds.size());
  for (const CellKind kind : kinds) origins.push_back(origin(kind));
  const bool all = std::all_of(origins.begin(), origins.end(), [](CellOrigin o) { return o == CellOrigin::measured; });
  return all ? std::vector<CellOrigin>() : origins;
}

}  // namespace gonio
