#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/diagram/light_diagram.h>
#include <gonio/mapping/light/diagram/unfold.h>

namespace gonio {
namespace {

constexpr double tau = 2 * pi<double>;

/// The cell of ascending `lines` that holds t, and the position in it.
struct Position {
  std::size_t cell;
  double fraction;
};

Position locate(const std::vector<double>& lines, double t) {
  const auto after = std::upper_bound(lines.begin() + 1, lines.end() - 1, t);
  const std::size_t cell = static_cast<std::size_t>(after - lines.begin()) - 1;
  return {cell, std::clamp((t - lines[cell]) / (lines[cell + 1] - lines[cell]), 0.0, 1.0)};
}

double wrapped(double c) noexcept {
  const double turned = c - tau * std::floor(c / tau);
  return turned < tau ? turned : 0;
}

/// Integral of (a + (b - a) (g - g0)/(g1 - g0)) sin g over [g0, g1], without the cancellation of
/// differences of cosines in narrow cells.
double sine_moment(double g0, double g1, double a, double b) {
  const double half = (g1 - g0) / 2, middle = (g0 + g1) / 2;
  const double mean = (a + b) / 2, slope = (b - a) / 2;
  // (sin h - h cos h) / h, as a series where it cancels.
  const double odd =
      half > 1e-2 ? (std::sin(half) - half * std::cos(half)) / half : half * half / 3 * (1 - half * half / 10);
  return 2 * (mean * std::sin(half) * std::sin(middle) + slope * odd * std::cos(middle));
}

/// The distribution on lines every `step` of a frame with another axis. Where it ends abruptly at
/// the horizon, as files of type B do whose planes end there, a parallel beside it keeps the edge.
LightDiagram tabulated(const LightDiagram& d, const LightFrame& frame, double step) {
  LightDiagram result;
  result.frame = frame;
  const int quarter = std::max(1, static_cast<int>(std::lround(pi<double> / 2 / step)));
  for (int i = 0; i <= 4 * quarter; ++i) result.c.push_back(pi<double> / 2 * i / quarter);
  const auto jumps = [&](double gamma) {
    const double slack = 1e-3 * max_intensity(d);
    return std::any_of(result.c.begin(), result.c.end(), [&](double c) {
      return std::abs(d.intensity(frame.direction(c, gamma)) - d.intensity(frame.direction(c, pi<double> / 2))) > slack;
    });
  };
  for (int j = 0; j <= 2 * quarter; ++j) {
    const double before = pi<double> / 2 - edge_width, after = pi<double> / 2 + edge_width;
    if (j == quarter && jumps(before)) result.gamma.push_back(before);
    result.gamma.push_back(pi<double> / 2 * j / quarter);
    if (j == quarter && jumps(after)) result.gamma.push_back(after);
  }
  for (std::size_t i = 0; i < result.c.size(); ++i)
    for (double gamma : result.gamma) {
      // One value at the poles and at both ends of the turn, whatever rounding does.
      const bool pole = gamma == 0 || gamma == result.gamma.back();
      const double c = pole || i + 1 == result.c.size() ? 0 : result.c[i];
      result.cd.push_back(d.intensity(frame.direction(c, gamma)));
    }
  return result;
}

}  // namespace

Vec3<double> LightFrame::direction(double c, double gamma) const noexcept {
  const double s = std::sin(gamma);
  return std::cos(gamma) * nadir + s * std::cos(c) * c0 + s * std::sin(c) * c90;
}

LightAngles to_light_angles(const LightFrame& frame, const Vec3<double>& w) noexcept {
  const double x = glm::dot(w, frame.c0), y = glm::dot(w, frame.c90);
  const double c = std::atan2(y, x);
  return {c < 0 ? std::min(c + tau, std::nextafter(tau, 0.0)) : c,
          std::atan2(std::sqrt(x * x + y * y), glm::dot(w, frame.nadir))};
}

double LightDiagram::intensity(LightAngles angles) const noexcept {
  // A direction that was computed may miss the end of a hemisphere by rounding.
  if (angles.gamma < gamma.front() - 1e-12 || angles.gamma > gamma.back() + 1e-12) return 0;
  const Position p = locate(c, wrapped(angles.c)), q = locate(gamma, angles.gamma);
  const double low = (1 - q.fraction) * at(p.cell, q.cell) + q.fraction * at(p.cell, q.cell + 1);
  const double high = (1 - q.fraction) * at(p.cell + 1, q.cell) + q.fraction * at(p.cell + 1, q.cell + 1);
  return (1 - p.fraction) * low + p.fraction * high;
}

double LightDiagram::intensity(const Vec3<double>& direction) const noexcept {
  return intensity(to_light_angles(frame, direction));
}

void check(const LightDiagram& d) {
  const auto fail = [](const std::string& what) { throw Error("light diagram: " + what); };
  const auto ascending = [](const std::vector<double>& x) {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!std::isfinite(x[i]) || (i > 0 && !(x[i] > x[i - 1]))) return false;
    return x.size() >= 2;
  };
  const auto is = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  if (!ascending(d.c) || !is(d.c.front(), 0) || !is(d.c.back(), tau))
    fail("c: expected at least 2 ascending meridians from 0 to 2 pi");
  if (!ascending(d.gamma) || !(is(d.gamma.front(), 0) || is(d.gamma.front(), pi<double> / 2)) ||
      !(is(d.gamma.back(), pi<double>) || is(d.gamma.back(), pi<double> / 2)))
    fail("gamma: expected at least 2 ascending parallels from 0 or pi/2 to pi/2 or pi");
  if (d.cd.size() != d.c.size() * d.gamma.size())
    fail("cd: found " + std::to_string(d.cd.size()) + " values, expected " +
         std::to_string(d.c.size() * d.gamma.size()));
  for (double value : d.cd)
    if (!std::isfinite(value) || value < 0)
      fail("cd: found " + std::to_string(value) + ", expected finite values >= 0");
  for (std::size_t j = 0; j < d.gamma.size(); ++j)
    if (d.at(0, j) != d.at(d.c.size() - 1, j))
      fail(
          "cd: the last meridian differs from the first, expected the same values at C = 0 and 2 "
          "pi");
}

