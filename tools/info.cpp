#include <gonio/brdf/albedo.h>
#include <gonio/brdf/bytes.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/flat_from.h>
#include <gonio/brdf/measured_to.h>
#include <gonio/fitting/model.h>
#include <gonio/tools/info.h>
#include <gonio/tools/input.h>
#include <gonio/tools/options.h>
#include <gonio/tools/progress.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
constexpr int albedo_angles[] = {2, 10, 30, 50, 70, 80, 85};

struct Options {
  std::string file;
  CellPolicies policies;
};

/// Text out of a file, in one line and without control characters.
std::string printable(std::string text) {
  for (char& c : text) c = std::iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  return text;
}

void print(const char* field, const std::string& value) {
  if (!value.empty()) std::printf("%-12s%s\n", field, printable(value).c_str());
}

std::string degrees(double radians) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", radians / degree);
  return text;
}

std::string bytes_text(std::uintmax_t bytes) {
  char text[64];
  std::snprintf(text, sizeof(text), "%ju bytes (%.1f KiB)", bytes,
                static_cast<double>(bytes) / 1024);
  return text;
}

template <class Albedo>
void print_albedo(const Albedo& albedo) {
  std::printf("albedo      theta_i      red    green     blue\n");
  for (const int angle : albedo_angles) {
    const glm::vec3 a = albedo(static_cast<float>(angle * degree));
    std::printf("            %7d  %7.4f  %7.4f  %7.4f\n", angle, static_cast<double>(a.r),
                static_cast<double>(a.g), static_cast<double>(a.b));
  }
}

void print_layout(const MerlTable& table) {
  print("format", "MERL");
  print("size", "90 x 90 x " + std::to_string(table.n_phi_d()) +
                    " cells (theta_h x theta_d x phi_d)" +
                    (table.n_phi_d() == 180 ? ", reciprocal" : ""));
  print("theta_i", "0 to 90");
}

void print_layout(const RglTable& table) {
  print("format", table.spectral() ? "RGL, spectral" : "RGL, RGB");
  print("size", std::to_string(table.theta_i().size()) + " incident angles");
  print("theta_i", degrees(static_cast<double>(table.theta_i().front())) + " to " +
                       degrees(static_cast<double>(table.theta_i().back())));
}

void print_layout(const GridTable& table) {
  const double half_cell = pi<double> / 4 / table.n_theta_in();
  print("format", "MBSDF");
  print("size", std::to_string(table.n_theta_in()) + " x " + std::to_string(table.n_theta_out()) +
                    " x " + std::to_string(table.n_phi()) + " cells (theta_in x theta_out x phi)");
  print("theta_i",
        degrees(half_cell) + " to " + degrees(pi<double> / 2 - half_cell) + " (cell centres)");
}

std::string measured_text(const BrdfTable& table) {
  const double angle = measured_to(table);
  return angle > 0 ? "to " + degrees(angle) + " degrees from the normal" : "less than half at every angle";
}

/// What a table lacks although each of its values can be used.
void print_doubts(const BrdfTable& table) {
  const CellCounts& cells = table.info().cells;
  const auto percent = static_cast<int>(std::lround(100.0 * static_cast<double>(cells.negative) / static_cast<double>(cells.total)));
  if (percent >= 1) print("doubt", std::to_string(percent) + " % of the cells are negative");
  const auto flat = [](const char* angle, int from) {
    constexpr int outermost = 87;  // constant beyond the last cells, as tables are
    if (from > 0 && from < outermost)
      print("doubt", std::string("flat: f_r does not change with ") + angle + " from " + std::to_string(from) + " degrees on");
  };
  const FlatFrom from = flat_from(table);
  flat("theta_i", from.theta_i);
  flat("theta_o", from.theta_o);
  if (const auto* grid = std::get_if<GridTable>(&table.data()); grid != nullptr && grid->has_transmission())
    print("doubt", "the transmission of the file is left out");
  if (const auto* rgl = std::get_if<RglTable>(&table.data())) {
    const CellCounts& densities = rgl->densities();
    if (densities.negative + densities.nonfinite > 0)
      print("doubt", "densities: " + std::to_string(densities.negative) + " negative and " +
                         std::to_string(densities.nonfinite) + " not finite of " + std::to_string(densities.total) + ", repaired");
  }
}

