#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/brdf/ndf/image/shadowing.h>
#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/input.h"
#include "tools/cli/number.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/ndf/picture.h"
#include "tools/ndf/profile.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

struct Options {
  std::string in;
  std::filesystem::path out;
  int size = 512;
  CellPolicies policies;
};

class Clock {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

RadialNdf ggx(double alpha) {
  RadialNdf d(512, [=](double theta) {
    const double c2 = std::pow(std::cos(theta), 2), q = c2 + (1 - c2) / (alpha * alpha);
    return 1 / (pi<double> * alpha * alpha * q * q);
  });
  d.normalise();
  return d;
}

nlohmann::json summary(const RadialNdf& d) {
  const double slope = std::tan(d.median_theta());
  nlohmann::json json{{"median_theta_degrees", d.median_theta() / degree},
                      {"alpha_ggx", slope},
                      {"alpha_beckmann", slope / std::sqrt(std::log(2))},
                      {"alpha_ggx_of_peak", 1 / std::sqrt(pi<double> * d.eval(0))}};
  for (const int t : {10, 30, 50, 70, 80, 85}) json["g1"][std::to_string(t)] = d.g1(t * degree);
  return json;
}

/// The distribution that the file itself has, beside the extracted one.
nlohmann::json compare(const RadialNdf& extracted, const RadialNdf& stored, double stored_area, const RglTable& table) {
  nlohmann::json json = summary(stored);
  json["projected_area_as_stored"] = stored_area;
  // Half the integral of |difference| cos(theta) d omega: the share of the surface on other normals.
  RadialNdf difference(static_cast<int>(stored.values().size()),
                       [&](double theta) { return std::abs(extracted.eval(theta) - stored.eval(theta)); });
  json["total_variation"] = difference.projected_area() / 2;
  double g1 = 0, sigma = 0;
  for (int t = 0; t <= 85; ++t) {
    g1 = std::max(g1, std::abs(extracted.g1(t * degree) - stored.g1(t * degree)));
    sigma = std::max(
        sigma, std::abs(stored.sigma(t * degree) - static_cast<double>(table.sigma(static_cast<float>(t * degree)))));
  }
  json["largest_g1_difference_to_85_degrees"] = g1;
  json["sigma_of_its_ndf_against_its_sigma"] = sigma;
  for (const int t : {0, 2, 5, 10, 20, 30, 45, 60, 75})
    json["extracted_over_stored"][std::to_string(t)] =
        stored.eval(t * degree) > 0 ? extracted.eval(t * degree) / stored.eval(t * degree) : 0;
  return json;
}

/// What is known of IN before its image.
struct Source {
  std::string name, kind;
  DiskImage image;
  nlohmann::json json;
  std::vector<NdfProfile> profiles;
};

Source read(const Options& options) {
  Source source;
  source.name = std::filesystem::path(options.in).stem().string();
  if (is_exr(options.in)) {
    source.kind = "image";
    source.image = load_ndf_image(options.in);
    return source;
  }
  const BrdfTable table = load_input(options.in, options.policies);
  source.kind = table.info().format;
  const Clock clock;
  ExtractedNdf extracted = [&] {
    try {
      return extract_ndf(table);
    } catch (const Error& error) {
      throw Error(options.in + ": " + error.what());
    }
  }();
  source.json["seconds"]["extraction"] = clock.seconds();
  source.json["extraction"] = {{"masking", to_string(extracted.masking)},
                               {"measured_to_degrees", extracted.measured_to / degree},
                               {"iterations", extracted.iterations},
                               {"last_relative_change", extracted.change}};
  source.json["radial"] = summary(extracted.ndf);
  source.profiles.push_back({"extracted from retro-reflection", "#222", "none", extracted.ndf});
  if (const auto* rgl = std::get_if<RglTable>(&table.data())) {
    RadialNdf stored(512, [&](double theta) { return static_cast<double>(rgl->ndf(static_cast<float>(theta))); });
    const double area = stored.normalise();
    source.json["file_ndf"] = compare(extracted.ndf, stored, area, *rgl);
    source.profiles.push_back({"the file's own ndf", "#d95f02", "none", std::move(stored)});
  }
  source.profiles.push_back(
      {"GGX with the extracted median", "#2166ac", "5 4", ggx(std::tan(extracted.ndf.median_theta()))});
  source.image = rasterise(
      options.size, [&](const Vec3<double>& h) { return extracted.ndf.eval(std::atan2(std::hypot(h.x, h.y), h.z)); });
  return source;
}

/// Measures the direct sum for some directions: what the whole image would take, and how far the fast
/// method is from it.
void measure_direct(const Shadowing& shadowing, int size, nlohmann::json& json) {
  constexpr int count = 64;
  double worst = 0, time = 0;
  for (int k = 0; k < count; ++k) {
    const double theta = 85 * degree * (k + 0.5) / count, phi = 2.399963 * k;  // golden angle: all azimuths
    const Vec3<double> w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const std::clock_t start = std::clock();  // processor time: one thread, whatever else runs
    const double direct = shadowing.sigma_direct(w);
    time += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    worst = std::max(worst, std::abs(w.z / direct - shadowing.g1(w)));
  }
  json["g1_fast_against_direct"] = worst;
  json["seconds"]["direct_extrapolated"] = time / count * pi<double> / 4 * size * size;
  json["direct_directions_measured"] = count;
}

void write_markdown(std::ostream& out, const nlohmann::json& j, const std::string& name) {
  out << "# Normal distribution of " << name << "\n\ngonio " GONIO_VERSION ". " << j["size"] << " x " << j["size"]
      << " pixels"
      << (j["kind"] == "image"
              ? ", read from an image"
              : ", extracted from the retro-reflection of a table (" + j["kind"].get<std::string>() + ")")
      << ".\n\n![D](ndf.svg)\n\n![G1](g1.svg)\n\n";
  if (j["kind"] != "image") out << "![profiles](profile.svg)\n\n";
  const auto row = [&](const std::string& what, const nlohmann::json& value) {
    out << "| " << what << " | " << number(value.get<double>(), 4) << " |\n";
  };
  out << "| | |\n|---|---|\n";
  row("projected area (integral of D cos) before normalisation", j["projected_area_before"]);
  row("projected area after", j["projected_area_after"]);
  row("microsurface area (integral of D)", j["microsurface_area"]);
  row("alpha along x, if GGX (median slope)", j["alpha_ggx_x"]);
  row("alpha along y, if GGX (median slope)", j["alpha_ggx_y"]);
  row("G1: fast method against direct sum, largest difference", j["g1_fast_against_direct"]);
  row("seconds of G1 for all directions", j["seconds"]["g1"]);
  row("processor seconds of the same", j["seconds"]["g1_processor"]);
  row("processor seconds by the direct sum, extrapolated from 64 directions", j["seconds"]["direct_extrapolated"]);
  const auto radial = [&](const nlohmann::json& r, const std::string& what) {
    out << "\n## " << what << "\n\n| | |\n|---|---|\n";
    row("median theta [degrees]", r["median_theta_degrees"]);
    row("alpha of the GGX with that median", r["alpha_ggx"]);
    row("alpha of the Beckmann with that median", r["alpha_beckmann"]);
    row("alpha of the GGX with that peak", r["alpha_ggx_of_peak"]);
    for (const char* t : {"10", "30", "50", "70", "80", "85"}) row(std::string("G1 at ") + t + " degrees", r["g1"][t]);
  };
  if (j.contains("radial")) {
    radial(j["radial"], "Extracted");
    row("last angle of the retro-reflection [degrees]", j["extraction"]["measured_to_degrees"]);
    out << "| masking and shadowing | " << j["extraction"]["masking"].get<std::string>() << " |\n";
  }
  if (j.contains("file_ndf")) {
    const nlohmann::json& f = j["file_ndf"];
    radial(f, "The file's own ndf");
    row("projected area as stored", f["projected_area_as_stored"]);
    row("total variation from the extracted (0 the same, 1 disjoint)", f["total_variation"]);
    row("largest difference of G1 to 85 degrees", f["largest_g1_difference_to_85_degrees"]);
    row("largest difference of sigma from the file's own sigma", f["sigma_of_its_ndf_against_its_sigma"]);
    for (const char* t : {"0", "2", "5", "10", "20", "30", "45", "60", "75"})
      row(std::string("extracted / stored at ") + t + " degrees", f["extracted_over_stored"][t]);
  }
}

void ndf(const Options& options) {
  if (options.size < 16 || options.size > 4096)
    throw Error("--size: found " + std::to_string(options.size) + ", expected 16 to 4096");
  check_not_input(options.out, {"ndf.exr", "g1.exr", "ndf.svg", "g1.svg", "profile.svg", "ndf.json", "ndf.md"},
                  {options.in});
  Source source = [&] {
    const ProgressLine line("reading " + options.in);
    return read(options);
  }();
  const ProgressLine line("computing shadowing of " + options.in);
  DiskImage& d = source.image;
  nlohmann::json json = std::move(source.json);
  json["input"] = options.in;
  json["kind"] = source.kind;
  json["size"] = d.size;
  try {
    json["projected_area_before"] = normalise(d);
  } catch (const Error& error) {
    throw Error(options.in + ": " + error.what());
  }
  make_folder(options.out, "ndf.json");
  json["projected_area_after"] = projected_area(d);
  json["microsurface_area"] = microsurface_area(d);
  const MedianSlopes slopes = median_slopes(d);
  json["alpha_ggx_x"] = slopes.x * std::sqrt(3);
  json["alpha_ggx_y"] = slopes.y * std::sqrt(3);
  const Clock clock;
  const std::clock_t start = std::clock();
  const Shadowing shadowing(d);
  const DiskImage g1 = g1_image(shadowing, d.size);
  json["seconds"]["g1"] = clock.seconds();
  json["seconds"]["g1_processor"] = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  measure_direct(shadowing, d.size, json);

  save_disk_image(options.out / "ndf.exr", d, "D");
  save_disk_image(options.out / "g1.exr", g1, "G1");
  write_disk_picture(options.out / "ndf.svg", d, ndf_contrast(d), "Normal distribution D of " + source.name, " 1/sr");
  write_disk_picture(options.out / "g1.svg", g1, g1_contrast(g1), "Shadowing G1 of " + source.name, "");
  if (!source.profiles.empty())
    write_ndf_profiles(options.out / "profile.svg", "Normal distribution and shadowing of " + source.name,
                       source.profiles);
  write_stream_atomically(options.out / "ndf.json", [&](std::ostream& out) { out << json.dump(1) << '\n'; });
  write_stream_atomically(options.out / "ndf.md", [&](std::ostream& out) { write_markdown(out, json, source.name); });
  std::cout << "projected area " << number(json["projected_area_before"], 4) << ", normalised "
            << number(json["projected_area_after"], 4) << "; G1 of all directions in "
            << number(json["seconds"]["g1"], 4) << " s\n"
            << "written: " << (options.out / "ndf.md").string() << ", ndf.json, ndf.exr, g1.exr, ndf.svg, g1.svg"
            << (source.profiles.empty() ? "" : ", profile.svg") << '\n';
}

}  // namespace

void add_ndf(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("ndf", "The normal distribution of a table or an image, and its shadowing");
  verb->add_option("IN", options->in, "Table, model, or OpenEXR image of a normal distribution")->required();
  verb->add_option("-o,--output", options->out, "Folder for ndf.exr, g1.exr, ndf.json, ndf.md and the pictures")
      ->required();
  verb->add_option("--size", options->size, "Pixels along a side of the images made from a table")
      ->capture_default_str();
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "Images show the hemisphere flattened on its disk: x to the right, y up, the circle touches the sides.\n\n"
      "Examples:\n"
      "  gonio ndf satin.bsdf -o satin\n"
      "  gonio ndf weave.exr -o weave");
  verb->callback([options] { ndf(*options); });
}

}  // namespace gonio