double max_intensity(const LightDiagram& d) noexcept { return *std::max_element(d.cd.begin(), d.cd.end()); }

double flux(const LightDiagram& d, double gamma_from, double gamma_to) noexcept {
  double total = 0;
  for (std::size_t j = 0; j + 1 < d.gamma.size(); ++j) {
    const double g0 = std::max(d.gamma[j], gamma_from), g1 = std::min(d.gamma[j + 1], gamma_to);
    if (!(g1 > g0)) continue;
    const double width = d.gamma[j + 1] - d.gamma[j];
    const double t0 = (g0 - d.gamma[j]) / width, t1 = (g1 - d.gamma[j]) / width;
    double low = 0, high = 0;  // integrals over C of the two parallels: trapezoids are exact
    for (std::size_t i = 0; i + 1 < d.c.size(); ++i) {
      const double turn = (d.c[i + 1] - d.c[i]) / 2;
      low += turn * (d.at(i, j) + d.at(i + 1, j));
      high += turn * (d.at(i, j + 1) + d.at(i + 1, j + 1));
    }
    total += sine_moment(g0, g1, (1 - t0) * low + t0 * high, (1 - t1) * low + t1 * high);
  }
  return total;
}

LightDiagram with_parallel(const LightDiagram& d, double gamma) {
  if (gamma <= d.gamma.front() || gamma >= d.gamma.back()) return d;
  const Position q = locate(d.gamma, gamma);
  for (double line : {d.gamma[q.cell], d.gamma[q.cell + 1]})
    if (std::abs(line - gamma) < 1e-9) return d;
  LightDiagram result = d;
  result.gamma.insert(result.gamma.begin() + static_cast<std::ptrdiff_t>(q.cell) + 1, gamma);
  result.cd.clear();
  for (std::size_t i = 0; i < d.c.size(); ++i)
    for (std::size_t j = 0; j < d.gamma.size(); ++j) {
      result.cd.push_back(d.at(i, j));
      if (j == q.cell) result.cd.push_back((1 - q.fraction) * d.at(i, j) + q.fraction * d.at(i, j + 1));
    }
  return result;
}

LightDiagram without_dark_hemisphere(const LightDiagram& diagram) {
  constexpr double half = pi<double> / 2;
  const LightDiagram whole = with_parallel(diagram, half);
  const auto equator_at =
      std::find_if(whole.gamma.begin(), whole.gamma.end(), [](double g) { return std::abs(g - half) < 1e-9; });
  const std::size_t n = whole.gamma.size();
  const std::size_t equator = static_cast<std::size_t>(equator_at - whole.gamma.begin());
  if (equator == 0 || equator >= n - 1) return diagram;  // one hemisphere already
  const auto dark = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = 0; i < whole.c.size(); ++i)
      for (std::size_t j = from; j <= to; ++j)
        if (whole.at(i, j) != 0) return false;
    return true;
  };
  const bool dark_above = dark(equator, n - 1), dark_below = dark(0, equator);
  if (!dark_above && !dark_below) return diagram;
  const std::size_t from = dark_above ? 0 : equator, to = dark_above ? equator : n - 1;
  LightDiagram result;
  result.frame = whole.frame;
  result.c = whole.c;
  result.gamma.assign(whole.gamma.begin() + static_cast<std::ptrdiff_t>(from),
                      whole.gamma.begin() + static_cast<std::ptrdiff_t>(to) + 1);
  for (std::size_t i = 0; i < whole.c.size(); ++i)
    for (std::size_t j = from; j <= to; ++j) result.cd.push_back(whole.at(i, j));
  return result;
}

LightDiagram in_frame(const LightDiagram& d, const LightFrame& frame, double step) {
  if (glm::dot(d.frame.nadir, frame.nadir) < 1 - 1e-12) return tabulated(d, frame, step);
  LightDiagram result;
  result.frame = frame;
  result.gamma = d.gamma;
  if (d.rotational()) {
    result.c = d.c;
    result.cd = d.cd;
    return result;
  }
  // Same axis: C changes its zero, and its sense if one frame is left-handed.
  struct Meridian {
    double c;
    std::size_t from;
  };
  std::vector<Meridian> meridians;
  for (std::size_t i = 0; i + 1 < d.c.size(); ++i) {
    const Vec3<double> out = d.frame.direction(d.c[i], pi<double> / 2);
    double c = to_light_angles(frame, out).c;
    if (std::abs(c - tau) < 1e-9 || c < 1e-9) c = 0;
    meridians.push_back({c, i});
  }
  std::sort(meridians.begin(), meridians.end(), [](const Meridian& a, const Meridian& b) { return a.c < b.c; });
  const std::size_t n = d.gamma.size();
  const auto append = [&](double c, auto value) {
    result.c.push_back(c);
    for (std::size_t j = 0; j < n; ++j) result.cd.push_back(value(j));
  };
  if (meridians.front().c > 0) {  // the new C0 lies between two meridians
    const LightAngles zero = to_light_angles(d.frame, frame.c0);
    append(0, [&](std::size_t j) { return d.intensity({zero.c, d.gamma[j]}); });
  }
  for (const Meridian& m : meridians) append(m.c, [&](std::size_t j) { return d.at(m.from, j); });
  append(tau, [&](std::size_t j) { return result.cd[j]; });
  return result;
}

}  // namespace gonio
