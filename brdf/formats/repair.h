#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/cell_policies.h>
#include <gonio/brdf/formats/measured_cells.h>

namespace gonio {

/// What one RGB cell of a table is.
enum class CellKind : std::uint8_t {
  valid,
  negative,   ///< finite, with a channel below 0
  nonfinite,  ///< with a channel that is NaN, infinite or beyond 1e30
  missing,    ///< marked as not measured
  outside     ///< stands for no pair of directions above the horizon; always filled, never counted
};

/// valid, negative or nonfinite.
CellKind kind_of(const glm::vec3& cell) noexcept;

/// An axis of a table seen as [outer][n][inner].
struct CellAxis {
  std::size_t outer, n, inner;
  bool periodic;
};

/// Applies the policies. CellPolicy::zero: negative channels become 0 and the others stay;
/// nonfinite and missing cells become black. CellPolicy::fill: the whole cell takes the nearest
/// valid one along the first axis that has a valid cell on that line (the lower index at equal
/// distance), then along the second axis, and so on.
/// @param name of the cells, for errors
/// @throws Error under CellPolicy::reject, or if cells are to be filled and none is valid.
CellCounts repair_cells(std::vector<glm::vec3>& cells, const std::vector<CellKind>& kinds, const CellPolicies& policies,
                        const std::vector<CellAxis>& axes, const std::string& name = "cells");

/// What the same policies make of each cell. A negative value is measured, noise about 0, unless
/// CellPolicy::fill replaces it; one that is not finite or missing never is. Empty if every cell is
/// measured.
std::vector<CellOrigin> cell_origins(const std::vector<CellKind>& kinds, const CellPolicies& policies);

}  // namespace gonio
