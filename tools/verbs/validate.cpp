#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/formats/sniff.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/brdf/table/validate.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/input.h"
#include "tools/cli/number.h"
#include "tools/cli/progress.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

/// A name that promises one format over content of another is an error even though gonio reads the
/// file: other programs go by the name.
void check_name(const std::filesystem::path& path, const std::string& expected, Problems& problems) {
  std::string found = path.extension().string();
  for (char& c : found) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool promises =
      found == ".binary" || found == ".bsdf" || found == ".mbsdf" || found == ".exr" || found == ".json";
  if (promises && found != expected)
    problems.push_back({"extension", found, expected + " for what the file holds", true});
}

/// What an error says of `path`, without naming it: the line that it becomes does.
std::string text_of(const Error& error, const std::filesystem::path& path) {
  const std::string text = error.what(), prefix = path.string() + ": ";
  return text.compare(0, prefix.size(), prefix) == 0 ? text.substr(prefix.size()) : text;
}

/// The mean of W over the unit square, which is the albedo, is that of the cells: one layer at a time.
void check_albedo(const Colour& colour, Problems& problems) {
  constexpr double limit = 1.005;  // as for tables
  const std::vector<glm::vec3> values = colour.values();
  const std::size_t cells = values.size() / colour.theta_i().size();
  double largest = 0, where = 0;
  for (std::size_t i = 0; i < values.size(); i += cells) {
    glm::dvec3 sum(0);
    for (std::size_t k = i; k < i + cells; ++k) sum += glm::dvec3(values[k]);
    const double albedo = std::max({sum.r, sum.g, sum.b}) / static_cast<double>(cells);
    if (albedo <= largest) continue;
    largest = albedo;
    where = static_cast<double>(colour.theta_i()[i / cells]) * 180 / pi<double>;
  }
  if (largest > limit)
    problems.push_back({"albedo", number(largest, 4) + " at " + number(where, 4) + " degrees",
                        "at most 1, or it reflects more than it receives", false});
}

Problems check_stack(const std::filesystem::path& path) {
  Problems problems;
  StackFile file;
  try {
    file = load_stack(path);
  } catch (const Error& error) {
    problems.push_back({"stack file", text_of(error, path), "one that loads", true});
    return problems;
  }
  for (std::size_t k = 0; k < file.bsdf.diagrams.diagrams.size(); ++k) {
    const DiagramGrid& grid = file.bsdf.diagrams.diagrams[k];
    const auto peak = std::max_element(grid.density.begin(), grid.density.end()) - grid.density.begin();
    const double integral = grid.density[peak] / Diagram<double>(grid).grid().density[peak];
    if (std::abs(integral - 1) > 1e-3) {
      problems.push_back({"diagram " + std::to_string(k), "densities with integral " + number(integral, 4),
                          "1 over the hemisphere (they are scaled on loading)", false});
    }
  }
  const double last = file.bsdf.diagrams.theta_i.back() * 180 / pi<double>;
  if (last < 80) {
    problems.push_back({"theta_i", "a last diagram at " + number(last, 4) + " degrees", "80 or more", false});
  }
  if (file.bsdf.colour.empty()) {
    problems.push_back({"colour", "none", "a part colour, without which sampling needs the table", false});
  } else {
    check_albedo(file.bsdf.colour, problems);
  }
  return problems;
}

Problems check_model(const std::filesystem::path& path) {
  Problems problems;
  try {
    const BrdfTable table = load_input(path);
    double largest = 0, where = 0;
    for (double degrees = 5; degrees <= 85; degrees += 10) {
      const glm::vec3 albedo = directional_albedo(table, static_cast<float>(degrees * pi<double> / 180));
      for (int c = 0; c < 3; ++c) {
        if (static_cast<double>(albedo[c]) <= largest) continue;
        largest = static_cast<double>(albedo[c]);
        where = degrees;
      }
    }
    if (largest > 1) {
      problems.push_back({"albedo", number(largest, 4) + " at " + number(where, 4) + " degrees",
                          "at most 1, or it reflects more than it receives", false});
    }
  } catch (const Error& error) {
    problems.push_back({"model", text_of(error, path), "one that loads", true});
  }
  return problems;
}

Problems check_file(const std::filesystem::path& path) {
  Problems problems;
  if (is_exr(path)) {
    problems = check_stack(path);
    check_name(path, ".exr", problems);
    return problems;
  }
  if (is_model_file(path)) {
    problems = check_model(path);
    check_name(path, ".json", problems);
    return problems;
  }
  problems = validate_table(path);
  switch (sniff_format(path)) {
    case TableFormat::merl:
      check_name(path, ".binary", problems);
      break;
    case TableFormat::rgl:
      check_name(path, ".bsdf", problems);
      break;
    case TableFormat::mbsdf:
      check_name(path, ".mbsdf", problems);
      break;
    case TableFormat::unknown:
      break;  // reported already
  }
  return problems;
}

/// Prints what is wrong with a file. False if it cannot be used.
bool report(const std::string& path) {
  Problems problems;
  {
    const ProgressLine progress("checking " + path);
    problems = check_file(path);
  }
  bool usable = true;
  for (const Problem& problem : problems) {
    usable = usable && !problem.fatal;
    std::printf("%s: %s: %s\n", path.c_str(), problem.fatal ? "error" : "warning", to_string(problem).c_str());
  }
  if (problems.empty()) std::printf("%s: ok\n", path.c_str());
  return usable;
}

}  // namespace

void add_validate(CLI::App& app) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = app.add_subcommand("validate", "Every problem of tables, stack files and fits");
  verb->add_option("FILE", *files, "MERL, RGL or MBSDF tables, stack files (.exr), or fit.json")->required();
  verb->footer(
      "Prints a line for each problem: an error makes the file unusable, a warning does not.\n"
      "Exit status: 1 if a file is unusable.\n\n"
      "Examples:\n"
      "  gonio validate chrome.binary\n"
      "  gonio validate measured/*.bsdf stack.exr");
  verb->callback([files] {
    std::string unusable;
    for (const std::string& file : *files) {
      bool usable = false;
      try {
        usable = report(file);
      } catch (const Error& error) {  // it cannot be read; the others may
        std::printf("%s: error: %s\n", file.c_str(), text_of(error, file).c_str());
      }
      if (!usable) unusable += (unusable.empty() ? "" : ", ") + file;
    }
    if (!unusable.empty()) throw Error("unusable: " + unusable);
  });
}

}  // namespace gonio
