#include <memory>

#include <CLI/CLI.hpp>

#include "tools/cli/options.h"
#include "tools/light/command.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

/// What every verb that reads a file accepts.
void add_reading(CLI::App& verb, LightCommand& o) {
  verb.add_flag("--clockwise", o.clockwise, "horizontal angles run clockwise (about a third of type B files)");
  verb.add_option("--ies-zero", o.ies_zero,
                  "C plane that the 0-degree plane of IES files is; 0 keeps their labels, as files need "
                  "that put C0 across the lamp (gonio light info says when one looks like it)")
      ->type_name("DEG")
      ->capture_default_str();
  verb.add_option("--tilt", o.tilt, "tilt of the lamp, for IES files with TILT factors")
      ->type_name("DEG")
      ->capture_default_str();
  verb.add_option("--lamp-set", o.lamp_set, "lamp set of an EULUMDAT file with several, from 0")
      ->type_name("N")
      ->capture_default_str();
}

void add_normalisation(CLI::App& verb, LightCommand& o) {
  verb.add_option("--normalise", o.normalise, "scale to a flux or to a largest intensity; none keeps cd as measured")
      ->check(known_word({"none", "flux", "maximum"}))
      ->type_name("none|flux|maximum")
      ->capture_default_str();
  verb.add_option("--target", o.target, "lm or cd to scale to")->check(CLI::PositiveNumber)->capture_default_str();
}

void add_filter(CLI::App& verb, LightCommand& o) {
  const std::vector<std::string> names = reconstruction_names();
  verb.add_option("--filter", o.filter, "reconstruction between the measured angles: " + CLI::detail::join(names, ", "))
      ->check(known_word(names))
      ->type_name("FILTER")
      ->capture_default_str();
}

}  // namespace

void add_light(CLI::App& app) {
  auto o = std::make_shared<LightCommand>();
  CLI::App* light = app.add_subcommand("light", "Luminaires: IES, EULUMDAT and light EXR files");
  light->require_subcommand(1);
  const auto add = [&](const char* name, const char* what) {
    CLI::App* verb = light->add_subcommand(name, what);
    add_reading(*verb, *o);
    return verb;
  };
  const auto one_to_one = [&](CLI::App* verb, const char* out) {
    verb->add_option("IN", o->in, "IES, EULUMDAT or light EXR file, known by its content")->required();
    verb->add_option("OUT", o->out, out)->required();
  };

  CLI::App* verb = add("info", "Format, flux, efficacy, intensities, beam and field angles, zonal lumens");
  verb->add_option("FILE", o->files, "IES, EULUMDAT or light EXR files")->required();
  verb->footer("Example:\n  gonio light info downlight.ies street.ldt");
  verb->callback([o] { light_info(*o); });

  verb = add("validate", "Every deviation from the standard; fails if a file cannot be used");
  verb->add_option("FILE", o->files, "IES, EULUMDAT or light EXR files")->required();
  verb->footer("Example:\n  gonio light validate *.ies *.ldt");
  verb->callback([o] { light_validate(*o); });

  verb = add("convert", "To IES (.ies), EULUMDAT (.ldt), EXR (.exr) or a pbrt-v4 light with its image (.pbrt)");
  one_to_one(verb, "File to write; its extension is its format. A .pbrt has its image beside it: OUT.exr");
  verb->add_option("--layout", o->layout,
                   ".exr: diagram (lossless, read by gonio), octahedral (equal-area) or latlong images")
      ->check(known_word({"diagram", "octahedral", "latlong"}))
      ->type_name("LAYOUT")
      ->capture_default_str();
  verb->add_option("--resolution", o->resolution, "height of images in pixels")
      ->check(CLI::Range(8, 16384))
      ->type_name("N")
      ->capture_default_str();
  add_filter(*verb, *o);
  add_normalisation(*verb, *o);
  verb->footer(
      "Examples:\n"
      "  gonio light convert floodlight.ies floodlight.ldt --clockwise\n"
      "  gonio light convert downlight.ldt downlight.pbrt --filter bspline\n"
      "  gonio light convert downlight.ldt sphere.exr --layout latlong");
  verb->callback([o, verb] { light_convert(*verb, *o); });

  verb = add("plot", "Goniometric polar diagram (.svg)");
  one_to_one(verb, "SVG file to write");
  verb->add_option("--planes", o->planes, "C of up to 4 planes, each drawn with its opposite half")
      ->type_name("DEG")
      ->expected(1, 4)
      ->delimiter(',')
      ->capture_default_str();
  verb->add_flag("--klm", o->per_klm, "cd per 1000 lm of the luminaire instead of cd");
  add_normalisation(*verb, *o);
  verb->footer("Example:\n  gonio light plot street.ldt street.svg --planes 0,90 --klm");
  verb->callback([o] { light_plot(*o); });

  verb = add("solid", "Photometric solid as a mesh (.obj, .ply), I max at distance 1");
  one_to_one(verb, "Mesh to write");
  verb->add_option("--rows", o->rows, "steps of gamma; twice as many of C")
      ->check(CLI::Range(2, 2000))
      ->capture_default_str();
  add_filter(*verb, *o);
  verb->footer("Example:\n  gonio light solid street.ldt street.ply --filter catmull-rom");
  verb->callback([o] { light_solid(*o); });

  verb = add("sample", "Draws of the emission as CSV: direction, pdf [1/sr], weight [lm]");
  verb->add_option("IN", o->in, "IES, EULUMDAT or light EXR file")->required();
  verb->add_option("--draws", o->draws, "number of draws")->check(CLI::PositiveNumber)->capture_default_str();
  verb->add_option("--seed", o->seed, "of the random numbers")->capture_default_str();
  verb->add_flag("--quality", "instead: relative variance and speed of this and other methods");
  add_normalisation(*verb, *o);
  verb->footer("Example:\n  gonio light sample street.ldt --quality");
  verb->callback([o, verb] { light_sample(*verb, *o); });

  verb = add("compare",
             "One file: its reconstructions, and how well they predict every second angle; two: "
             "their difference");
  verb->add_option("FILE", o->files, "one or two files")->required()->expected(1, 2);
  verb->add_option("--rows", o->rows, "steps of gamma to compare at; twice as many of C")
      ->check(CLI::Range(2, 2000))
      ->capture_default_str();
  verb->footer("Example:\n  gonio light compare street.ldt\n  gonio light compare street.ldt street.ies");
  verb->callback([o] { light_compare(*o); });
}

}  // namespace gonio
