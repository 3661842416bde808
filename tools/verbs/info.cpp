#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/brdf/table/flat_from.h>
#include <gonio/brdf/table/measured_to.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/failures.h"
#include "tools/cli/input.h"
#include "tools/cli/number.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
constexpr int albedo_angles[] = {2, 10, 30, 50, 70, 80, 85};

using nlohmann::ordered_json;

struct Options {
  std::vector<std::string> files;
  CellPolicies policies;
  bool json = false;
};

/// What `info` says of a file: lines for people, members for programs.
struct Facts {
  std::string text;
  ordered_json json;
};

/// Text out of a file, in one line and without control characters.
std::string printable(std::string text) {
  for (char& c : text) c = std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  return text;
}

void line(Facts& facts, const std::string& field, const std::string& value) {
  if (value.empty()) return;
  facts.text += field + std::string(field.size() < 12 ? 12 - field.size() : 1, ' ') + printable(value) + "\n";
}

/// A line that programs get as it is.
void both(Facts& facts, const char* field, const std::string& value) {
  line(facts, field, value);
  facts.json[field] = value;
}

/// A line of the file a line.
void comments(Facts& facts, const std::string& text) {
  std::istringstream lines(text);
  std::string field = "comments";
  for (std::string one; std::getline(lines, one); field.clear()) line(facts, field, one);
  facts.json["comments"] = text;
}

std::string degrees(double radians) { return number(radians / degree, 4); }

/// The range of incident angles.
void angles(Facts& facts, double low, double high, const std::string& remark = "") {
  line(facts, "theta_i", degrees(low) + " to " + degrees(high) + remark);
  facts.json["theta_i_degrees"] = {low / degree, high / degree};
}

std::string bytes_text(std::uintmax_t bytes) {
  char text[64];
  std::snprintf(text, sizeof(text), "%ju bytes (%.1f KiB)", bytes, static_cast<double>(bytes) / 1024);
  return text;
}

void file_bytes(Facts& facts, std::uintmax_t bytes) {
  line(facts, "file", bytes_text(bytes) + " on disk");
  facts.json["file_bytes"] = bytes;
}

template <class Albedo>
void add_albedo(Facts& facts, const Albedo& albedo) {
  facts.text += "albedo      theta_i      red    green     blue\n";
  facts.json["albedo"] = ordered_json::array();
  for (const int angle : albedo_angles) {
    const glm::vec3 a = albedo(static_cast<float>(angle * degree));
    char row[96];
    std::snprintf(row, sizeof row, "            %7d  %7.4f  %7.4f  %7.4f\n", angle, static_cast<double>(a.r),
                  static_cast<double>(a.g), static_cast<double>(a.b));
    facts.text += row;
    facts.json["albedo"].push_back({{"theta_i_degrees", angle}, {"rgb", {a.r, a.g, a.b}}});
  }
}

void add_layout(Facts& facts, const MerlTable& table) {
  both(facts, "format", "MERL");
  both(facts, "size",
       "90 x 90 x " + std::to_string(table.n_phi_d()) + " cells (theta_h x theta_d x phi_d)" +
           (table.n_phi_d() == 180 ? ", reciprocal" : ""));
  angles(facts, 0, pi<double> / 2);
}

void add_layout(Facts& facts, const RglTable& table) {
  both(facts, "format", table.spectral() ? "RGL, spectral" : "RGL, RGB");
  both(facts, "size", std::to_string(table.theta_i().size()) + " incident angles");
  angles(facts, static_cast<double>(table.theta_i().front()), static_cast<double>(table.theta_i().back()));
}

void add_layout(Facts& facts, const MbsdfTable& table) {
  const double half_cell = pi<double> / 4 / table.n_theta_in();
  both(facts, "format", "MBSDF");
  both(facts, "size",
       std::to_string(table.n_theta_in()) + " x " + std::to_string(table.n_theta_out()) + " x " +
           std::to_string(table.n_phi()) + " cells (theta_in x theta_out x phi)");
  angles(facts, half_cell, pi<double> / 2 - half_cell, " (cell centres)");
}

void add_measured(Facts& facts, const BrdfTable& table) {
  const double angle = measured_to(table);
  line(facts, "measured",
       angle > 0 ? "to " + degrees(angle) + " degrees from the normal" : "less than half at every angle");
  facts.json["measured_to_degrees"] = angle / degree;
}

