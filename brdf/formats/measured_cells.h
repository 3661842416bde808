#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gonio/brdf/formats/interpolate.h>

namespace gonio {

/// Where the value of a table's cell comes from.
enum class CellOrigin : std::uint8_t {
  measured,
  made_up,  ///< the file has no value: a neighbour's was taken, or 0
  outside   ///< stands for no pair of directions above the horizon
};

/// Which cells of a table [n][rows][columns] were measured. Immutable; thread-safe.
class MeasuredCells {
 public:
  MeasuredCells() = default;

  /// @param origins of all cells, the last axis running fastest; empty if all were measured
  MeasuredCells(std::vector<CellOrigin> origins, int rows, int columns)
      : origins_(std::move(origins)), rows_(rows), columns_(columns) {}

  /// The share of measured cells in what is interpolated between eight of them, in [0, 1]. Cells
  /// outside do not count; 0 if there are no others.
  float share(const Lerp& a, const Lerp& b, const Lerp& c) const noexcept {
    if (origins_.empty()) return 1.0f;
    float measured = 0.0f, all = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
      const auto index = [&](const Lerp& l, int bit) { return corner & bit ? l.hi : l.lo; };
      const auto weight = [&](const Lerp& l, int bit) { return corner & bit ? l.t : 1.0f - l.t; };
      const auto row = static_cast<std::size_t>(index(a, 1)) * static_cast<std::size_t>(rows_) +
                       static_cast<std::size_t>(index(b, 2));
      const CellOrigin origin =
          origins_[row * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(index(c, 4))];
      if (origin == CellOrigin::outside) continue;
      const float w = weight(a, 1) * weight(b, 2) * weight(c, 4);
      all += w;
      if (origin == CellOrigin::measured) measured += w;
    }
    return all > 0.0f ? measured / all : 0.0f;
  }

 private:
  std::vector<CellOrigin> origins_;
  int rows_ = 0, columns_ = 0;
};

}  // namespace gonio
