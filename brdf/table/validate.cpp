#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gonio/brdf/formats/sniff.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/brdf/table/validate.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

bool any_fatal(const Problems& problems) {
  return std::any_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; });
}

void check_cells(const CellCounts& cells, Problems& problems) {
  const auto report = [&](const char* kind, std::uint64_t count) {
    if (count == 0) return;
    problems.push_back(
        {"cells", std::to_string(count) + " " + kind + " of " + std::to_string(cells.total), "none", false});
  };
  report("negative", cells.negative);
  report("not finite", cells.nonfinite);
  report("missing (not measured)", cells.missing);
}

void check_albedo(const BrdfTable& table, Problems& problems) {
  // Above the error of the quadrature, so that a lossless material raises no doubt.
  constexpr float limit = 1.005f;
  float largest = 0.0f;
  for (const int degrees : {2, 10, 30, 50, 70, 80, 85}) {
    const float theta_i = static_cast<float>(degrees) * 0.01745329252f;
    const glm::vec3 albedo = directional_albedo(table, theta_i);
    const float highest = std::max({albedo.r, albedo.g, albedo.b});
    largest = std::max(largest, highest);
    if (!(highest > limit)) continue;
    char text[64];
    std::snprintf(text, sizeof(text), "%.4f %.4f %.4f", static_cast<double>(albedo.r), static_cast<double>(albedo.g),
                  static_cast<double>(albedo.b));
    problems.push_back(
        {"albedo at " + std::to_string(degrees) + " degrees", text, "at most 1 in every channel", false});
  }
  if (largest == 0.0f) {
    problems.push_back({"albedo", "0 at every angle", "a material that reflects", false});
  }
}

Problems check(const std::filesystem::path& path) {
  Problems problems;
  switch (sniff_format(path)) {
    case TableFormat::merl:
      parse_merl(read_bytes(path), problems);
      break;
    case TableFormat::rgl:
      parse_rgl(read_bytes(path), problems);
      break;
    case TableFormat::mbsdf:
      parse_mbsdf(read_bytes(path), problems);
      break;
    case TableFormat::unknown:
      problems.push_back(unknown_format(path));
      break;
  }
  if (any_fatal(problems)) return problems;
  const BrdfTable table = load_table(path);
  check_cells(table.info().cells, problems);
  check_albedo(table, problems);
  return problems;
}

}  // namespace

Problems validate_table(const std::filesystem::path& path) {
  try {
    return check(path);
  } catch (const Error& error) {
    return {{"file", error.what(), "a table that can be loaded", true}};
  }
}

}  // namespace gonio
