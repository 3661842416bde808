#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio::proof {
namespace {

using Lines = std::vector<double>;

Lines even(double last, int count) {
  Lines x;
  for (int k = 0; k < count; ++k) x.push_back(last * k / (count - 1));
  x.back() = last;
  return x;
}

/// Lines crowded at 0 by a power.
Lines crowded(double last, int count, double power) {
  Lines x = even(1, count);
  for (double& v : x) v = last * std::pow(v, power);
  return x;
}

/// Irregular lines, every third of them doubled by one that is `gap` further.
Lines doubled(double last, int count, double gap) {
  Lines x = crowded(last, count, 1.3);
  for (int k = 1; k + 1 < count; k += 3) x.push_back(x[static_cast<std::size_t>(k)] + gap);
  std::sort(x.begin(), x.end());
  return x;
}

/// The density at a crossing: theta_i, r, phi, and the numbers of the meridian and the parallel.
struct Crossing {
  std::size_t diagram, meridian, parallel;
  double theta_i, r, phi;
};
using Function = std::function<double(const Crossing&)>;

StackGrid stack(const Function& density, const Lines& phi, const Lines& r) {
  StackGrid grid;
  for (const double theta_i : gallery_angles) {
    DiagramGrid d;
    d.azimuth = phi.back() > 1.5 * pi<double> ? Azimuth::full : Azimuth::half;
    d.phi = phi;
    d.r = r;
    for (std::size_t i = 0; i < phi.size(); ++i)
      for (std::size_t j = 0; j < r.size(); ++j)
        d.density.push_back(density({grid.theta_i.size(), i, j, theta_i, r[j], phi[i]}));
    if (d.azimuth == Azimuth::full)
      for (std::size_t j = 0; j < r.size(); ++j) d.at(phi.size() - 1, j) = d.at(0, j);
    for (std::size_t i = 1; i < phi.size(); ++i) d.at(i, 0) = d.at(0, 0);  // the pole is one direction
    grid.theta_i.push_back(theta_i);
    grid.diagrams.push_back(std::move(d));
  }
  return grid;
}

/// A lobe about (r, phi) on the flattened hemisphere, 1 at its centre.
double lobe(const Crossing& at, double r, double phi, double width) {
  const double dx = at.r * std::cos(at.phi) - r * std::cos(phi), dy = at.r * std::sin(at.phi) - r * std::sin(phi);
  return std::exp(-(dx * dx + dy * dy) / (width * width));
}

MbsdfFile table(const std::function<double(double theta_in, double theta_out, double phi)>& f) {
  MbsdfFile file;
  file.n_theta_in = file.n_theta_out = 24;
  file.n_phi = 24;
  const auto centre = [](int k, double range) { return (k + 0.5) / 24 * range; };
  for (int i = 0; i < 24; ++i)
    for (int o = 0; o < 24; ++o)
      for (int p = 0; p < 24; ++p) {
        const auto value =
            static_cast<float>(f(centre(i, pi<double> / 2), centre(o, pi<double> / 2), centre(p, pi<double>)));
        file.values.insert(file.values.end(), {value, value, value});
      }
  return file;
}

double table_lobe(double theta, double phi, double theta0, double phi0, double width) {
  const double dx = std::sin(theta) * std::cos(phi) - std::sin(theta0) * std::cos(phi0);
  const double dy = std::sin(theta) * std::sin(phi) - std::sin(theta0) * std::sin(phi0);
  return std::exp(-(dx * dx + dy * dy) / (width * width));
}

}  // namespace

bool shared_lines(const StackGrid& grid) {
  return std::all_of(grid.diagrams.begin(), grid.diagrams.end(),
                     [&](const DiagramGrid& d) { return d.phi == grid.diagrams[0].phi && d.r == grid.diagrams[0].r; });
}

