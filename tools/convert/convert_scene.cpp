#include "tools/convert/convert_scene.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include <gonio/brdf/build/budget/split_budget.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/failures.h"
#include "tools/cli/input.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/convert/scene_manifest.h"
#include "tools/convert/stack_comments.h"

namespace gonio {
namespace {

using nlohmann::ordered_json;

using Curve = std::vector<BudgetPoint>;

/// The stacks that a material may become are built to these relative variances.
constexpr double tolerances[] = {1, 0.4, 0.15, 0.06, 0.025, 0.01, 0.004};

std::vector<CompactFit> fits_of(const SceneMaterial& material, std::size_t bytes, const std::string& task) {
  ProgressLine progress(task);
  const BrdfTable table = load_input(material.file);
  BsdfOptions options;
  options.budget = std::max(bytes, options.budget);  // what is too large after all, the split says
  options.incidence = material.incidence;
  try {
    return compact_curve(table, {std::begin(tolerances), std::end(tolerances)}, options,
                         [&](double share) { progress.update(share); });
  } catch (const Error& error) {
    throw Error(material.name + ": " + error.what());
  }
}

/// Of every curve the best point within the same number of bytes; the smallest if none is.
std::vector<std::size_t> split_evenly(const std::vector<Curve>& curves, std::size_t bytes) {
  const std::size_t each = bytes / curves.size();
  std::vector<std::size_t> chosen;
  for (const Curve& curve : curves) {
    const auto better = [&](const BudgetPoint& a, const BudgetPoint& b) {
      if (a.bytes > each || b.bytes > each) return a.bytes < b.bytes;
      return a.variance < b.variance;
    };
    chosen.push_back(static_cast<std::size_t>(std::min_element(curve.begin(), curve.end(), better) - curve.begin()));
  }
  return chosen;
}

/// A choice of one stack for every material.
struct Split {
  std::vector<std::size_t> chosen;
  std::size_t bytes = 0;
  double variance = 0;

  Split(std::vector<std::size_t> points, const std::vector<Curve>& curves, const std::vector<double>& shares)
      : chosen(std::move(points)) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      bytes += curves[k][chosen[k]].bytes;
      variance += shares[k] * curves[k][chosen[k]].variance;
    }
  }
};

ordered_json material_json(const SceneMaterial& material, const std::vector<CompactFit>& fits, std::size_t chosen,
                           std::size_t even) {
  const CompactFit& fit = fits[chosen];
  ordered_json json{{"name", material.name},
                    {"file", material.name + ".exr"},
                    {"source", material.file.filename().string()},
                    {"share", material.share},
                    {"incidence", material.incidence.empty() ? "unknown" : "recorded"},
                    {"bytes", fit.bytes},
                    {"relvar", fit.quality.mean_relvar},
                    {"contribution", material.share * fit.quality.mean_relvar},
                    {"worst_relvar", fit.quality.worst_relvar},
                    {"evaluation_error", fit.quality.eval_error},
                    {"albedo_error", fit.quality.albedo_error},
                    {"chart", to_string(fit.data.diagrams.chart)},
                    {"incident_angles", fit.data.diagrams.theta_i.size()},
                    {"even_split", {{"bytes", fits[even].bytes}, {"relvar", fits[even].quality.mean_relvar}}}};
  for (const CompactFit& point : fits)
    json["curve"].push_back({{"bytes", point.bytes}, {"relvar", point.quality.mean_relvar}});
  return json;
}

void print(const std::vector<SceneMaterial>& scene, const std::vector<Curve>& curves, const Split& split,
           const Split& even) {
  std::printf("%-24s %7s %9s %9s %12s %11s %11s\n", "material", "share", "bytes", "relvar", "share*relvar",
              "even bytes", "even relvar");
  for (std::size_t k = 0; k < scene.size(); ++k) {
    const BudgetPoint &s = curves[k][split.chosen[k]], &e = curves[k][even.chosen[k]];
    std::printf("%-24s %7.4f %9zu %9.3g %12.3g %11zu %11.3g\n", scene[k].name.c_str(), scene[k].share, s.bytes,
                s.variance, scene[k].share * s.variance, e.bytes, e.variance);
  }
  std::printf("%-24s %7s %9zu %9s %12.3g %11zu\n", "sum", "1", split.bytes, "", split.variance, even.bytes);
  std::printf("summed variance: %.3g; evenly split: %.3g", split.variance, even.variance);
  if (split.variance > 0) std::printf(", %.2f times that", even.variance / split.variance);
  std::printf("\nbytes are those of 16 bits a crossing\n");
}

