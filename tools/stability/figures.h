#pragma once

#include <filesystem>
#include <vector>

#include <gonio/mapping/diagram/diagram.h>

#include "tools/stability/measure_row.h"

namespace gonio {

/// Densities at an angle theta between two parallels, and the error of M_E there.
struct ReadingError {
  double correct;   ///< d_C, linear in theta (Havran et al. 2003, eq. 4)
  double real;      ///< d_R, linear in r = sqrt(1 - cos theta) (eq. 5 with numerator sqrt(1 - cos theta) - r_1)
  double absolute;  ///< (d_R - d_C) / max(d_1, d_2)
  double relative;  ///< absolute / d_C; its limit is not taken where d_C is 0
};

/// Of a density that goes from d1 at theta1 to d2 at theta2 [rad], theta1 <= theta <= theta2.
ReadingError reading_error(double theta, double theta1, double theta2, double d1, double d2);

/// The largest errors that `intervals` equal steps of theta from pole to horizon allow: a density that
/// falls from 1 to 0 (or rises) within one of them.
struct WorstReading {
  double absolute, absolute_at;  ///< at this theta [rad]
  double relative, relative_at;
};
WorstReading worst_reading_error(int intervals);

/// The diagram of Fig. 6 (c): N = 6, M = 7, random densities; of (d) with a patch of zeros.
DiagramGrid figure_6_grid(bool zero_patch);

/// SVG: variants by inputs; how far the largest error is beyond its bound, and what failed.
void write_chart(const std::filesystem::path& path, const std::vector<StabilityRow>& rows);

/// SVG of Fig. 3: densities d_C and d_R, and their errors, for one interval and for ten.
void write_figure_3(const std::filesystem::path& path);

/// SVG of Fig. 6 (a) to (d): a grid of the unit square, and what the maps make of it on the disk.
void write_figure_6(const std::filesystem::path& path);

}  // namespace gonio