std::vector<GalleryStack> gallery_stacks() {
  const Lines phi = even(pi<double>, 13), r = even(1, 17);
  // A lobe in the mirror direction over a floor, for the entries that need something ordinary around.
  const auto ordinary = [](const Crossing& c) { return lobe(c, theta_to_radius(c.theta_i), pi<double>, 0.3) + 0.1; };
  const auto zero_where = [&](const std::function<bool(const Crossing&)>& zero) {
    return [=](const Crossing& c) { return zero(c) ? 0.0 : ordinary(c); };
  };
  std::vector<GalleryStack> g;
  const auto add = [&](const char* name, const char* reason, StackGrid grid, bool zero_regions = false) {
    g.push_back({name, reason, std::move(grid), zero_regions});
  };

  add("constant", "the map is the identity, every root formula divides by a difference that is 0",
      stack([](const Crossing&) { return 1.0; }, phi, r));
  add("ramp-r", "mass r^3: closed form; no density at the pole", stack([](const Crossing& c) { return c.r; }, phi, r));
  add("ramp-phi", "mass phi^2: closed form; hardly any density on the first meridian",
      stack([](const Crossing& c) { return c.phi + 0.05; }, phi, r));
  add("ramp-horizon", "what every cosine does: 0 on the last parallel",
      stack([](const Crossing& c) { return 1 - c.r; }, phi, r));
  add("zero-corner", "one crossing without density: slopes of the map are infinite in one point",
      stack(zero_where([](const Crossing& c) { return c.meridian == 5 && c.parallel == 8; }), phi, r));
  add("zero-edge", "two neighbouring crossings: infinite slopes along an edge",
      stack(zero_where([](const Crossing& c) { return c.meridian == 5 && (c.parallel == 8 || c.parallel == 9); }), phi,
            r));
  add("zero-patch", "a patch that must never be drawn (Fig. 6d)",
      stack(zero_where([](const Crossing& c) {
              return c.meridian >= 5 && c.meridian <= 7 && c.parallel >= 8 && c.parallel <= 10;
            }),
            phi, r),
      true);
  add("zero-patch-sometimes", "a patch in every other diagram: displacement meets a jump in one of its two maps",
      stack(zero_where([](const Crossing& c) {
              return c.diagram % 2 == 1 && c.meridian >= 5 && c.meridian <= 7 && c.parallel >= 8 && c.parallel <= 10;
            }),
            phi, r),
      true);
  add("zero-meridian",
      "a marginal of 0 (and so is the pole): the conditional is 0/0 there, and jumps from one side to the other",
      stack(zero_where([](const Crossing& c) { return c.meridian == 6 || c.parallel == 0; }), phi, r), true);
  add("zero-parallel", "a ring without density, of measure 0",
      stack(zero_where([](const Crossing& c) { return c.parallel == 8; }), phi, r));
  add("zero-sector", "two neighbouring meridians without density: the marginal has a gap",
      stack(zero_where([](const Crossing& c) { return c.parallel == 0 || (c.meridian >= 5 && c.meridian <= 7); }), phi,
            r),
      true);
  add("spike", "one crossing 10^4 above the rest: nearly all (u, v) in four cells",
      stack([](const Crossing& c) { return c.meridian == 4 + c.diagram && c.parallel == 9 ? 1e4 : 1.0; }, phi, r),
      true);
  Random random(12);
  const auto decades = [&](const Crossing&) { return std::pow(10.0, -12.0 * random()); };
  add("decades", "twelve decades at random: sums that swallow, differences that cancel", stack(decades, phi, r), true);
  add("two-lines", "the smallest diagram: two meridians, two parallels",
      stack([](const Crossing& c) { return 1 + c.phi / 2 + (2 - c.theta_i) * c.r; }, {0, pi<double>}, {0, 1}));
  add("coincident-lines", "irregular lines, some 4e-6 apart: widths of a few ulp",
      stack(ordinary, doubled(pi<double>, 13, 4e-6), doubled(1, 15, 4e-6)));
  add("ring", "a narrow ring about the pole, where phi means little",
      stack([](const Crossing& c) { return std::exp(-std::pow((c.r - 0.06 - 0.02 * c.theta_i) / 0.02, 2)) + 1e-3; },
            phi, crowded(1, 25, 2.5)));
  add("seam", "a lobe across phi = 0 = 2 pi of a full diagram",
      stack([](const Crossing& c) { return lobe(c, 0.3 + 0.3 * c.theta_i, 0.1, 0.15) + 0.01; },
            even(2 * pi<double>, 33), r));
  add("horizon", "a lobe cut by the horizon",
      stack([](const Crossing& c) { return lobe(c, 1, pi<double> - 0.2 * c.theta_i, 0.15) + 0.01; }, phi, r));
  add("rotating", "a lobe that goes around with theta_i: displacement's worst case",
      stack([](const Crossing& c) { return lobe(c, 0.6, 0.2 + 2 * c.theta_i, 0.2) + 0.01; }, even(pi<double>, 21), r));
  add("retro", "a lobe back to the source, at phi = 0",
      stack([](const Crossing& c) { return lobe(c, theta_to_radius(c.theta_i), 0, 0.12) + 0.01; },
            crowded(pi<double>, 17, 1.5), r));
  add("specular", "a lobe in the mirror direction that leaves the pole", stack(ordinary, phi, r));
  Random noise(5);
  add("noise", "white noise: no two cells alike", stack([&](const Crossing&) { return noise() + 0.05; }, phi, r));
  StackGrid one = g.back().grid;
  one.theta_i.resize(1);
  one.diagrams.resize(1);
  add("one-diagram", "nothing to interpolate at any angle", std::move(one));
  return g;
}

