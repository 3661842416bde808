#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/diagram/diagram_fit.h>

namespace gonio {
namespace {

using Axis = std::vector<double>;

// Errors count relative to the density, but to no less than this share of its mean, mass / (range of phi).
constexpr double mean_floor = 1e-3;

/// The function on a tensor grid of reference lines, with the quadrature weight of every axis.
struct Reference {
  Axis phi, r;
  Axis phi_weight, r_weight;  // integrals of the axes' hat functions: dphi and 2 r dr
  std::vector<double> value;  // phi-major
  double floor;               // what a value is at least taken for when errors are put relative to it

  double mass() const { return floor / mean_floor * phi.back(); }
  double at(std::size_t p, std::size_t j) const { return value[p * r.size() + j]; }
};

Axis uniform(double last, std::size_t count) {
  Axis axis(count);
  for (std::size_t k = 0; k < count; ++k) axis[k] = last * static_cast<double>(k) / static_cast<double>(count - 1);
  return axis;
}

Axis hat_weights(const Axis& x, bool radial) {
  Axis weight(x.size(), 0.0);
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double a = x[k], b = x[k + 1], h = b - a;
    weight[k] += radial ? h * (2 * a + b) / 3 : h / 2;
    weight[k + 1] += radial ? h * (a + 2 * b) / 3 : h / 2;
  }
  return weight;
}

Reference tabulate(const DiskDensity& density, Axis phi, Axis r) {
  Reference ref;
  ref.phi = std::move(phi);
  ref.r = std::move(r);
  ref.phi_weight = hat_weights(ref.phi, false);
  ref.r_weight = hat_weights(ref.r, true);
  ref.value.resize(ref.phi.size() * ref.r.size());
  double mass = 0;
  for (std::size_t p = 0; p < ref.phi.size(); ++p) {
    for (std::size_t j = 0; j < ref.r.size(); ++j) {
      const double g = density({ref.r[j], ref.phi[p]});
      const double value = std::isfinite(g) && g > 0 ? g : 0;
      ref.value[p * ref.r.size() + j] = value;
      mass += ref.phi_weight[p] * ref.r_weight[j] * value;
    }
  }
  ref.floor = mean_floor * mass / ref.phi.back();
  return ref;
}

/// Several functions on the same reference grid; those without mass are left out.
using References = std::vector<Reference>;

References tabulate(const std::vector<DiskDensity>& densities, const Axis& phi, const Axis& r) {
  References refs;
  for (const DiskDensity& density : densities) {
    Reference ref = tabulate(density, phi, r);
    if (ref.mass() > 0) refs.push_back(std::move(ref));
  }
  return refs;
}

/// New lines where the functions bend: h ~ (g''^2 / g)^(-1/5) spreads the error of linear
/// interpolation evenly. A share of the lines stays evenly spaced, to see what the last grid missed.
Axis concentrate(const References& refs, bool radial, std::size_t lines_wanted) {
  const Axis& x = radial ? refs.front().r : refs.front().phi;
  const std::size_t count = x.size(), others = radial ? refs.front().phi.size() : refs.front().r.size();
  Axis bend(count, 0.0);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double h0 = x[k] - x[k - 1], h1 = x[k + 1] - x[k];
    for (const Reference& ref : refs) {
      for (std::size_t o = 0; o < others; ++o) {
        const auto g = [&](std::size_t i) { return radial ? ref.at(o, i) : ref.at(i, o); };
        const double second = 2 * ((g(k + 1) - g(k)) / h1 - (g(k) - g(k - 1)) / h0) / (h0 + h1);
        const double weight = radial ? ref.phi_weight[o] * x[k] : ref.r_weight[o];
        bend[k] += weight * second * second / ((g(k) + ref.floor) * ref.mass());
      }
    }
    bend[k] = std::pow(bend[k], 0.2);
  }
  bend.front() = bend[1];
  bend.back() = bend[count - 2];
  // Neighbours widen the peaks: a bend between two lines is seen on either side only.
  Axis density(count);
  double mean = 0;
  for (std::size_t k = 0; k < count; ++k) {
    density[k] = std::max({bend[k], bend[k > 0 ? k - 1 : k], bend[std::min(k + 1, count - 1)]});
    if (k > 0) mean += (x[k] - x[k - 1]) * (density[k - 1] + density[k]) / 2;
  }
  mean /= x.back();
  if (!(mean > 0)) return uniform(x.back(), lines_wanted);
  Axis cumulative(count, 0.0);
  for (std::size_t k = 1; k < count; ++k)
    cumulative[k] = cumulative[k - 1] + (x[k] - x[k - 1]) * ((density[k - 1] + density[k]) / 2 + mean / 2);
  Axis lines(lines_wanted);
  std::size_t k = 0;
  for (std::size_t n = 0; n < lines_wanted; ++n) {
    const double target = cumulative.back() * static_cast<double>(n) / static_cast<double>(lines_wanted - 1);
    while (k + 2 < count && cumulative[k + 1] < target) ++k;
    const double t = (target - cumulative[k]) / (cumulative[k + 1] - cumulative[k]);
    lines[n] = x[k] + std::clamp(t, 0.0, 1.0) * (x[k + 1] - x[k]);
  }
  lines.front() = 0;
  lines.back() = x.back();
  return lines;
}

