#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>
#include <sstream>

#include <boost/math/special_functions/gamma.hpp>

#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio::proof {

ChiSquare chi_square(const Draw& draw, const Density& pdf, const Bins& bins, std::uint64_t draws) {
  ChiSquare result;
  result.draws = draws;
  result.expected = bins.integrate(pdf, draws);
  result.observed.assign(bins.size(), 0);
  for (std::uint64_t k = 0; k < draws; ++k) {
    const auto w = draw(k);
    if (!w) {
      ++result.empty;
      continue;
    }
    const std::size_t cell = std::isfinite(w->x + w->y + w->z) ? bins.index(*w) : bins.size();
    if (cell == bins.size()) {
      ++result.outside;
      continue;
    }
    ++result.observed[cell];
    // The quadrature may have missed a sliver of the cell: the density where the draw is has the last word.
    if (result.expected[cell] == 0 && !(pdf(*w) > 0)) ++result.where_zero;
  }
  result.pdf_integral = std::accumulate(result.expected.begin(), result.expected.end(), 0.0);
  const double inside = static_cast<double>(draws - result.empty - result.outside);
  if (!(result.pdf_integral > 0) || inside == 0) return result;
  for (double& e : result.expected) e *= inside / result.pdf_integral;

  std::vector<std::size_t> order(bins.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return result.expected[a] < result.expected[b]; });
  double pooled_expected = 0, pooled_observed = 0;
  int cells = 0;
  const auto add = [&](double expected, double observed) {
    result.statistic += (observed - expected) * (observed - expected) / expected;
    ++cells;
  };
  for (const std::size_t k : order) {
    const double expected = result.expected[k], observed = static_cast<double>(result.observed[k]);
    if (expected < 5 || (pooled_expected < 5 && pooled_expected + pooled_observed > 0)) {
      pooled_expected += expected;
      pooled_observed += observed;
    } else {
      add(expected, observed);
    }
  }
  if (pooled_expected > 0) add(pooled_expected, pooled_observed);
  result.degrees_of_freedom = cells - 1;
  result.p = cells > 1 ? boost::math::gamma_q(result.degrees_of_freedom / 2.0, result.statistic / 2) : 1;
  return result;
}

double sidak(double overall, int tests) { return -std::expm1(std::log1p(-overall) / tests); }

std::string ChiSquare::summary() const {
  std::ostringstream text;
  text << "chi2 = " << statistic << ", " << degrees_of_freedom << " degrees of freedom, p = " << p << ", pdf integral "
       << pdf_integral << ", " << draws << " draws, " << empty << " empty, " << outside << " outside, " << where_zero
       << " where the pdf is 0";
  return text.str();
}

void write_chi_square_plot(const std::string& path, const Bins& bins, const ChiSquare& result,
                           const std::string& title) {
  const auto& phi = bins.phi();
  const auto& r = bins.r();
  const std::size_t n = r.size() - 1;
  const double peak =
      result.expected.empty() ? 1 : std::max(1.0, *std::max_element(result.expected.begin(), result.expected.end()));
  write_stream_atomically(path, [&](std::ostream& out) {
    out << std::setprecision(4)
        << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 960 370\" font-family=\"sans-serif\">\n"
        << "<rect width=\"960\" height=\"370\" fill=\"white\"/><text x=\"10\" y=\"20\" font-size=\"14\">" << title
        << "</text>\n<text x=\"10\" y=\"38\" font-size=\"11\">" << result.summary() << "</text>\n";
    const char* captions[3] = {"expected", "observed", "(observed - expected) / sigma: blue -4, red +4"};
    for (int panel = 0; panel < 3; ++panel) {
      const double cx = 160 + 320 * panel, cy = 205, scale = 145 / r.back();
      out << "<text x=\"" << cx << "\" y=\"365\" text-anchor=\"middle\" font-size=\"11\">" << captions[panel]
          << "</text>\n";
      for (std::size_t k = 0; k < bins.size(); ++k) {
        const double expected = result.expected[k], observed = static_cast<double>(result.observed[k]);
        int red, green, blue;
        if (panel < 2) {
          const double t = std::clamp(std::sqrt((panel == 0 ? expected : observed) / peak), 0.0, 1.0);
          red = green = blue = static_cast<int>(255 * (1 - t));
        } else {
          const double z = std::clamp((observed - expected) / std::sqrt(std::max(expected, 1.0)) / 4, -1.0, 1.0);
          red = static_cast<int>(255 * (z < 0 ? 1 + z : 1));
          green = static_cast<int>(255 * (1 - std::abs(z)));
          blue = static_cast<int>(255 * (z > 0 ? 1 - z : 1));
        }
        const double p0 = phi[k / n], p1 = phi[k / n + 1], r0 = scale * r[k % n], r1 = scale * r[k % n + 1];
        out << "<path fill=\"rgb(" << red << ',' << green << ',' << blue << ")\" d=\"M" << cx + r0 * std::cos(p0) << ' '
            << cy - r0 * std::sin(p0) << 'L' << cx + r1 * std::cos(p0) << ' ' << cy - r1 * std::sin(p0) << 'L'
            << cx + r1 * std::cos(p1) << ' ' << cy - r1 * std::sin(p1) << 'L' << cx + r0 * std::cos(p1) << ' '
            << cy - r0 * std::sin(p1) << "Z\"/>\n";
      }
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio::proof