/// None of the inputs would be replaced.
void check_outputs(const std::filesystem::path& path, const std::vector<SceneMaterial>& scene,
                   const std::filesystem::path& out) {
  std::vector<std::filesystem::path> inputs{path};
  std::vector<std::string> outputs{"scene-budget.json"};
  for (const SceneMaterial& material : scene) {
    inputs.push_back(material.file);
    outputs.push_back(material.name + ".exr");
  }
  check_not_input(out, outputs, inputs);
}

/// Those that load: building stacks takes long, and is not begun before all are known.
std::vector<SceneMaterial> usable_materials(const std::vector<SceneMaterial>& scene, Failures& failures) {
  std::vector<SceneMaterial> usable;
  for (const SceneMaterial& material : scene) {
    const ProgressLine progress("reading " + material.file.string());
    if (failures.survives([&] { load_input(material.file); })) usable.push_back(material);
  }
  return usable;
}

}  // namespace

void convert_scene(const std::filesystem::path& path, std::size_t bytes, const std::filesystem::path& out) {
  const std::vector<SceneMaterial> all = load_scene(path);
  if (std::filesystem::exists(out) && !std::filesystem::is_directory(out))
    throw Error(out.string() + ": found a file, expected a folder");
  check_outputs(path, all, out);
  Failures failures;
  const std::vector<SceneMaterial> usable = usable_materials(all, failures);
  if (!usable.empty()) make_folder(out, "scene-budget.json");
  std::vector<SceneMaterial> scene;  // what becomes stacks
  std::vector<std::vector<CompactFit>> fits;
  std::vector<Curve> curves;
  std::vector<double> shares;
  for (std::size_t k = 0; k < usable.size(); ++k) {
    const SceneMaterial& material = usable[k];
    const bool built = failures.survives([&] {
      fits.push_back(fits_of(material, bytes,
                             "building the stacks of " + material.name + " (" + std::to_string(k + 1) + " of " +
                                 std::to_string(usable.size()) + ")"));
    });
    if (!built) continue;
    scene.push_back(material);
    curves.emplace_back();
    for (const CompactFit& fit : fits.back()) curves.back().push_back({fit.bytes, fit.quality.mean_relvar});
    shares.push_back(material.share);
  }
  if (scene.empty()) failures.throw_any(all.size());
  const Split split(split_budget(curves, shares, bytes), curves, shares);
  const Split even(split_evenly(curves, bytes), curves, shares);

  ordered_json json{{"format", "gonio scene budget"},
                    {"version", 1},
                    {"gonio", GONIO_VERSION},
                    {"scene", path.filename().string()},
                    {"budget_bytes", bytes},
                    {"bytes", split.bytes},
                    {"summed_variance", split.variance},
                    {"even_split", {{"bytes", even.bytes}, {"summed_variance", even.variance}}}};
  for (std::size_t k = 0; k < scene.size(); ++k) {
    CompactFit& fit = fits[k][split.chosen[k]];
    json["materials"].push_back(material_json(scene[k], fits[k], split.chosen[k], even.chosen[k]));
    StackFile file;
    file.bsdf = std::move(fit.data);
    file.name = scene[k].name;
    file.source = scene[k].file.filename().string();
    file.comments = stack_comments(file.source, "--scene " + path.filename().string() + " --budget " +
                                                    std::to_string(bytes) + ": " + describe(fit.quality));
    save_stack(out / (scene[k].name + ".exr"), file);
  }
  write_stream_atomically(out / "scene-budget.json", [&](std::ostream& stream) {
    stream << json.dump(1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  });
  print(scene, curves, split, even);
  for (const SceneMaterial& material : scene) print_written(out / (material.name + ".exr"));
  print_written(out / "scene-budget.json");
  failures.throw_any(all.size());
}

}  // namespace gonio