/// Adds the squared error, relative to the density, of interpolating linearly between the lines a and b,
/// for all pairs, summed over the other axis, as a share of the mass. Running sums make every pair a
/// constant cost.
void add_strip_errors(const Reference& ref, bool radial, std::vector<double>& error) {
  const Axis& x = radial ? ref.r : ref.phi;
  const Axis& weight = radial ? ref.r_weight : ref.phi_weight;
  const Axis& other_weight = radial ? ref.phi_weight : ref.r_weight;
  const std::size_t count = x.size();
  const double scale = 1 / ref.mass();
  // Arrays of sums, not an array of structures: the innermost loop runs on vectors.
  std::vector<double> one(count + 1), sx(count + 1), sxx(count + 1), sg(count + 1), sgx(count + 1), sgg(count + 1),
      line(count);
  for (std::size_t o = 0; o < other_weight.size(); ++o) {
    for (std::size_t k = 0; k < count; ++k) {
      const double gk = line[k] = radial ? ref.at(o, k) : ref.at(k, o);
      const double w = scale * weight[k] * other_weight[o] / (gk + ref.floor), xk = x[k];
      one[k + 1] = one[k] + w, sx[k + 1] = sx[k] + w * xk, sxx[k + 1] = sxx[k] + w * xk * xk;
      sg[k + 1] = sg[k] + w * gk, sgx[k + 1] = sgx[k] + w * gk * xk, sgg[k + 1] = sgg[k] + w * gk * gk;
    }
    for (std::size_t a = 0; a + 2 < count; ++a) {
      const double ga = line[a], xa = x[a];
      const double one_a = one[a + 1], sx_a = sx[a + 1], sxx_a = sxx[a + 1], sg_a = sg[a + 1], sgx_a = sgx[a + 1],
                   sgg_a = sgg[a + 1];
      double* to = error.data() + a * count;
      for (std::size_t b = a + 2; b < count; ++b) {
        const double slope = (line[b] - ga) / (x[b] - xa), start = ga - slope * xa;
        const double e = (sgg[b] - sgg_a) - 2 * start * (sg[b] - sg_a) - 2 * slope * (sgx[b] - sgx_a) +
                         start * start * (one[b] - one_a) + 2 * start * slope * (sx[b] - sx_a) +
                         slope * slope * (sxx[b] - sxx_a);
        to[b] += e > 0 ? e : 0;
      }
    }
  }
}

