#include <algorithm>
#include <array>
#include <cmath>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/diagram/unfold.h>

namespace gonio {
namespace {

constexpr double same_angle = 1e-6;  // [deg]

/// C' = offset + sign * C shows the same intensities as C.
struct Image {
  double offset, sign;
};

/// The symmetries as data. Order: strongest first, as find_symmetry() tries them.
struct Rule {
  LightSymmetry symmetry;
  const char* name;
  double from, to;  // the C that are stored [deg]
  int images;
  std::array<Image, 4> image;
};

constexpr std::array<Rule, 5> rules{{
    {LightSymmetry::rotational, "rotational", 0, 0, 1, {{{0, 1}}}},
    {LightSymmetry::quadrant, "C0-C180 and C90-C270", 0, 90, 4, {{{0, 1}, {180, -1}, {180, 1}, {0, -1}}}},
    {LightSymmetry::c0_c180, "C0-C180", 0, 180, 2, {{{0, 1}, {0, -1}}}},
    {LightSymmetry::c90_c270, "C90-C270", 90, 270, 2, {{{0, 1}, {180, -1}}}},
    {LightSymmetry::none, "none", 0, 360, 1, {{{0, 1}}}},
}};

const Rule& rule_of(LightSymmetry symmetry) noexcept {
  for (const Rule& rule : rules)
    if (rule.symmetry == symmetry) return rule;
  return rules.back();
}

double turned(double degrees) {
  double t = std::fmod(degrees, 360.0);
  if (t < 0) t += 360;
  return t > 360 - same_angle || t < same_angle ? 0 : t;
}

double radians(double degrees) { return degrees * pi<double> / 180; }

void check_angles(const std::vector<double>& angles, const char* field, const std::string& name) {
  if (angles.empty()) throw Error(name + ": " + field + ": found none, expected at least one");
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i] > angles[i - 1]))
      throw Error(name + ": " + field + "[" + std::to_string(i) + "]: found " + format_number(angles[i]) + " after " +
                  format_number(angles[i - 1]) + ", expected ascending angles");
}

struct Meridian {
  double c;  // [deg] in [0, 360)
  std::vector<double> cd;
};

/// The parallels: those of the file, dark ones where the file stops short of a hemisphere.
void complete_parallels(std::vector<double>& gamma, std::vector<Meridian>& meridians, const std::string& name,
                        Problems& deviations) {
  for (double& g : gamma)
    for (double edge : {0.0, 90.0, 180.0})
      if (std::abs(g - edge) < same_angle) g = edge;
  const double first = gamma.front(), last = gamma.back();
  if (first < 0 || last > 180)
    throw Error(name + ": vertical angles: found the range " + format_number(first) + " to " + format_number(last) +
                ", expected 0 to 180 degrees from the pole");
  const double edge = edge_width * 180 / pi<double>;
  const auto insert = [&](bool at_front, double angle) {
    gamma.insert(at_front ? gamma.begin() : gamma.end(), angle);
    for (Meridian& m : meridians) m.cd.insert(at_front ? m.cd.begin() : m.cd.end(), 0.0);
  };
  const auto dark = [&](bool at_front) {
    return std::all_of(meridians.begin(), meridians.end(),
                       [&](const Meridian& m) { return (at_front ? m.cd.front() : m.cd.back()) == 0; });
  };
  if (last != 90 && last != 180) {
    deviations.push_back(
        {"vertical angles", "the last at " + format_number(last), "90 or 180; taken as dark beyond", false});
    if (!dark(false)) insert(false, last + edge);
    insert(false, last < 90 ? 90 : 180);
  }
  if (first != 0 && first != 90) {
    deviations.push_back(
        {"vertical angles", "the first at " + format_number(first), "0 or 90; taken as dark before", false});
    if (!dark(true)) insert(true, first - edge);
    insert(true, first > 90 ? 90 : 0);
  }
  if (gamma.size() < 2)
    throw Error(name + ": vertical angles: found " + std::to_string(gamma.size()) + ", expected at least 2");
}

/// One value where all meridians meet.
void unite_pole(std::vector<Meridian>& meridians, bool front, const FoldedLight& folded, double largest,
                Problems& deviations) {
  const auto value = [&](Meridian& m) -> double& { return front ? m.cd.front() : m.cd.back(); };
  double lowest = value(meridians.front()), highest = lowest, sum = 0, weight = 0;
  for (std::size_t i = 0; i < meridians.size(); ++i) {
    const double v = value(meridians[i]);
    lowest = std::min(lowest, v), highest = std::max(highest, v);
    // The share of the turn that a meridian stands for.
    const double before = i > 0 ? meridians[i - 1].c : meridians.back().c - 360;
    const double after = i + 1 < meridians.size() ? meridians[i + 1].c : meridians.front().c + 360;
    const double share = folded.sector ? 1 : after - before;
    sum += v * share, weight += share;
  }
  if (lowest == highest) return;
  const double mean = sum / weight;
  if (highest - lowest > 1e-6 * largest)
    deviations.push_back({front ? "intensity at the pole gamma = 0" : "intensity at the pole gamma = 180",
                          format_number(lowest) + " to " + format_number(highest) + " " + folded.unit,
                          "one value; the mean " + format_number(mean) + " is taken", false});
  for (Meridian& m : meridians) value(m) = mean;
}

}  // namespace

const char* to_string(LightSymmetry symmetry) noexcept { return rule_of(symmetry).name; }