std::vector<GalleryTable> gallery_tables() {
  std::vector<GalleryTable> g;
  const auto add = [&](const char* name, const char* reason, MbsdfFile file, bool zero_regions = false) {
    g.push_back({name, reason, std::move(file), zero_regions});
  };
  add("lambert", "albedo exactly 0.5: every factor of pi, cosine and 2 shows",
      table([](double, double, double) { return 0.5 / pi<double>; }));
  add("zero-table", "reflects nothing: no density to scale, weights are 0",
      table([](double, double, double) { return 0.0; }));
  add("zero-diagram", "reflects nothing at some incident angles, something at their neighbours",
      table([](double i, double, double) { return i > 0.6 && i < 0.9 ? 0.0 : 0.3; }), true);
  add("zero-half", "reflects nothing on one side: f_r is 0 over half of the hemisphere",
      table([](double, double, double phi) { return phi < pi<double> / 2 ? 0.0 : 0.3; }), true);
  add("spike", "one cell 10^3 above the rest at every incident angle", table([n = 0](double, double, double) mutable {
        const int k = n++ % (24 * 24);
        return k == 9 * 24 + 15 ? 200.0 : 0.2;
      }));
  add("retro", "reflects back to the source",
      table([](double i, double o, double phi) { return 3 * table_lobe(o, phi, i, 0, 0.2) + 0.02; }));
  add("specular", "a glossy lobe in the mirror direction, strong near the horizon",
      table([](double i, double o, double phi) { return 3 * table_lobe(o, phi, i, pi<double>, 0.2) + 0.02; }));
  add("horizon", "a lobe that stays at the horizon",
      table([](double, double o, double phi) { return 3 * table_lobe(o, phi, 1.5, 2.5, 0.3) + 0.02; }));
  add("rotating", "a lobe that goes around with theta_i",
      table([](double i, double o, double phi) { return 3 * table_lobe(o, phi, 0.8, 0.2 + 1.7 * i, 0.3) + 0.02; }));
  add("asymmetric", "f_r(wi, wo) is far from f_r(wo, wi): swapped arguments show",
      table(
          [](double i, double o, double phi) { return 0.05 + 0.3 * (pi<double> / 2 - i) * o + 0.05 * std::cos(phi); }));
  Random random(3);
  add("noise", "white noise over three decades",
      table([&](double, double, double) { return std::pow(10.0, -3.0 * random()); }));
  MbsdfFile bad = table([](double, double o, double) { return 0.2 + 0.1 * o; });
  for (std::size_t k = 0; k < bad.values.size(); ++k) {
    if (k % 97 == 0) bad.values[k] = -0.1f;
    if (k % 101 == 0) bad.values[k] = std::numeric_limits<float>::quiet_NaN();
    if (k % 103 == 0) bad.values[k] = std::numeric_limits<float>::infinity();
  }
  add("bad-cells", "negative, NaN and infinite cells among good ones", std::move(bad));
  return g;
}

BrdfTable to_table(const GalleryTable& entry) {
  return BrdfTable(MbsdfTable(entry.file),
                   {entry.name, entry.name, "mbsdf", entry.reason, entry.file.values.size() * sizeof(float), {}});
}

}  // namespace gonio::proof