/// The mean over the functions.
std::vector<double> strip_errors(const References& refs, bool radial) {
  const std::size_t count = radial ? refs.front().r.size() : refs.front().phi.size();
  std::vector<double> error(count * count, 0.0);
  for (const Reference& ref : refs) add_strip_errors(ref, radial, error);
  for (double& e : error) e /= static_cast<double>(refs.size());
  return error;
}

/// For every number of lines up to `most`, the set with the least summed strip error, first and last
/// line among them.
class BestLines {
 public:
  BestLines(const std::vector<double>& error, std::size_t count, std::size_t most)
      : count_(count), from_((most + 1) * count, 0), errors_(most + 1, infinite) {  // one line is no set
    std::vector<double> best(count, infinite), next(count);
    best[0] = 0;
    for (std::size_t lines = 2; lines <= most; ++lines) {
      std::fill(next.begin(), next.end(), infinite);
      for (std::size_t b = lines - 1; b < count; ++b) {
        for (std::size_t a = lines - 2; a < b; ++a) {
          const double e = best[a] + error[a * count + b];
          if (e < next[b]) next[b] = e, from_[lines * count + b] = a;
        }
      }
      best.swap(next);
      errors_[lines] = best[count - 1];
    }
  }

  double error(std::size_t lines) const { return errors_[lines]; }

  std::vector<std::size_t> lines(std::size_t number) const {
    std::vector<std::size_t> result(number);
    result[number - 1] = count_ - 1;
    for (std::size_t n = number; n > 1; --n) result[n - 2] = from_[n * count_ + result[n - 1]];
    return result;
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  std::size_t count_;
  std::vector<std::size_t> from_;
  std::vector<double> errors_;
};

/// The smallest diagram whose errors along both axes stay within `limit` together, else the largest.
std::pair<std::size_t, std::size_t> choose_size(const BestLines& across, std::size_t most_across,
                                                const BestLines& along, std::size_t most_along, double limit) {
  std::pair<std::size_t, std::size_t> best{most_across, most_along};
  if (!(limit > 0)) return best;
  for (std::size_t m = 2; m <= most_across; ++m)
    for (std::size_t n = 2; n <= most_along; ++n)
      if (across.error(m) + along.error(n) <= limit && m * n < best.first * best.second) best = {m, n};
  return best;
}

/// Where each reference line lies between the chosen lines.
struct Position {
  std::size_t cell;
  double s;
};

std::vector<Position> positions(const Axis& x, const std::vector<std::size_t>& lines) {
  std::vector<Position> result(x.size());
  std::size_t cell = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    while (cell + 2 < lines.size() && k >= lines[cell + 1]) ++cell;
    const double a = x[lines[cell]], b = x[lines[cell + 1]];
    result[k] = {cell, (x[k] - a) / (b - a)};
  }
  return result;
}

/// The function at the crossings of the chosen lines; the pole has one value.
DiagramGrid interpolate(const Reference& ref, Azimuth azimuth, const std::vector<std::size_t>& across,
                        const std::vector<std::size_t>& along) {
  const std::size_t m = across.size(), n = along.size();
  DiagramGrid grid;
  grid.azimuth = azimuth;
  for (const std::size_t p : across) grid.phi.push_back(ref.phi[p]);
  for (const std::size_t j : along) grid.r.push_back(ref.r[j]);
  for (const std::size_t p : across)
    for (const std::size_t j : along) grid.density.push_back(ref.at(p, j));
  if (azimuth == Azimuth::full)
    for (std::size_t j = 0; j < n; ++j) grid.at(m - 1, j) = grid.at(0, j);
  double pole = 0;
  for (std::size_t i = 0; i < m; ++i) pole += grid.at(i, 0) / static_cast<double>(m);
  for (std::size_t i = 0; i < m; ++i) grid.at(i, 0) = pole;
  return grid;
}

