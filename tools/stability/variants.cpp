#include "tools/stability/variants.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <gonio/mapping/stack/stack.h>

#include "tools/stability/textbook.h"

namespace gonio {
namespace {

using Wide = long double;
using Draw = Variant::Draw;

constexpr double ulp = std::numeric_limits<float>::epsilon();
/// The bounds that the headers of mapping/ state.
constexpr double map_bound = 16, radius_bound = 4;
/// Densities of Displacement are quotients of differences of two maps: 1e-4, the same that is asked of
/// its round trip.
constexpr double pdf_bound = 1e-4 / ulp;
constexpr float theta0 = 0.5f, theta1 = 0.9f, theta_i = 0.66f;

const char* const mass_below = "mass below the answer";
const char* const claimed_pdf = "pdf claimed";
const char* const radius_read = "radius of the direction";

/// The whole disk from the stored azimuth: half diagrams serve u > 1/2 by their mirror image.
struct Unfolded {
  float u;
  bool mirrored;
};
Unfolded unfold(float u, Azimuth azimuth) {
  if (azimuth == Azimuth::full) return {u, false};
  return u <= 0.5f ? Unfolded{2 * u, false} : Unfolded{2 * (1 - u), true};
}

template <class T>
Polar<T> fold(Polar<T> p, Azimuth azimuth) {
  if (azimuth == Azimuth::half)
    p.phi = std::abs(p.phi);
  else if (p.phi < 0)
    p.phi += 2 * pi<T>;
  return p;
}

/// The position of a direction in T, whatever the length that rounding left it.
template <class T>
Polar<T> polar_of(const glm::vec3& w) {
  const T x = w.x, y = w.y, z = w.z, length = std::sqrt(x * x + y * y + z * z);
  return {std::sqrt((x * x + y * y) / (length * (length + z))), std::atan2(y, x)};
}

/// The distance of x from the values that `exact` takes at the given points, in ulp of `unit`.
double distance(Wide x, std::initializer_list<Wide> exact, Wide unit) {
  const auto [low, high] = std::minmax(exact);
  if (!std::isfinite(x)) return no_digit;
  const Wide d = x < low ? low - x : x > high ? x - high : Wide(0);
  return d == 0 ? 0 : std::min(static_cast<double>(d / unit) / ulp, 1e12);
}

/// What all variants of an input share.
struct Problem {
  explicit Problem(const StabilityInput& input)
      : azimuth(input.first.azimuth),
        diagram(input.first),
        other(input.second),
        middle(diagram.grid()),
        middle_other(other.grid()),
        exact(diagram.grid()),
        arrays(diagram.grid()),
        float_cells(arrays),
        exact_cells(arrays) {
    const std::size_t n = arrays.r.size();
    std::vector<Wide> theta;
    for (const float r : arrays.r) theta.push_back(radius_to_theta(Wide(r)));
    for (std::size_t i = 0; i < arrays.phi.size(); ++i) {
      Wide mass = 0;
      for (std::size_t j = 0; j + 1 < n; ++j) {  // of (d0 + (d1 - d0)(t - t0)/(t1 - t0)) sin t
        const Wide t0 = theta[j], t1 = theta[j + 1], slope = (Wide(arrays.at(i, j + 1)) - arrays.at(i, j)) / (t1 - t0);
        mass += arrays.at(i, j) * (std::cos(t0) - std::cos(t1)) +
                slope * (std::sin(t1) - std::sin(t0) - (t1 - t0) * std::cos(t1));
      }
      const Wide left = i > 0 ? arrays.phi[i] - Wide(arrays.phi[i - 1]) : Wide(0);
      const Wide right = i + 1 < arrays.phi.size() ? arrays.phi[i + 1] - Wide(arrays.phi[i]) : Wide(0);
      theta_linear_mass += mass * (left + right) / 2 * (azimuth == Azimuth::half ? 2 : 1);
    }
  }

  /// The pdf of the diagram as stored.
  Wide density(Polar<Wide> p) const { return exact.pdf(fold(p, azimuth)); }
  double density(const glm::vec3& w) const { return middle.pdf(fold(polar_of<double>(w), azimuth)); }
  /// The blend of the pdfs of both diagrams.
  double blend(const glm::vec3& w) const {
    const Polar<double> p = fold(polar_of<double>(w), azimuth);
    return (1 - alpha) * middle.pdf(p) + alpha * middle_other.pdf(p);
  }

