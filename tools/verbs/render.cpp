#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/number.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/render/data_folder.h"
#include "tools/render/image/tone_map.h"
#include "tools/render/load_scene.h"
#include "tools/render/trace/film.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

struct Options {
  SceneChoice choice;
  std::string sampling;
  fs::path out = "render.exr";
  int samples = 64;
  std::optional<double> seconds;  // in place of samples
  float exposure = 1;
  RenderOptions render;
};

class Clock {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What is asked for; a measured material that comes with the program if nothing is.
Scene load(const Options& options) {
  SceneChoice choice = options.choice;
  if (choice.scene.empty() && choice.material.empty())
    choice.material = (data_folder() / "materials/cc_iris_purple_gem.exr").string();
  Scene scene = choice.load();
  if (!options.sampling.empty()) {
    const auto method = parse_sampling_method(options.sampling);
    if (!method)
      throw Error("--sampling: found '" + options.sampling + "', expected " +
                  one_of(sampling_method_names(), options.sampling));
    for (Material& m : scene.materials)
      if (m.table) m.sampling = *method;
  }
  return scene;
}

void save(const Options& options, const std::string& extension, const Film& film) {
  const RgbImage radiance = film.radiance();
  if (extension == ".png") {
    const std::string bytes = tone_mapped_png(radiance, options.exposure);
    write_stream_atomically(options.out, [&](std::ostream& out) { out << bytes; });
    return;
  }
  const RgbImage albedo = film.albedo(), normal = film.normal(), variance = film.variance();
  const std::vector<std::string> rgb{"R", "G", "B"};
  save_layers(options.out, {{"", rgb, &radiance},
                            {"albedo.", rgb, &albedo},
                            {"normal.", {"X", "Y", "Z"}, &normal},
                            {"variance.", rgb, &variance}});
}

void render(const CLI::App& verb, const Options& options) {
  const std::string extension = checked_extension(options.out, {".exr", ".png"});
  if (options.samples < 1 || options.samples > (1 << 24))
    throw Error("--samples: found " + std::to_string(options.samples) + ", expected 1 to 16777216");
  if (options.seconds && verb.count("--samples") > 0)
    throw Error("--samples: found one, expected none beside --seconds, which takes as many as fit");
  if (options.seconds && !(*options.seconds > 0 && *options.seconds <= 1e9))
    throw Error("--seconds: found " + number(*options.seconds) + ", expected more than 0, to 1e9");
  if (!(options.exposure > 0 && options.exposure <= 1e9f))
    throw Error("--exposure: found " + std::to_string(options.exposure) + ", expected more than 0, to 1e9");
  check_render_options(options.render);
  check_writable(options.out);
  const Clock preparing;
  Scene scene = [&] {
    const ProgressLine line("reading the scene");
    return load(options);
  }();
  check_not_input(options.out, scene.files);
  {
    ProgressLine line("building the samplers");
    build_materials(scene, [&](double share) { line.update(share); });
  }
  Film film(scene, options.render);
  const double prepared = preparing.seconds();
  const Clock clock;
  {
    ProgressLine line("rendering " + options.out.string());
    if (options.seconds) {
      // One sample at a time: the time that one takes tells whether another fits.
      while (film.samples() == 0 || clock.seconds() * (film.samples() + 1) / film.samples() <= *options.seconds) {
        film.add_samples(1);
        line.update(clock.seconds() / *options.seconds);
      }
    } else {
      film.add_samples(options.samples, [&](double share) { line.update(share); });
    }
  }
  save(options, extension, film);
  std::printf("%d x %d pixels, %d samples each: %.1f s, after %.1f s for scene and samplers\n", scene.camera.width,
              scene.camera.height, film.samples(), clock.seconds(), prepared);
  print_written(options.out);
}

}  // namespace

void add_render(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("render", "A picture of a scene, or of one material, by path tracing");
  add_scene_choice(*verb, options->choice);
  verb->add_option("-o,--output", options->out, "OpenEXR image with albedo, normal and variance, or tone-mapped .png")
      ->capture_default_str();
  verb->add_option("--samples", options->samples, "Paths a pixel")->capture_default_str();
  verb->add_option("--seconds", options->seconds,
                   "Time for rendering, more than 0, instead of --samples: as many as fit, at least one");
  verb->add_option(
      "--sampling", options->sampling,
      "Sampling method of all tables, instead of the scene's: " + CLI::detail::join(sampling_method_names(), ", "));
  verb->add_option("--exposure", options->exposure, "Factor of radiances in a .png")->capture_default_str();
  add_render_options(*verb, options->render);
  verb->footer(
      "With neither SCENE nor --material: a measured material of the folder data/ that comes with gonio.\n\n"
      "Examples:\n"
      "  gonio render -o iris.png\n"
      "  gonio render --material satin.bsdf -o satin.png\n"
      "  gonio render --material satin.bsdf --sampling cosine -o noisy.png\n"
      "  gonio render scene.json -o picture.exr --samples 1024");
  verb->callback([options, verb] { render(*verb, *options); });
}

}  // namespace gonio