/// Richardson-Lucy steps on the densities at the crossings. @return the relative variance of sampling
/// the reference by the result.
double fit_densities(const Reference& ref, const std::vector<Position>& across, const std::vector<Position>& along,
                     DiagramGrid& grid) {
  constexpr int steps = 30;
  constexpr double over_relaxation = 1.7;  // converges for any power in (0, 2)
  const std::size_t m = grid.phi.size(), n = grid.r.size();
  for (double& d : grid.density) d = std::max(d, ref.floor);
  std::vector<double> ratio(m * n), support(m * n, 0.0), row(n), row_ratio(n);
  for (std::size_t p = 0; p < ref.phi.size(); ++p) {
    const auto [i, a] = across[p];
    for (std::size_t j = 0; j < ref.r.size(); ++j) {
      const auto [k, s] = along[j];
      const double weight = ref.phi_weight[p] * ref.r_weight[j];
      support[i * n + k] += weight * (1 - a) * (1 - s), support[i * n + k + 1] += weight * (1 - a) * s;
      support[(i + 1) * n + k] += weight * a * (1 - s), support[(i + 1) * n + k + 1] += weight * a * s;
    }
  }
  for (int step = 0;; ++step) {
    double mass = 0, model_mass = 0, square = 0;
    std::fill(ratio.begin(), ratio.end(), 0.0);
    for (std::size_t p = 0; p < ref.phi.size(); ++p) {
      const auto [i, a] = across[p];
      const double *d0 = grid.density.data() + i * n, *d1 = d0 + n;
      for (std::size_t k = 0; k < n; ++k) row[k] = (1 - a) * d0[k] + a * d1[k];
      std::fill(row_ratio.begin(), row_ratio.end(), 0.0);
      for (std::size_t j = 0; j < ref.r.size(); ++j) {
        const auto [k, s] = along[j];
        const double model = (1 - s) * row[k] + s * row[k + 1];
        const double weight = ref.phi_weight[p] * ref.r_weight[j];
        const double g = ref.at(p, j), q = model > 0 ? g / model : 0;
        mass += weight * g;
        model_mass += weight * model;
        square += weight * g * q;
        row_ratio[k] += weight * (1 - s) * q;
        row_ratio[k + 1] += weight * s * q;
      }
      double *r0 = ratio.data() + i * n, *r1 = r0 + n;
      for (std::size_t k = 0; k < n; ++k) r0[k] += (1 - a) * row_ratio[k], r1[k] += a * row_ratio[k];
    }
    if (step == steps) return square * model_mass / (mass * mass) - 1;
    const auto share = [](std::vector<double>& values, std::size_t x, std::size_t y) {
      values[x] = values[y] = values[x] + values[y];
    };
    const std::size_t distinct = grid.azimuth == Azimuth::full ? m - 1 : m;
    for (std::vector<double>* values : {&ratio, &support}) {
      if (values == &support && step > 0) break;  // shared already
      if (grid.azimuth == Azimuth::full)          // the seam is one meridian
        for (std::size_t k = 0; k < n; ++k) share(*values, k, (m - 1) * n + k);
      double pole = 0;
      for (std::size_t i = 0; i < distinct; ++i) pole += (*values)[i * n];
      for (std::size_t i = 0; i < m; ++i) (*values)[i * n] = pole;
    }
    for (std::size_t c = 0; c < m * n; ++c)
      if (support[c] > 0) grid.density[c] *= std::pow(ratio[c] / support[c], over_relaxation);
  }
}

/// Steps 1 and 2: the reference grid of some densities, and for every number of lines the best set.
struct Lines {
  Azimuth azimuth;
  std::size_t most_across, most_along;
  References refs;  // of the densities with mass
  BestLines across, along;
};

