#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include <gonio/brdf/proof/coherence.h>
#include <gonio/brdf/proof/edges.h>
#include <gonio/brdf/proof/incident.h>
#include <gonio/brdf/proof/invariants.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio::proof {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string text(const glm::vec3& w) {
  std::ostringstream out;
  out << '(' << w.x << ", " << w.y << ", " << w.z << ')';
  return out.str();
}

double largest_component(const glm::vec3& a, const glm::vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// |a - b| relative to the larger; 0 if both are.
double relative(double a, double b) {
  const double larger = std::max(std::abs(a), std::abs(b));
  return larger > 0 ? std::abs(a - b) / larger : a == b ? 0 : infinity;
}

glm::vec3 turned(const glm::vec3& w, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

/// The largest of some values, and where it was met.
struct Worst {
  double value = 0;
  std::string where;

  void see(double x, const glm::vec3& w) {
    if (!(x <= value)) value = std::isnan(x) ? infinity : x, where = "at wo = " + text(w);
  }
};

/// Whether a function of t in [0, 1] jumps: halves the interval, each time keeping the half over which
/// the function differs more. What is continuous comes down, cube roots to 1/40; a jump stays.
/// `difference` is that of two values, `size` that of the larger.
template <class Value>
bool has_jump(const std::function<Value(double)>& function,
              const std::function<double(const Value&, const Value&)>& difference,
              const std::function<double(const Value&, const Value&)>& size) {
  double a = 0, b = 1;
  Value fa = function(a), fb = function(b);
  const double whole = difference(fa, fb);
  if (!(whole > 0)) return false;
  for (int halving = 0; halving < 16; ++halving) {
    const double middle = (a + b) / 2;
    const Value f = function(middle);
    if (difference(fa, f) > difference(f, fb))
      b = middle, fb = f;
    else
      a = middle, fa = f;
  }
  const double left = difference(fa, fb);
  return left > whole / 8 && left > 0.01 * size(fa, fb);
}

bool density_jumps(const std::function<double(double)>& density, double floor) {
  return has_jump<double>(
      density, [](const double& a, const double& b) { return std::abs(a - b); },
      [floor](const double& a, const double& b) {
        return std::max({a, b, floor});
      });
}

class Run {
 public:
  Run(const Subject& subject, double theta_i, const InvariantOptions& options)
      : s_(subject), theta_i_(theta_i), o_(options), wi_(incident(theta_i)), random_(options.seed) {}

  Checks checks() {
    draw_points();
    statistics();
    per_point();
    edges();
    if (s_.f_r) support();
    if (s_.invert) round_trips();
    symmetry();
    if (o_.continuous) continuity();
    return std::move(checks_);
  }

 private:
  struct Point {
    glm::vec2 u;
    BsdfSample s;
  };

  void add(const char* name, double value, double bound, bool passed, const std::string& note) {
    std::ostringstream message;
    message << name << ": found " << value << ", bound " << bound << (note.empty() ? "" : ", ") << note;
    checks_.push_back({name, value, bound, passed, message.str()});
  }
  void at_most(const char* name, double value, double bound, const std::string& note = "") {
    add(name, value, bound, value <= bound, note);
  }

  static bool good(const BsdfSample& s) {
    const double length2 = static_cast<double>(s.wo.x) * s.wo.x + static_cast<double>(s.wo.y) * s.wo.y +
                           static_cast<double>(s.wo.z) * s.wo.z;
    return std::abs(length2 - 1) < 1e-5 && s.wo.z > 0 && s.pdf > 0 && std::isfinite(s.pdf) &&
           std::isfinite(s.weight.x + s.weight.y + s.weight.z);
  }

  void draw_points() {
    constexpr float edge[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
    std::vector<glm::vec2> u;
    for (const float x : edge)
      for (const float y : edge) u.emplace_back(x, y);
    for (int k = 0; k < o_.points; ++k) u.push_back(random_.pair());
    for (const glm::vec2& p : u) {
      const auto s = s_.sample(wi_, p);
      if (!s) continue;
      if (!good(*s)) {
        bad_ += 1;
        where_bad_ = "at u = " + std::to_string(p.x) + ", " + std::to_string(p.y);
        continue;
      }
      points_.push_back({p, *s});
      peak_ = std::max<double>(peak_, s->pdf);
    }
  }

  bool has_digits(double pdf) const { return pdf >= o_.density_floor * peak_; }

  double pdf(const glm::vec3& wo) const { return s_.pdf(wi_, wo); }

  void statistics() {
    const auto reflected = [&](const glm::vec3& wo) { return s_.f_r(wi_, wo) * wo.z; };
    double mean = 0;
    for (const Point& p : points_) mean += luminance(p.s.weight) / static_cast<double>(points_.size());
    const bool reflects = s_.f_r && mean > 0;
    const Bins bins =
        Bins::adapted([&](const glm::vec3& wo) { return pdf(wo) + (reflects ? luminance(reflected(wo)) / mean : 0); });

    // Of the direction, then of the weight.
    std::array<double, 6> sum{}, sum2{};
    const auto draw = [&](std::uint64_t) -> std::optional<glm::vec3> {
      const auto s = s_.sample(wi_, random_.pair());
      if (!s) return std::nullopt;
      if (!good(*s)) ++bad_, where_bad_ = "wo = " + text(s->wo);
      for (int c = 0; c < 3; ++c) {
        const double x = s->wo[c], weight = s->weight[c];
        sum[c] += x, sum2[c] += x * x;
        sum[3 + c] += weight, sum2[3 + c] += weight * weight;
      }
      return s->wo;
    };
    const ChiSquare chi2 = chi_square(
        draw, [&](const glm::vec3& wo) { return pdf(wo); }, bins, o_.draws);

    const double significance = sidak(o_.significance, 7 * o_.runs);
    at_most("domain", static_cast<double>(bad_ + chi2.outside), 0, where_bad_);
    const double empty = static_cast<double>(chi2.empty) / static_cast<double>(o_.draws);
    at_most("mass", std::abs(chi2.pdf_integral + empty - 1), o_.mass_bound,
            "pdf integral " + std::to_string(chi2.pdf_integral) + ", share of empty draws " + std::to_string(empty));
    at_most("where_zero", static_cast<double>(chi2.where_zero), 0);
    add("chi_square", chi2.p, significance, chi2.p >= significance, chi2.summary());
    if (!checks_.back().passed && !o_.plot.empty())
      write_chi_square_plot(o_.plot, bins, chi2, "theta_i = " + std::to_string(theta_i_) + " rad");

    // The quadratures are good to some 1e-4; a difference below that says nothing.
    const auto p_value = [](double total, double total2, double count, double expected, double slack) {
      if (count < 2) return 1.0;
      const double found = total / count,
                   error = std::sqrt(std::max(total2 / count - found * found, 0.0) / (count - 1));
      const double away = std::max(std::abs(found - expected) - slack, 0.0);
      return away > 0 ? std::erfc(away / error / std::sqrt(2.0)) : 1.0;
    };
    constexpr double quadrature_error = 2e-4;
    const double drawn = static_cast<double>(o_.draws - chi2.empty);
    double least = 1;
    if (drawn > 0 && chi2.pdf_integral > 0) {
      const glm::dvec3 expected =
          bins.integrate_rgb([&](const glm::vec3& w) { return w * static_cast<float>(pdf(w)); });
      for (int c = 0; c < 3; ++c)
        least = std::min(least, p_value(sum[c], sum2[c], drawn, expected[c] / chi2.pdf_integral, quadrature_error));
    }
    add("moments", least, significance, least >= significance, "");
    if (s_.f_r) {
      const glm::dvec3 albedo = bins.integrate_rgb(reflected);
      double least_p = 1;
      glm::dvec3 found;
      for (int c = 0; c < 3; ++c) {
        found[c] = sum[3 + c] / static_cast<double>(o_.draws);
        least_p = std::min(least_p, p_value(sum[3 + c], sum2[3 + c], static_cast<double>(o_.draws), albedo[c],
                                            5 * quadrature_error * albedo[c]));
      }
      std::ostringstream note;
      note << "of the draws " << text(glm::vec3(found)) << ", by quadrature " << text(glm::vec3(albedo));
      add("albedo", least_p, significance, least_p >= significance, note.str());
    }
  }

  /// What rounding may make of (u, v): the draw and those of the numbers next to (u, v).
  std::vector<BsdfSample> rounded(const glm::vec2& u, const BsdfSample& s) const {
    constexpr float step = 0x1p-22f;
    std::vector<BsdfSample> draws{s};
    for (const glm::vec2& shift : {glm::vec2(step, 0), glm::vec2(-step, 0), glm::vec2(0, step), glm::vec2(0, -step)}) {
      const glm::vec2 next(std::clamp(u.x + shift.x, 0.0f, 1 - 0x1p-24f),
                           std::clamp(u.y + shift.y, 0.0f, 1 - 0x1p-24f));
      if (const auto d = s_.sample(wi_, next)) draws.push_back(*d);
    }
    return draws;
  }

  /// |wo of `s` - w|, less what rounding of (u, v) makes of it.
  double direction_error(const glm::vec2& u, const BsdfSample& s, const glm::vec3& w) const {
    const double error = largest_component(s.wo, w);
    if (error <= o_.direction_bound) return error;
    double spread = 0;
    for (const BsdfSample& d : rounded(u, s)) spread = std::max(spread, largest_component(s.wo, d.wo));
    return std::max(error - spread, 0.0);
  }

  struct Range {
    double least, most;
    void see(double x) { least = std::min(least, x), most = std::max(most, x); }
  };

  /// How far two pdfs are apart, in units of what is allowed.
  double pdf_difference(double a, double b) const {
    return std::abs(a - b) / (o_.pdf_bound * std::max(a, b) + o_.pdf_floor * peak_);
  }
  /// The same of two ranges; 0 where they meet.
  double apart(const Range& a, const Range& b) const {
    return a.most < b.least ? pdf_difference(a.most, b.least) : b.most < a.least ? pdf_difference(b.most, a.least) : 0;
  }

  /// What rounding may make of wo: a turn and a change of height by some 2^-22.
  static std::array<glm::vec3, 4> rounded(const glm::vec3& wo) {
    constexpr float step = 0x1p-22f;
    return {turned(wo, step), turned(wo, -step), glm::vec3(wo.x, wo.y, std::min(wo.z + step, 1.0f)),
            glm::vec3(wo.x, wo.y, std::max(wo.z - step, 0x1p-30f))};
  }

  Range rounded_pdf(const glm::vec3& wi, const glm::vec3& wo) const {
    const double here = s_.pdf(wi, wo);
    Range range{here, here};
    for (const glm::vec3& w : rounded(wo)) range.see(s_.pdf(wi, w));
    return range;
  }

  /// |invert() of a draw - (u, v)|, less what rounding of wo makes of it.
  double square_error(const Point& p) const {
    const auto u = s_.invert(wi_, p.s.wo);
    const auto away = [&](const std::optional<glm::vec2>& a, const glm::vec2& b) {
      return a ? std::max<double>(std::abs(a->x - b.x), std::abs(a->y - b.y)) : infinity;
    };
    const double error = away(u, p.u);
    if (error <= o_.round_trip_bound || !u) return error;
    double spread = 0;
    for (const glm::vec3& w : rounded(p.s.wo))
      if (const auto next = s_.invert(wi_, w)) spread = std::max(spread, away(next, *u));
    return std::max(error - spread, 0.0);
  }

  /// How far pdf() of a draw is from the pdf that came with it, less rounding of (u, v) and wo.
  double pdf_error(const Point& p) const {
    const double asked = pdf(p.s.wo);
    const double error = pdf_difference(p.s.pdf, asked);
    if (error <= 1) return error;
    Range returned{p.s.pdf, p.s.pdf};
    for (const BsdfSample& d : rounded(p.u, p.s)) returned.see(d.pdf);
    return apart(returned, rounded_pdf(wi_, p.s.wo));
  }

  /// How far the pdfs of one direction in two frames are apart, less rounding of wo.
  double frame_error(const glm::vec3& wo, const glm::vec3& other_wi, const glm::vec3& other_wo) const {
    const double error = pdf_difference(pdf(wo), s_.pdf(other_wi, other_wo));
    return error <= 1 ? error : apart(rounded_pdf(wi_, wo), rounded_pdf(other_wi, other_wo));
  }

  void per_point() {
    Worst pdf_error, weight_error;
    for (const Point& p : points_) {
      if (!has_digits(p.s.pdf)) continue;
      pdf_error.see(this->pdf_error(p), p.s.wo);
      if (!s_.f_r) continue;
      const glm::vec3 expected = s_.f_r(wi_, p.s.wo) * (p.s.wo.z / p.s.pdf);
      for (int c = 0; c < 3; ++c) weight_error.see(relative(p.s.weight[c], expected[c]), p.s.wo);
    }
    at_most("pdf", pdf_error.value, 1, "in units of the pdf bound, " + pdf_error.where);
    if (s_.f_r) at_most("weight", weight_error.value, o_.weight_bound, weight_error.where);
  }

  void edges() {
    EdgeOptions options;
    options.along = 24;
    options.seed = o_.seed;
    const EdgeScan scan = scan_edges(s_, theta_i_, options);
    at_most("edge_domain", static_cast<double>(scan.bad), 0, scan.where_bad);
    at_most("edge_pdf", scan.pdf_factor, o_.edge_pdf_bound, scan.where_pdf);
    if (!s_.f_r) return;
    at_most("edge_weight", scan.largest_weight, o_.edge_weight_bound, scan.where_weight);
    if (o_.direction_weight_bound == infinity) return;
    const DirectionScan directions = scan_directions(s_, theta_i_, 128);
    at_most("directions", directions.largest_weight, o_.direction_weight_bound, directions.where);
  }

  void support() {
    double lost = 0, all = 0;
    std::string where;
    for (int k = 0; k < o_.points; ++k) {
      const glm::vec3 w = any_direction();
      const double reflected = luminance(s_.f_r(wi_, w)) * w.z;
      all += reflected;
      if (reflected > 0 && !(pdf(w) > 0)) lost += reflected, where = "at wo = " + text(w);
    }
    at_most("support", all > 0 ? lost / all : 0, 0, where);
  }

  glm::vec3 any_direction() {
    const glm::vec2 u = random_.pair();
    return polar_to_direction(Polar<float>{std::sqrt(u.x) * (1 - 0x1p-23f), 2 * pi<float> * (u.y - 0.5f)});
  }

  void round_trips() {
    Worst square, direction;
    const auto back_and_forth = [&](const glm::vec3& w) {
      const auto u = s_.invert(wi_, w);
      const auto s = u ? s_.sample(wi_, *u) : std::nullopt;
      if (!u)
        direction.see(infinity, w);
      else if (s)  // else rounding met a line without density
        direction.see(direction_error(*u, *s, w), w);
    };
    for (const Point& p : points_) {
      if (!has_digits(p.s.pdf)) continue;
      back_and_forth(p.s.wo);
      if (!o_.one_to_one) continue;
      square.see(square_error(p), p.s.wo);
    }
    for (int k = 0; k < o_.points; ++k) {
      const glm::vec3 w = any_direction();
      if (has_digits(pdf(w))) back_and_forth(w);
    }
    if (o_.one_to_one) at_most("round_trip_square", square.value, o_.round_trip_bound, square.where);
    at_most("round_trip_direction", direction.value, o_.direction_bound, direction.where);
  }

  void symmetry() {
    Worst mirror, rotation;
    const bool has_azimuth = std::sin(theta_i_) > 1e-3;
    for (const Point& p : points_) {
      if (!has_digits(p.s.pdf)) continue;
      if (o_.symmetric) mirror.see(frame_error(p.s.wo, wi_, {p.s.wo.x, -p.s.wo.y, p.s.wo.z}), p.s.wo);
      if (!has_azimuth) continue;
      for (const float angle : {0.7f, 2.4f, -1.3f}) {
        const glm::vec3 wi = turned(wi_, angle), wo = turned(p.s.wo, angle);
        rotation.see(frame_error(p.s.wo, wi, wo), p.s.wo);
        if (!o_.turns || !o_.continuous) continue;  // rounding of theta_i may choose another diagram
        const auto s = s_.sample(wi, p.u);
        if (s) rotation.see(direction_error(p.u, p.s, turned(s->wo, -angle)) / o_.direction_bound, p.s.wo);
      }
    }
    if (o_.symmetric) at_most("mirror", mirror.value, 1, "in units of the pdf bound, " + mirror.where);
    if (has_azimuth)
      at_most("rotation", rotation.value, 1, "in units of the pdf and round-trip bounds, " + rotation.where);
  }

  void continuity() {
    constexpr double reach = 0.02;
    const std::size_t places = std::min<std::size_t>(points_.size(), 300);
    const double from = std::max(theta_i_ - reach, 0.0), to = std::min(theta_i_ + reach, pi<double> / 2);
    const double floor = o_.density_floor * peak_;
    std::size_t jumps = 0, tried = 0, jumps_of_map = 0;
    std::string where;
    const auto along = [&](const std::function<double(double)>& density, const glm::vec3& w, const char* what) {
      ++tried;
      if (!density_jumps(density, floor)) return;
      ++jumps;
      where = std::string("across ") + what + " at wo = " + text(w);
    };
    for (std::size_t k = 0; k < places; ++k) {
      const Point& p = points_[points_.size() - 1 - k];
      const Polar<double> at = direction_to_polar(glm::dvec3(p.s.wo));
      const auto density = [&](double r, double phi) {
        return pdf(glm::vec3(polar_to_direction(Polar<double>{r, phi})));
      };
      along([&](double t) { return s_.pdf(incident(from + t * (to - from)), p.s.wo); }, p.s.wo, "theta_i");
      along([&](double t) { return density(at.r, at.phi + 0.2 * (t - 0.5)); }, p.s.wo, "phi");
      along([&](double t) { return density(at.r, pi<double> + 0.1 * (t - 0.5)); }, p.s.wo, "phi = pi");
      along([&](double t) { return density(at.r, 0.1 * (t - 0.5)); }, p.s.wo, "phi = 0");
      // Not from the pole itself: the limits of a displaced density there depend on phi.
      const double r0 = std::max(at.r - 0.1, 1e-4), r1 = std::min(at.r + 0.1, 0.9999);
      along([&](double t) { return density(r0 + t * (r1 - r0), at.phi); }, p.s.wo, "r");
      jumps_of_map += has_jump<glm::vec3>(
          [&](double t) {
            const double theta_i = from + t * (to - from);
            auto s = s_.sample(incident(theta_i), p.u);
            if (!s) s = s_.sample(incident(theta_i + 2e-5), p.u);  // to rounding on a line without density
            return s ? s->wo : glm::vec3(0, 0, -1);
          },
          [](const glm::vec3& a, const glm::vec3& b) { return static_cast<double>(largest_component(a, b)); },
          [](const glm::vec3&, const glm::vec3&) { return 0.01; });
    }
    at_most("jumps", static_cast<double>(jumps) / static_cast<double>(std::max<std::size_t>(tried, 1)), 0.02, where);
    at_most("jumps_of_map", static_cast<double>(jumps_of_map) / static_cast<double>(std::max<std::size_t>(places, 1)),
            0);
    const Coherence coherence = measure_coherence(s_, theta_i_);
    at_most("tears", static_cast<double>(coherence.tears + coherence.folds), 0,
            std::to_string(coherence.folds) + " of them folds");
  }

  const Subject& s_;
  const double theta_i_;
  const InvariantOptions& o_;
  const glm::vec3 wi_;
  Random random_;
  std::vector<Point> points_;
  double peak_ = 0;
  std::uint64_t bad_ = 0;
  std::string where_bad_;
  Checks checks_;
};

}  // namespace

Checks check_invariants(const Subject& subject, double theta_i, const InvariantOptions& options) {
  return Run(subject, theta_i, options).checks();
}

bool all_passed(const Checks& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
}

std::string failures(const Checks& checks) {
  std::string lines;
  for (const Check& c : checks)
    if (!c.passed) lines += c.message + '\n';
  return lines;
}

}  // namespace gonio::proof