  /// The density that is linear in theta between the parallels (eq. 4), normalised.
  double theta_linear(const glm::vec3& w) const {
    const Polar<double> p = fold(polar_of<double>(w), azimuth);
    const auto cell = [](const std::vector<float>& x, double t) {
      return static_cast<std::size_t>(find_cell(x.data(), static_cast<int>(x.size()), static_cast<float>(t)));
    };
    const std::size_t i = cell(arrays.phi, p.phi), j = cell(arrays.r, p.r);
    const double a = (p.phi - arrays.phi[i]) / (double(arrays.phi[i + 1]) - arrays.phi[i]);
    const double t0 = radius_to_theta(double(arrays.r[j])), t1 = radius_to_theta(double(arrays.r[j + 1]));
    const double s = (radius_to_theta(std::min(p.r, 1.0)) - t0) / (t1 - t0);
    const auto along = [&](std::size_t k) { return (1 - s) * arrays.at(k, j) + s * arrays.at(k, j + 1); };
    return std::max(((1 - a) * along(i) + a * along(i + 1)) / static_cast<double>(theta_linear_mass), 0.0);
  }

  Azimuth azimuth;
  Diagram<float> diagram, other;
  Diagram<double> middle, middle_other;
  Diagram<Wide> exact;
  textbook::Arrays arrays;
  textbook::ConstantCells<float> float_cells;
  textbook::ConstantCells<double> exact_cells;
  Wide theta_linear_mass = 0;
  static constexpr double alpha = (double(theta_i) - theta0) / (double(theta1) - theta0);
};
using Shared = std::shared_ptr<const Problem>;

/// Backward error of a position of the diagram: how far the mass below it is from the mass asked for, of
/// the whole. Rounding of the position itself to the next float is not counted.
double mass_error(const Problem& p, float u, float v, Polar<float> at) {
  if (!std::isfinite(at.r) || !std::isfinite(at.phi)) return no_digit;
  const Diagram<Wide>& d = p.exact;
  const Wide phi = at.phi, r = at.r, dphi = phi * ulp, dr = r * ulp;
  const auto inverse = [&](int i, int j) { return d.invert({r + i * dr, phi + j * dphi}); };
  const auto first = inverse(-1, -1), last = inverse(1, 1);
  const double in_u = distance(u, {first.u, last.u}, 1);
  const double in_v =
      distance(v, {first.v, inverse(1, -1).v, inverse(-1, 0).v, inverse(1, 0).v, inverse(-1, 1).v, last.v}, 1);
  return std::max(in_u, in_v);
}

/// Relative error of a claimed pdf against a density: at the direction, or within what rounding leaves
/// of its position (radius_bound in r, as much in phi), or among `images`.
template <class Density>
double pdf_error(double claimed, const glm::vec3& w, const Density& density, std::initializer_list<Wide> images = {}) {
  if (!std::isfinite(w.x + w.y + w.z)) return no_digit;
  const Polar<Wide> p = polar_of<Wide>(w);
  constexpr Wide e = radius_bound * Wide(ulp);
  const Wide centre = density(p);
  if (centre == 0 && claimed == 0) return 0;
  Wide low = centre, high = centre;
  const auto include = [&](Wide d) { low = std::min(low, d), high = std::max(high, d); };
  for (const int dr : {-1, 1})
    for (const int dphi : {-1, 1})
      include(density(
          Polar<Wide>{std::min(p.r * (1 + dr * e), Wide(1)), std::clamp(p.phi * (1 + dphi * e), -pi<Wide>, pi<Wide>)}));
  for (const Wide d : images) include(d);
  return distance(claimed, {low, high}, centre > 0 ? centre : Wide(claimed));
}

glm::vec3 to_direction(Polar<float> p, bool mirrored) {
  p.r = std::min(p.r, 1 - static_cast<float>(ulp) / 2);  // the horizon is no direction
  if (mirrored) p.phi = -p.phi;
  return polar_to_direction(p);
}

/// A variant of the map of one diagram: `map` gives the polar position of two numbers of the diagram.
template <class Map>
Variant of_map(const Shared& p, const char* name, const char* why, const Map& map) {
  Variant v{name, mass_below, map_bound, why, {}, {}, {}, {}};
  v.pdf = v.value = [p](const glm::vec3& w) { return p->density(w); };
  v.sample = [p, map, pdf = v.pdf](float a, float b) {
    const Unfolded f = unfold(a, p->azimuth);
    const glm::vec3 w = to_direction(map(*p, f.u, b), f.mirrored);
    return Draw{w, pdf(w)};
  };
  v.error = [p, map](float a, float b) { return mass_error(*p, a, b, map(*p, a, b)); };
  return v;
}

Polar<float> library_map(const Problem& p, float u, float v) {
  const Polar<float> at = p.diagram.sample(u, v).at;
  return {at.r, at.phi};
}

/// A variant of the step between disk and hemisphere.
template <class Forward, class Back>
Variant of_direction(const Shared& p, const char* name, const char* why, const Forward& forward, const Back& back) {
  Variant v{name, radius_read, radius_bound, why, {}, {}, {}, {}};
  const auto pdf = [p, back](const glm::vec3& w) {
    return static_cast<double>(p->diagram.pdf(fold(back(w), p->azimuth)));
  };
  const auto place = [p](float a, float b) {
    const Unfolded f = unfold(a, p->azimuth);
    Polar<float> at = library_map(*p, f.u, b);
    at.r = std::min(at.r, 1 - static_cast<float>(ulp) / 2);
    if (f.mirrored) at.phi = -at.phi;
    return at;
  };
  // The directions are the exact ones of the diagram's density; the reading is what may be wrong.
  v.pdf = v.value = [p](const glm::vec3& w) { return p->density(w); };
  v.sample = [place, forward, pdf](float a, float b) {
    const glm::vec3 w = forward(place(a, b));
    return Draw{w, pdf(w)};
  };
  // There, and back from a direction that is right to rounding.
  v.error = [place, forward, back](float a, float b) {
    const Polar<float> at = place(a, b);
    const glm::vec3 w(polar_to_direction(Polar<Wide>{at.r, at.phi}));
    const Wide r = at.r, exact = polar_of<Wide>(w).r;
    if (!(r > 0)) return 0.0;
    return std::max(distance(polar_of<Wide>(forward(at)).r, {r}, r), distance(back(w).r, {exact}, exact));
  };
  return v;
}

/// A variant whose draws have `actual` density while it claims `claimed`.
template <class Sample, class Claimed, class Value, class Actual>
Variant of_pdf(const char* name, double bound, const char* why, const Sample& sample, const Claimed& claimed,
               const Value& value, const Actual& actual) {
  Variant v{name, claimed_pdf, bound, why, {}, {}, {}, {}};
  v.pdf = claimed;
  v.value = value;
  v.sample = [sample, claimed](float a, float b) {
    const glm::vec3 w = sample(a, b);
    return Draw{w, claimed(w)};
  };
  v.error = [sample, claimed, actual](float a, float b) {
    const glm::vec3 w = sample(a, b);
    return pdf_error(claimed(w), w, actual);
  };
  return v;
}

/// Cartesian interpolation of the two directions of (turn, v).
template <class T>
Vec3<T> cartesian(const Diagram<T>& first, const Diagram<T>& second, T alpha, T turn, T v) {
  const bool half = first.azimuth() == Azimuth::half, mirrored = half && turn > T(0.5);
  const T u = !half ? turn : mirrored ? 2 * (1 - turn) : 2 * turn;
  const auto one = [&](const Diagram<T>& d) {
    const Polar<T> at = d.sample(u, v).at;
    const T r = std::min(at.r, 1 - std::numeric_limits<T>::epsilon() / 2);
    return polar_to_direction(Polar<T>{r, mirrored ? -at.phi : at.phi});
  };
  const Vec3<T> a = one(first), b = one(second), w = (1 - alpha) * a + alpha * b;
  return w / std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
}

/// The density of the draws of cartesian() at (turn, v) by central differences in long double; negative
/// where the map cannot be differentiated there (a line of a diagram is near).
Wide cartesian_density(const Problem& p, const Diagram<Wide>& other, Wide turn, Wide v) {
  constexpr Wide h = 1e-6L;
  if (!(std::min(turn, v) > 2 * h && std::max(turn, v) < 1 - 2 * h)) return -1;
  const auto at = [&](Wide a, Wide b) { return cartesian<Wide>(p.exact, other, p.alpha, a, b); };
  const auto cross = [](const Vec3<Wide>& a, const Vec3<Wide>& b) {
    return Vec3<Wide>(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  };
  const Vec3<Wide> c = at(turn, v), a0 = at(turn - h, v), a1 = at(turn + h, v), b0 = at(turn, v - h),
                   b1 = at(turn, v + h);
  const auto jacobian = [&](const Vec3<Wide>& da, const Vec3<Wide>& db) {
    const Vec3<Wide> n = cross(da, db);
    return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / (h * h);
  };
  const Wide left = jacobian(c - a0, c - b0), right = jacobian(a1 - c, b1 - c);
  if (!(std::abs(left - right) <= Wide(0.01) * right)) return -1;
  return 2 / (left + right);
}

Variant library_stack(const StabilityInput& input, Interpolation interpolation, const char* name, const char* why) {
  const StackGrid grid{{theta0, theta1}, {input.first, input.second}};
  const auto stack = std::make_shared<const Stack<float>>(grid, interpolation);
  const auto middle = std::make_shared<const Stack<double>>(stack->grid(), interpolation);
  const auto exact = std::make_shared<const Stack<Wide>>(stack->grid(), interpolation);
  Variant v{name, claimed_pdf, pdf_bound, why, {}, {}, {}, {}};
  v.pdf = [stack](const glm::vec3& w) { return static_cast<double>(stack->pdf(theta_i, w)); };
  v.value = [middle](const glm::vec3& w) { return middle->pdf(theta_i, glm::dvec3(w)); };
  // The disk's two numbers go in by the square, as every user of a stack gives them.
  v.sample = [stack](float a, float b) {
    const SquarePoint<float> s = disk_to_square(DiskPoint<float>{a, b});
    const auto d = stack->sample(theta_i, s.u, s.v);
    return Draw{d.wo, d.pdf};
  };
  v.error = [sample = v.sample, exact](float a, float b) {
    const Draw d = sample(a, b);
    // The map's own bound allows the direction of a pair that is map_bound away.
    const auto image = [&](int du, int dv) {
      const auto moved = [](float x, int by) {
        return std::clamp(x + by * Wide(map_bound) * Wide(ulp), Wide(0), Wide(1));
      };
      const SquarePoint<Wide> q = disk_to_square(DiskPoint<Wide>{moved(a, du), moved(b, dv)});
      return exact->sample(theta_i, q.u, q.v).pdf;
    };
    return pdf_error(d.pdf, d.wo, [&](Polar<Wide> at) { return exact->pdf(theta_i, polar_to_direction(at)); },
                     {image(-1, -1), image(-1, 1), image(1, -1), image(1, 1)});
  };
  return v;
}

}  // namespace

std::vector<Variant> make_variants(const StabilityInput& input) {
  const Shared p = std::make_shared<const Problem>(input);
  const auto density = [p](const auto& at) { return p->density(at); };
  const auto blend = [p](const glm::vec3& w) { return p->blend(w); };
  const auto theta_linear = [p](const glm::vec3& w) { return p->theta_linear(w); };
  const auto good_quadratic = [](float m0, float m1, float x) {
    const float n0 = m0 / (m0 + m1);
    return x / (n0 + std::sqrt(std::max(n0 * n0 + (1 - 2 * n0) * x, 0.0f)));
  };
  const auto good_cubic = [](const RadialCell<float>& c, float tau) {
    return tau > 0 ? c.invert(std::min(tau, 1.0f)) : 0.0f;
  };
  const auto from_diagram = [p](float a, float b) {
    const Unfolded f = unfold(a, p->azimuth);
    return to_direction(library_map(*p, f.u, b), f.mirrored);
  };
  const auto from_cells = [p](const auto& cells) {
    return [p, &cells](float a, float b) {
      const Unfolded f = unfold(a, p->azimuth);
      return to_direction(cells.map(f.u, b), f.mirrored);
    };
  };
  const auto cell_pdf = [p](const auto& cells) {
    return [p, &cells](const glm::vec3& w) {
      return static_cast<double>(cells.pdf(fold(direction_to_polar(w), p->azimuth)));
    };
  };
  const auto exact_cell_pdf = [p](Polar<Wide> at) {
    return p->exact_cells.pdf(fold(Polar<float>{static_cast<float>(at.r), static_cast<float>(at.phi)}, p->azimuth));
  };
  const auto float_pdf = [p](const glm::vec3& w) {
    return static_cast<double>(p->diagram.pdf(fold(direction_to_polar(w), p->azimuth)));
  };

  std::vector<Variant> v;
  v.push_back(of_map(p, "cardan", "eq. 11 divides by d_j - d_j+1 and subtracts the large quotients again",
                     [good_quadratic](const Problem& q, float a, float b) {
                       return q.arrays.map(a, b, good_quadratic, [](const RadialCell<float>& c, float tau) {
                         return textbook::cardan(c, tau);
                       });
                     }));
  v.push_back(of_map(p, "quadratic", "-b + sqrt(D) cancels and is divided by a difference of masses that is nearly 0",
                     [good_cubic](const Problem& q, float a, float b) {
                       return q.arrays.map(
                           a, b, [](float m0, float m1, float x) { return textbook::quadratic(m0, m1, x); },
                           good_cubic);
                     }));
  v.push_back(of_direction(
      p, "acos", "cos theta rounds to 1 - k 2^-24 next to the pole: theta comes in steps of 0.02 degrees",
      [](Polar<float> at) { return textbook::direction(at); }, [](const glm::vec3& w) { return textbook::polar(w); }));
  v.push_back(of_pdf("constant-cells-bilinear", map_bound, "draws are uniform in a cell, the pdf read for them is not",
                     from_cells(p->exact_cells), density, density, exact_cell_pdf));
  v.push_back(of_pdf("summed-area", map_bound,
                     "the mass of a small cell is lost in the difference of four sums of order 1",
                     from_cells(p->float_cells), cell_pdf(p->float_cells), cell_pdf(p->exact_cells), exact_cell_pdf));
  v.push_back(of_pdf("theta-linear", map_bound,
                     "draws are linear in r = sqrt(1 - cos theta) between parallels, the table is linear in theta",
                     from_diagram, theta_linear, theta_linear, density));
  v.push_back(of_pdf("nearest-interpolated", pdf_bound, "draws follow one diagram, values and pdf a blend of two",
                     from_diagram, blend, blend, density));
  {
    Variant c = of_pdf(
        "cartesian", pdf_bound,
        "the map folds and leaves parts of the hemisphere out; a blend of the pdfs is not its density",
        [p](float a, float b) { return cartesian(p->diagram, p->other, static_cast<float>(p->alpha), a, b); }, blend,
        blend, density);
    c.error = [p, blend, exact_other = Diagram<Wide>(p->other.grid())](float a, float b) {
      const glm::vec3 w = cartesian(p->diagram, p->other, static_cast<float>(p->alpha), a, b);
      const Wide actual = cartesian_density(*p, exact_other, a, b);
      return actual > 0 ? distance(blend(w), {actual}, actual) : 0;
    };
    v.push_back(std::move(c));
  }

  v.push_back(of_map(p, "gonio-diagram", "Diagram: roots as quotients of positive sums", library_map));
  v.push_back(of_direction(
      p, "gonio-polar",
      "polar_to_direction, direction_to_polar: 1 - cos as sin^2 / (1 + cos) keeps the digits next to the pole",
      [](Polar<float> at) { return polar_to_direction(at); },
      [](const glm::vec3& w) { return direction_to_polar(w); }));
  v.push_back(of_pdf("gonio-theta-weighted", map_bound,
                     "the diagram's own pdf, and the table's value over it as weight", from_diagram, float_pdf,
                     theta_linear, density));
  v.push_back(library_stack(input, Interpolation::nearest, "gonio-nearest", "draws and pdf of one diagram"));
  v.push_back(library_stack(input, Interpolation::mixture, "gonio-mixture", "draws from either diagram, pdf of both"));
  v.push_back(library_stack(input, Interpolation::displacement, "gonio-displacement",
                            "polar coordinates keep the map triangular and monotone: its density is exact"));
  return v;
}

std::vector<std::string> variant_names() {
  std::vector<std::string> names;
  for (const Variant& v : make_variants(stability_inputs().front())) names.push_back(v.name);
  return names;
}

}  // namespace gonio
