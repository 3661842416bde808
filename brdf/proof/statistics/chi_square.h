#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gonio/brdf/proof/statistics/bins.h>

namespace gonio::proof {

/// The outcome of a chi-square goodness-of-fit test of draws against a pdf.
struct ChiSquare {
  double p = 0;  ///< probability of a statistic at least as large if the draws follow the pdf
  double statistic = 0;
  int degrees_of_freedom = 0;
  double pdf_integral = 0;              ///< over the domain of the bins, by quadrature: no draw is involved
  std::uint64_t draws = 0;              ///< all of them
  std::uint64_t empty = 0;              ///< draws without a direction
  std::uint64_t outside = 0;            ///< draws outside the domain or with a component that is not finite
  std::uint64_t where_zero = 0;         ///< draws where the pdf is 0, in cells over which it is
  std::vector<double> expected;         ///< per cell of the bins, for the draws that have a direction
  std::vector<std::uint64_t> observed;  ///< per cell of the bins

  /// Whether the draws can be told from the pdf: p >= significance and no draw outside or where the
  /// pdf is 0. The mass, pdf_integral + empty / draws, is for the caller to judge.
  bool passed(double significance) const noexcept { return p >= significance && outside == 0 && where_zero == 0; }
  /// One line for a test's message.
  std::string summary() const;
};

/// A draw of the sampler under test; the argument is the number of the draw, for its random numbers.
using Draw = std::function<std::optional<glm::vec3>(std::uint64_t)>;

/// Tests `draws` independent draws against `pdf` on `bins`. Cells that expect fewer than 5 draws are
/// pooled. The pdf's shape is tested: it is scaled to the draws that have a direction.
ChiSquare chi_square(const Draw& draw, const Density& pdf, const Bins& bins, std::uint64_t draws);

/// The significance of one of `tests` tests such that all pass with probability 1 - `overall` if
/// nothing is wrong (Sidak).
double sidak(double overall, int tests);

/// Writes a self-contained SVG of three panels over the flattened hemisphere or sphere (x = r cos phi, y = r sin
/// phi): pdf, histogram, and their difference in standard deviations. For looking at a failure.
void write_chi_square_plot(const std::string& path, const Bins& bins, const ChiSquare& result,
                           const std::string& title);

}  // namespace gonio::proof