void add_cells(Facts& facts, const CellCounts& counts, const CellPolicies& policies) {
  std::string text = std::to_string(counts.total) + ", of which ";
  facts.json["cells"] = {{"total", counts.total}};
  const auto add = [&](const char* key, const char* kind, std::uint64_t count, CellPolicy policy, const char* end) {
    text += std::to_string(count) + " " + kind + " (" + to_string(policy) + ")" + end;
    facts.json["cells"][key] = {{"count", count}, {"policy", to_string(policy)}};
  };
  add("negative", "negative", counts.negative, policies.negative, ", ");
  add("nonfinite", "not finite", counts.nonfinite, policies.nonfinite, ", ");
  add("missing", "missing", counts.missing, policies.missing, "");
  line(facts, "cells", text);
}

/// What a table lacks although each of its values can be used.
void add_doubts(Facts& facts, const BrdfTable& table) {
  facts.json["doubts"] = nlohmann::ordered_json::array();
  const auto doubt = [&](const std::string& text) {
    line(facts, "doubt", text);
    facts.json["doubts"].push_back(text);
  };
  const CellCounts& cells = table.info().cells;
  const auto percent =
      static_cast<int>(std::lround(100.0 * static_cast<double>(cells.negative) / static_cast<double>(cells.total)));
  if (percent >= 1) doubt(std::to_string(percent) + " % of the cells are negative");
  const auto flat = [&](const char* angle, int from) {
    constexpr int outermost = 87;  // constant beyond the last cells, as tables are
    if (from > 0 && from < outermost)
      doubt(std::string("flat: f_r does not change with ") + angle + " from " + std::to_string(from) + " degrees on");
  };
  const FlatFrom from = flat_from(table);
  flat("theta_i", from.theta_i);
  flat("theta_o", from.theta_o);
  if (const auto* grid = std::get_if<MbsdfTable>(&table.data()); grid != nullptr && grid->has_transmission())
    doubt("the transmission of the file is left out");
  if (const auto* rgl = std::get_if<RglTable>(&table.data())) {
    const CellCounts& densities = rgl->densities();
    if (densities.negative + densities.nonfinite > 0)
      doubt("densities: " + std::to_string(densities.negative) + " negative and " +
            std::to_string(densities.nonfinite) + " not finite of " + std::to_string(densities.total) + ", repaired");
  }
}

void describe_table(Facts& facts, const std::string& path, const CellPolicies& policies) {
  const BrdfTable table = load_table(path, policies);
  const BrdfTable::Info& info = table.info();
  both(facts, "name", info.name);
  std::visit([&](const auto& data) { add_layout(facts, data); }, table.data());
  file_bytes(facts, info.source_bytes);
  both(facts, "description", info.description);
  add_cells(facts, info.cells, policies);
  add_measured(facts, table);
  add_doubts(facts, table);
  add_albedo(facts, [&](float theta_i) { return directional_albedo(table, theta_i); });
}

void describe_model(Facts& facts, const std::string& path) {
  const LobeModel model = load_model(path);
  both(facts, "name", model.name);
  both(facts, "format", "model of analytic lobes");
  both(facts, "size",
       std::to_string(model.lobes.size()) + " lobes, " + std::to_string(model.specular_count()) + " of them specular");
  angles(facts, 0, pi<double> / 2);
  file_bytes(facts, regular_file_size(path));
  both(facts, "description", describe(model));
  const BrdfTable table = load_input(path);
  add_albedo(facts, [&](float theta_i) { return directional_albedo(table, theta_i); });
}

/// "3 to 40", or "3".
template <class Size>
std::string range(const std::vector<DiagramGrid>& diagrams, const Size& size) {
  std::size_t low = size(diagrams.front()), high = low;
  for (const DiagramGrid& diagram : diagrams) {
    low = std::min(low, size(diagram));
    high = std::max(high, size(diagram));
  }
  return low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high);
}