LightDiagram unfold(const FoldedLight& folded, const LightFrame& frame, const std::string& name, Problems& deviations) {
  check_angles(folded.c, "horizontal angles", name);
  check_angles(folded.gamma, "vertical angles", name);
  const std::size_t n = folded.gamma.size();
  const Rule& rule = rule_of(folded.symmetry);

  double largest = 0;
  std::size_t negative = 0;
  for (double v : folded.cd) largest = std::max(largest, v), negative += v < 0;
  if (negative > 0)
    deviations.push_back(
        {"intensities", std::to_string(negative) + " negative values", "values >= 0; taken as 0", false});

  std::vector<Meridian> meridians;
  for (std::size_t i = 0; i < folded.c.size(); ++i)
    for (int k = 0; k < rule.images; ++k) {
      const Image& image = rule.image[static_cast<std::size_t>(k)];
      Meridian m{turned(image.offset + image.sign * folded.c[i]), {}};
      for (std::size_t j = 0; j < n; ++j) m.cd.push_back(std::max(folded.cd[i * n + j], 0.0));
      meridians.push_back(std::move(m));
      if (folded.symmetry == LightSymmetry::rotational) break;
    }
  std::stable_sort(meridians.begin(), meridians.end(), [](const Meridian& a, const Meridian& b) { return a.c < b.c; });
  // Images of a meridian in a mirror plane, and 360 beside 0.
  for (std::size_t i = 1; i < meridians.size();) {
    if (meridians[i].c - meridians[i - 1].c > same_angle) {
      ++i;
      continue;
    }
    double difference = 0;
    for (std::size_t j = 0; j < n; ++j)
      difference = std::max(difference, std::abs(meridians[i].cd[j] - meridians[i - 1].cd[j]));
    if (difference > 1e-6 * largest)
      deviations.push_back({"intensities at C = " + format_number(meridians[i].c),
                            "two meridians that differ by up to " + format_number(difference) + " " + folded.unit,
                            "equal ones; the first is taken", false});
    meridians.erase(meridians.begin() + static_cast<std::ptrdiff_t>(i));
  }

  std::vector<double> gamma = folded.gamma;
  complete_parallels(gamma, meridians, name, deviations);

  // The lit meridians of a sector meet in one value; its dark ones stay dark up to the pole.
  if (gamma.front() == 0) unite_pole(meridians, true, folded, largest, deviations);
  if (gamma.back() == 180) unite_pole(meridians, false, folded, largest, deviations);
  if (folded.sector && folded.c.size() > 1 && folded.c.back() - folded.c.front() < 360 - same_angle) {
    const double edge = edge_width * 180 / pi<double>;
    const std::vector<double> dark(gamma.size(), 0.0);
    for (double c : {turned(folded.c.front() - edge), turned(folded.c.back() + edge)}) meridians.push_back({c, dark});
    std::sort(meridians.begin(), meridians.end(), [](const Meridian& a, const Meridian& b) { return a.c < b.c; });
  }
  LightDiagram diagram;
  diagram.frame = frame;
  for (double g : gamma) diagram.gamma.push_back(radians(g));
  const auto append = [&](double c, const std::vector<double>& values) {
    diagram.c.push_back(radians(c));
    diagram.cd.insert(diagram.cd.end(), values.begin(), values.end());
  };
  if (meridians.front().c > 0 && meridians.size() > 1) {
    // No meridian at C = 0: the one that bilinear interpolation puts there.
    const Meridian &before = meridians.back(), &after = meridians.front();
    const double t = (360 - before.c) / (360 - before.c + after.c);
    std::vector<double> values(gamma.size());
    for (std::size_t j = 0; j < values.size(); ++j) values[j] = (1 - t) * before.cd[j] + t * after.cd[j];
    append(0, values);
  } else {
    meridians.front().c = 0;
  }
  for (const Meridian& m : meridians) append(m.c, m.cd);
  const std::vector<double> first(diagram.cd.begin(), diagram.cd.begin() + static_cast<std::ptrdiff_t>(gamma.size()));
  append(360, first);
  check(diagram);
  return diagram;
}

LightSymmetry find_symmetry(const LightDiagram& d, double tolerance) {
  const double slack = tolerance * max_intensity(d);
  const auto equal_at = [&](double c0, double c1) {
    for (double g : d.gamma)
      if (std::abs(d.intensity({c0, g}) - d.intensity({c1, g})) > slack) return false;
    return true;
  };
  const auto holds = [&](const Rule& rule) {
    for (double c : d.c) {
      if (rule.symmetry == LightSymmetry::rotational && !equal_at(c, 0)) return false;
      for (int k = 1; k < rule.images; ++k) {
        const Image& image = rule.image[static_cast<std::size_t>(k)];
        if (!equal_at(c, radians(image.offset) + image.sign * c)) return false;
      }
    }
    if (rule.symmetry == LightSymmetry::rotational) return true;
    for (double edge : {rule.from, rule.to})
      if (std::none_of(d.c.begin(), d.c.end(), [&](double c) { return std::abs(c - radians(edge)) < 1e-9; }))
        return false;
    return true;
  };
  for (const Rule& rule : rules)
    if (holds(rule)) return rule.symmetry;
  return LightSymmetry::none;
}

FoldedLight fold(const LightDiagram& d, LightSymmetry symmetry) {
  const Rule& rule = rule_of(symmetry);
  FoldedLight folded;
  folded.symmetry = symmetry;
  for (double g : d.gamma) folded.gamma.push_back(g * 180 / pi<double>);
  for (std::size_t i = 0; i < d.c.size(); ++i) {
    const double c = d.c[i] * 180 / pi<double>;
    if (c < rule.from - same_angle || c > rule.to + same_angle) continue;
    folded.c.push_back(c);
    for (std::size_t j = 0; j < d.gamma.size(); ++j) folded.cd.push_back(d.at(i, j));
  }
  return folded;
}

}  // namespace gonio