std::optional<Lines> prepare(const std::vector<DiskDensity>& densities, Azimuth azimuth, int meridians, int parallels) {
  if (meridians < 2 || parallels < 2)
    throw Error("diagram fit: found a size of " + std::to_string(meridians) + " x " + std::to_string(parallels) +
                ", expected at least 2 x 2");
  const std::size_t most_m = static_cast<std::size_t>(meridians), most_n = static_cast<std::size_t>(parallels);
  const double range = azimuth == Azimuth::half ? pi<double> : 2 * pi<double>;
  References refs = tabulate(densities, uniform(range, 65), uniform(1.0, 129));
  const auto refine = [&](std::size_t columns, std::size_t rows) {
    if (refs.empty()) return;
    const Axis phi = concentrate(refs, false, columns), r = concentrate(refs, true, rows);
    refs = tabulate(densities, phi, r);
  };
  refine(65, 129);
  refine(std::max<std::size_t>(97, 3 * most_m + 1), std::max<std::size_t>(129, 4 * most_n + 1));
  if (refs.empty()) return std::nullopt;
  BestLines across(strip_errors(refs, false), refs.front().phi.size(), most_m);
  BestLines along(strip_errors(refs, true), refs.front().r.size(), most_n);
  return Lines{azimuth, most_m, most_n, std::move(refs), std::move(across), std::move(along)};
}

struct Fit {
  SharedLines lines;
  std::vector<DiagramGrid> grids;  // one per reference
};

/// Step 3 on growing sizes, until no density is further off than `tolerance`.
Fit fit(const Lines& prepared, double tolerance) {
  const Axis &phi = prepared.refs.front().phi, &r = prepared.refs.front().r;
  // What the strip errors promise and what the fit reaches differ by the material; the first guess
  // is that the fit leaves a sixth.
  double gain = 6;
  for (;;) {
    const auto [m, n] =
        choose_size(prepared.across, prepared.most_across, prepared.along, prepared.most_along, gain * tolerance);
    Fit result{{prepared.azimuth, phi, r, prepared.across.lines(m), prepared.along.lines(n)}, {}};
    const SharedLines& lines = result.lines;
    const auto across = positions(phi, lines.across), along = positions(r, lines.along);
    double relvar = 0;  // the largest
    for (const Reference& ref : prepared.refs) {
      DiagramGrid grid = interpolate(ref, prepared.azimuth, lines.across, lines.along);
      relvar = std::max(relvar, fit_densities(ref, across, along, grid));
      result.grids.push_back(std::move(grid));
    }
    if (relvar <= tolerance || (m == prepared.most_across && n == prepared.most_along)) return result;
    gain *= std::min(0.8, tolerance / relvar);
  }
}

}  // namespace

DiagramGrid fit_diagram(const DiskDensity& density, Azimuth azimuth, const FitLimits& limits) {
  if (const auto prepared = prepare({density}, azimuth, limits.meridians, limits.parallels))
    return std::move(fit(*prepared, limits.tolerance).grids.front());
  return {azimuth, {0, azimuth == Azimuth::half ? pi<double> : 2 * pi<double>}, {0, 1}, {0, 0, 0, 0}};
}

struct LineFit::Prepared {
  Lines lines;
};

LineFit::LineFit(const std::vector<DiskDensity>& densities, Azimuth azimuth, int most_meridians, int most_parallels) {
  auto prepared = prepare(densities, azimuth, most_meridians, most_parallels);
  if (!prepared) throw Error("diagram fit: found densities of 0 everywhere, expected some mass");
  prepared_ = std::make_unique<const Prepared>(Prepared{std::move(*prepared)});
}

LineFit::~LineFit() = default;
LineFit::LineFit(LineFit&&) noexcept = default;

SharedLines LineFit::lines(double tolerance) const { return fit(prepared_->lines, tolerance).lines; }

DiagramGrid fit_diagram(const DiskDensity& density, const SharedLines& lines) {
  const Reference ref = tabulate(density, lines.phi, lines.r);
  DiagramGrid grid = interpolate(ref, lines.azimuth, lines.across, lines.along);
  if (ref.mass() > 0) fit_densities(ref, positions(lines.phi, lines.across), positions(lines.r, lines.along), grid);
  return grid;
}

}  // namespace gonio