void print_table(const Options& options) {
  const ProgressLine progress("reading " + options.file);
  const BrdfTable table = load_table(options.file, options.policies);
  const BrdfTable::Info& info = table.info();
  print("name", info.name);
  std::visit([](const auto& data) { print_layout(data); }, table.data());
  print("file", bytes_text(info.source_bytes));
  print("description", info.description);
  const auto cells = [](std::uint64_t count, const char* kind, CellPolicy policy) {
    return std::to_string(count) + " " + kind + " (" + to_string(policy) + ")";
  };
  print("cells", std::to_string(info.cells.total) + ", of which " +
                     cells(info.cells.negative, "negative", options.policies.negative) + ", " +
                     cells(info.cells.nonfinite, "not finite", options.policies.nonfinite) + ", " +
                     cells(info.cells.missing, "missing", options.policies.missing));
  print("measured", measured_text(table));
  print_doubts(table);
  print_albedo([&](float theta_i) { return directional_albedo(table, theta_i); });
}

void print_model(const std::string& path) {
  const LobeModel model = load_model(path);
  print("name", model.name);
  print("format", "model of fitted lobes");
  print("size", std::to_string(model.lobes.size()) + " lobes, " +
                    std::to_string(model.specular_count()) + " of them specular");
  print("theta_i", "0 to 90");
  print("file", bytes_text(regular_file_size(path)));
  print("description", describe(model));
  const BrdfTable table = load_input(path);
  print_albedo([&](float theta_i) { return directional_albedo(table, theta_i); });
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

void print_stack(const std::string& path) {
  const StackFile file = load_stack(path);
  const std::vector<DiagramGrid>& diagrams = file.diagrams.diagrams;
  print("name", file.name);
  print("format", "stack of diagrams, version " + std::to_string(stack_file_version));
  print("source", file.source);
  print("chart", to_string(file.diagrams.chart));
  print("between", to_string(file.interpolation));
  print("size",
        std::to_string(diagrams.size()) + " diagrams of " +
            range(diagrams, [](const DiagramGrid& d) { return d.phi.size(); }) + " meridians x " +
            range(diagrams, [](const DiagramGrid& d) { return d.r.size(); }) + " parallels");
  print("theta_i",
        degrees(file.diagrams.theta_i.front()) + " to " + degrees(file.diagrams.theta_i.back()));
  print("file", bytes_text(regular_file_size(path)));
  const bool packed = file.storage == Storage::packed16;
  print("diagrams", bytes_text(packed ? PackedStack(file.diagrams).bytes() : Stack<float>(file.diagrams, file.interpolation).bytes()) +
                        " in memory, " + (packed ? "16" : "32") + " bits a crossing");
  if (file.colour.empty()) {
    print("colour", "none: sampling needs the table as well");
    return;
  }
  print("colour", std::to_string(file.colour.side()) + " x " +
                      std::to_string(file.colour.side() / 2) + " cells at " + std::to_string(file.colour.theta_i().size()) + " angles, " +
                      bytes_text(file.colour.bytes()) + " in memory");
  const CompactBsdf sampler(file.diagrams, file.interpolation, file.storage, file.colour);
  print_albedo([&](float theta_i) {
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

}  // namespace

void add_info(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("info", "What a table, a stack file or a fit holds");
  verb->add_option("FILE", options->file, "MERL, RGL or MBSDF table, stack file (.exr), or fit.json")
      ->required();
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "Examples:\n"
      "  gonio info chrome.binary\n"
      "  gonio info satin.bsdf --nonfinite reject\n"
      "  gonio info stack.exr");
  verb->callback([options] {
    if (is_exr(options->file)) {
      print_stack(options->file);
    } else if (is_model_file(options->file)) {
      print_model(options->file);
    } else {
      print_table(*options);
    }
  });
}

}  // namespace gonio
