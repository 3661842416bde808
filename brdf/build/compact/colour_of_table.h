#pragma once

#include <functional>
#include <vector>

#include <gonio/brdf/table/table.h>
#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/charts/chart.h>

namespace gonio {

/// The map that a colour belongs to: (theta_i [rad], u, v) to a direction and its pdf.
using DirectionMap = std::function<DirectionSample<float>(float theta_i, float u, float v)>;

/// That of a Stack, which must outlive it.
template <class S>
DirectionMap direction_map(const S& stack) {
  return [&stack](float theta_i, float u, float v) { return stack.sample(theta_i, u, v); };
}

/// The mean weight of every cell, by stratified samples, 128 x 64 over all cells but at least 2 x 2 in each: the
/// albedo of the table is kept. Uses all cores. @throws Error as Colour does.
Colour colour_of_table(const BrdfTable& table, const DirectionMap& map, const std::vector<float>& theta_i, int side);

}  // namespace gonio