void describe_stack(Facts& facts, const std::string& path) {
  const StackFile file = load_stack(path);
  const std::vector<DiagramGrid>& diagrams = file.bsdf.diagrams.diagrams;
  both(facts, "name", file.name);
  both(facts, "format", "stack of diagrams, version " + std::to_string(stack_file_version));
  both(facts, "source", file.source);
  comments(facts, file.comments);
  both(facts, "chart", to_string(file.bsdf.diagrams.chart));
  both(facts, "between", to_string(file.bsdf.interpolation));
  both(facts, "size",
       std::to_string(diagrams.size()) + " diagrams of " +
           range(diagrams, [](const DiagramGrid& d) { return d.phi.size(); }) + " meridians x " +
           range(diagrams, [](const DiagramGrid& d) { return d.r.size(); }) + " parallels");
  angles(facts, file.bsdf.diagrams.theta_i.front(), file.bsdf.diagrams.theta_i.back());
  file_bytes(facts, regular_file_size(path));
  const std::size_t bytes = BatchLayout(sampled_stack(file.bsdf)).bytes();
  line(facts, "diagrams", bytes_text(bytes) + " as they are sampled, 16 bits a crossing");
  facts.json["diagrams"] = {{"count", diagrams.size()}, {"bytes", bytes}};
  if (file.bsdf.colour.empty()) {
    line(facts, "colour", "none: sampling needs the table as well");
    facts.json["colour"] = nullptr;
    return;
  }
  const Colour& colour = file.bsdf.colour;
  line(facts, "colour",
       std::to_string(colour.side()) + " x " + std::to_string(colour.side() / 2) + " cells at " +
           std::to_string(colour.theta_i().size()) + " angles, " + bytes_text(colour.bytes()));
  facts.json["colour"] = {
      {"side", colour.side()}, {"incident_angles", colour.theta_i().size()}, {"bytes", colour.bytes()}};
  const Bsdf sampler(file.bsdf);
  line(facts, "in memory", bytes_text(sampler.bytes()) + " in all");
  facts.json["memory_bytes"] = sampler.bytes();
  add_albedo(facts, [&](float theta_i) {
    constexpr int side = 128;
    const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    glm::dvec3 sum(0);
    for (int k = 0; k < side * side; ++k) {
      const glm::vec2 u(static_cast<float>(k % side) + 0.5f, static_cast<float>(k / side) + 0.5f);
      if (const auto s = sampler.sample(wi, u / static_cast<float>(side))) sum += s->weight;
    }
    return glm::vec3(sum / static_cast<double>(side * side));
  });
}

Facts facts_of(const std::string& path, const CellPolicies& policies) {
  const ProgressLine progress("reading " + path);
  Facts facts;
  facts.json["file"] = path;
  facts.json["kind"] = is_exr(path) ? "stack" : is_model_file(path) ? "model" : "table";
  if (facts.json["kind"] == "stack") {
    describe_stack(facts, path);
  } else if (facts.json["kind"] == "model") {
    describe_model(facts, path);
  } else {
    describe_table(facts, path, policies);
  }
  return facts;
}

void print_json(const ordered_json& json) {
  std::printf("%s\n", json.dump(1, ' ', false, ordered_json::error_handler_t::replace).c_str());
}

/// A block for each file, under its name if there are several.
void info_text(const Options& options) {
  const char* before = "";
  Failures failures;
  for (const std::string& file : options.files)
    failures.survives([&] {
      const Facts facts = facts_of(file, options.policies);
      if (options.files.size() > 1) std::printf("%s%s\n", before, printable(file).c_str());
      std::printf("%s", facts.text.c_str());
      before = "\n";
    });
  failures.throw_any(options.files.size());
}

/// One object for one file, an array for several, whatever fails.
void info_json(const Options& options) {
  if (options.files.size() == 1) {
    print_json(facts_of(options.files.front(), options.policies).json);
    return;
  }
  ordered_json all = ordered_json::array();
  Failures failures;
  for (const std::string& file : options.files)
    failures.survives([&] { all.push_back(facts_of(file, options.policies).json); });
  print_json(all);
  failures.throw_any(options.files.size());
}

}  // namespace

void add_info(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("info", "What a table, a stack file or a fit holds");
  verb->add_option("FILE", options->files, "MERL, RGL or MBSDF tables, stack files (.exr), or fit.json")->required();
  verb->add_flag("--json", options->json, "As JSON: an object, or an array of them for several files");
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "What fails is named at the end, and the other files are printed.\n\n"
      "Examples:\n"
      "  gonio info chrome.binary\n"
      "  gonio info satin.bsdf --nonfinite reject\n"
      "  gonio info measured/*.bsdf stack.exr --json");
  verb->callback([options] { options->json ? info_json(*options) : info_text(*options); });
}

}  // namespace gonio
