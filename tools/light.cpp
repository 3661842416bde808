#include <gonio/mapping/atomic_file.h>
#include <gonio/mapping/error.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/photometry.h>
#include <gonio/mapping/light/polar_svg.h>
#include <gonio/tools/light.h>
#include <gonio/tools/options.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <string>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

const std::map<std::string, LightFilter> filters{{"bilinear", LightFilter::bilinear},
                                                 {"catmull-rom", LightFilter::catmull_rom},
                                                 {"mitchell", LightFilter::mitchell},
                                                 {"bspline", LightFilter::bspline}};

struct Options {
  std::vector<std::string> files;
  std::string in, out, filter = "bilinear", normalise = "none", layout = "diagram";
  bool clockwise = false, per_klm = false;
  double ies_zero = 90, tilt = 0, target = 1;
  std::size_t lamp_set = 0;
  std::vector<double> planes{0, 90};
  int rows = 180, resolution = 512, draws = 1000;
  unsigned seed = 1;

  LightOptions reading() const {
    LightOptions o;
    o.clockwise = clockwise;
    o.ies_zero = ies_zero * degree;
    o.tilt = tilt * degree;
    o.lamp_set = lamp_set;
    return o;
  }
};

/// What every verb that reads a file accepts.
void add_reading(CLI::App& verb, Options& o) {
  verb.add_flag("--clockwise", o.clockwise,
                "horizontal angles run clockwise (about a third of type B files)");
  verb.add_option("--ies-zero", o.ies_zero,
                  "C plane that the 0-degree plane of IES files is; 0 keeps their labels")
      ->type_name("DEG")
      ->capture_default_str();
  verb.add_option("--tilt", o.tilt, "tilt of the lamp, for IES files with TILT factors")
      ->type_name("DEG")
      ->capture_default_str();
  verb.add_option("--lamp-set", o.lamp_set, "lamp set of an EULUMDAT file with several, from 0")
      ->type_name("N")
      ->capture_default_str();
}

void add_normalisation(CLI::App& verb, Options& o) {
  verb.add_option("--normalise", o.normalise,
                  "scale to a flux or to a largest intensity; none keeps cd as measured")
      ->check(CLI::IsMember({"none", "flux", "maximum"}))
      ->type_name("MODE")
      ->capture_default_str();
  verb.add_option("--target", o.target, "lm or cd to scale to")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void add_filter(CLI::App& verb, Options& o) {
  std::vector<std::string> names{"two-plane"};
  for (const auto& [name, filter] : filters) names.push_back(name);
  verb.add_option("--filter", o.filter,
                  "reconstruction between the measured angles: " + CLI::detail::join(names, ", "))
      ->check(CLI::IsMember(names))
      ->type_name("FILTER")
      ->capture_default_str();
}

Luminaire load(const std::string& file, const Options& o) {
  Deviations ignored;
  Luminaire light = load_any_light(file, o.reading(), ignored);
  const LightNormalisation mode = o.normalise == "flux"      ? LightNormalisation::flux
                                  : o.normalise == "maximum" ? LightNormalisation::maximum
                                                             : LightNormalisation::none;
  if (mode != LightNormalisation::none) {
    light.diagram = normalised(std::move(light.diagram), mode, o.target);
    // Lamps and watts belong to the intensities as measured.
    light.lamp_lumens.reset(), light.stated_lumens.reset();
    light.watts = 0;
    light.absolute = true;
  }
  return light;
}

Reconstruction reconstruction(const LightDiagram& diagram, const std::string& filter) {
  if (filter == "two-plane") return two_plane_reconstruction(in_frame(diagram, LightFrame{}));
  if (filter == "bilinear") return bilinear_reconstruction(diagram);
  return texture_reconstruction(LightTexture(diagram, filters.at(filter)));
}

std::string shown(const std::string& text) { return text.empty() ? "-" : text; }

void info(const Options& o) {
  for (const std::string& file : o.files) {
    Deviations deviations;
    const Luminaire light = load_any_light(file, o.reading(), deviations);
    const Photometry p = photometry(light.diagram);
    const auto line = [](const char* name, const std::string& value) {
      std::printf("  %-16s %s\n", name, value.c_str());
    };
    const auto text = [](const char* format, auto... values) {
      char buffer[200];
      std::snprintf(buffer, sizeof buffer, format, values...);
      return std::string(buffer);
    };
    std::printf("%s\n", file.c_str());
    line("format", light.format);
    line("manufacturer", shown(light.manufacturer));
    line("luminaire", shown(light.name));
    line("lamp", shown(light.lamp));
    line("unit", light.unit);
    line("angles", text("%zu C planes, %zu gamma, symmetry: ", light.diagram.c.size() - 1,
                        light.diagram.gamma.size()) +
                       to_string(light.symmetry));
    line("flux", text("%.2f lm, %.1f %% of it down", p.flux,
                      p.flux > 0 ? 100 * p.downward_flux / p.flux : 0.0));
    if (light.stated_lumens)
      line("stated flux", text("%.2f lm (%+.2f %%)", *light.stated_lumens,
                               100 * (p.flux / *light.stated_lumens - 1)));
    if (light.lamp_lumens)
      line("lamps",
           text("%.2f lm%s", *light.lamp_lumens, light.absolute ? ", absolute photometry" : ""));
    if (const auto ratio = light_output_ratio(light))
      line("output ratio", text("%.2f %%", 100 * *ratio));
    if (const auto e = efficacy(light))
      line("efficacy", text("%.2f lm/W at %.4g W", *e, light.watts));
    line("I max", text("%.2f cd at C %.4g, gamma %.4g degrees", p.max_cd, p.max_at.c / degree,
                       p.max_at.gamma / degree));
    line("beam angle", text("%.1f degrees in C0-C180, %.1f in C90-C270", p.c0.beam / degree,
                            p.c90.beam / degree));
    line("field angle", text("%.1f degrees in C0-C180, %.1f in C90-C270", p.c0.field / degree,
                             p.c90.field / degree));
    std::string zones;
    for (double z : p.zones) zones += text("%.4g ", z);
    line("zonal lumens", zones + "(every 10 degrees from the nadir)");
    if (!deviations.empty())
      line("deviations", text("%zu, see gonio light validate", deviations.size()));
  }
}

void validate(const Options& o) {
  int broken = 0, deviating = 0;
  for (const std::string& file : o.files) {
    Deviations deviations;
    try {
      const Luminaire light = load_any_light(file, o.reading(), deviations);
      const double total = flux(light.diagram);
      if (light.stated_lumens && std::abs(total / *light.stated_lumens - 1) > 0.05)
        deviations.push_back({0, "luminous flux", std::to_string(total) + " lm by quadrature",
                              std::to_string(*light.stated_lumens) + " lm as the file states"});
      std::printf("%s: %s, %zu deviation%s\n", file.c_str(), light.format.c_str(),
                  deviations.size(), deviations.size() == 1 ? "" : "s");
      deviating += !deviations.empty();
    } catch (const Error& error) {
      std::printf("%s: rejected\n  %s\n", file.c_str(), error.what());
      ++broken;
    }
    for (const Deviation& d : deviations) std::printf("  %s\n", to_string(d).c_str());
  }
  if (broken > 0)
    throw Error("found " + std::to_string(broken) + " of " + std::to_string(o.files.size()) +
                " files unusable" +
                (deviating > 0 ? ", " + std::to_string(deviating) + " with deviations" : "") +
                ", expected none");
}

void convert(const CLI::App& verb, const Options& o) {
  const std::string extension = checked_extension(o.out, {".ies", ".ldt", ".exr", ".pbrt"});
  const bool image = extension == ".pbrt" || (extension == ".exr" && o.layout != "diagram");
  if (!image)
    for (const char* option : {"--filter", "--resolution"})
      if (verb.count(option) > 0)
        throw Error(std::string(option) +
                    ": found one, expected none: only images are reconstructed");
  if (extension != ".exr" && verb.count("--layout") > 0)
    throw Error("--layout: found one, expected none: only .exr has layouts");
  const Luminaire light = load(o.in, o);
  if (extension == ".ies" || extension == ".ldt") {
    write_stream_atomically(o.out, [&](std::ostream& stream) {
      LightOptions writing;
      writing.ies_zero = o.reading().ies_zero;
      if (extension == ".ies")
        write_ies(stream, to_ies(light, writing));
      else
        write_eulumdat(stream, to_eulumdat(light));
    });
    return;
  }
  const std::filesystem::path picture = std::filesystem::path(o.out) +=
      extension == ".pbrt" ? ".exr" : "";
  write_atomically(picture, [&](const std::filesystem::path& temporary) {
    if (!image)
      save_light(temporary, light);
    else if (extension == ".pbrt" || o.layout == "octahedral")
      save_octahedral(temporary, reconstruction(light.diagram, o.filter), o.resolution);
    else
      save_latlong(temporary, reconstruction(light.diagram, o.filter), o.resolution);
  });
  if (extension == ".pbrt")
    write_stream_atomically(o.out, [&](std::ostream& stream) {
      stream << pbrt_goniometric_light(picture.filename().string());
    });
}

void plot(const Options& o) {
  checked_extension(o.out, {".svg"});
  PolarPlot plot;
  plot.planes.clear();
  for (double c : o.planes) plot.planes.push_back(c * degree);
  plot.per_klm = o.per_klm;
  const std::string svg = polar_svg(load(o.in, o), plot);
  write_stream_atomically(o.out, [&](std::ostream& stream) { stream << svg; });
}

void solid(const Options& o) {
  const std::string extension = checked_extension(o.out, {".obj", ".ply"});
  const Luminaire light = load(o.in, o);
  const double largest = max_intensity(light.diagram);
  if (!(largest > 0)) throw Error(o.in + ": found a luminaire that is dark, expected some light");
  const Mesh mesh =
      photometric_solid(reconstruction(light.diagram, o.filter), o.rows, 2 * o.rows, 1 / largest);
  write_stream_atomically(o.out, [&](std::ostream& stream) {
    extension == ".obj" ? write_obj(stream, mesh, light.name) : write_ply(stream, mesh);
  });
}

void sample(const CLI::App& verb, const Options& o) {
  const Luminaire light = load(o.in, o);
  if (verb.count("--quality") > 0) {
    std::printf("%-52s %12s %10s %8s\n", "method", "flux, lm", "relvar", "ns");
    for (const EmissionQuality& q : emission_quality(light.diagram))
      std::printf("%-52s %12.3f %10.2e %8.0f\n", q.method.c_str(), q.flux, q.relvar,
                  q.nanoseconds_per_draw);
    std::printf("%-52s %12.3f\n", "quadrature", flux(light.diagram));
    return;
  }
  const EmissionSampler<float> sampler(light.diagram);
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::printf("x,y,z,pdf,weight\n");
  for (int k = 0; k < o.draws; ++k) {
    const float u = uniform(random), v = uniform(random);
    const auto s = sampler.sample(u, v);
    std::printf("%.8g,%.8g,%.8g,%.8g,%.8g\n", double(s.direction.x), double(s.direction.y),
                double(s.direction.z), double(s.pdf), double(s.weight));
  }
}

void print_difference(const char* name, const LightDifference& d) {
  std::printf("%-14s rms %.5f  largest %.5f  Hausdorff %.5f  flux %+.3f %%\n", name, d.rms,
              d.largest, d.hausdorff, 100 * d.flux);
}

void compare_files(const Options& o) {
  std::printf("All but the flux as fractions of the largest intensity of the first.\n");
  if (o.files.size() == 2) {
    const Luminaire a = load(o.files[0], o), b = load(o.files[1], o);
    print_difference("second file", compare(bilinear_reconstruction(a.diagram),
                                            bilinear_reconstruction(b.diagram), o.rows));
    return;
  }
  if (o.files.size() != 1)
    throw Error("found " + std::to_string(o.files.size()) + " files, expected 1 or 2");
  const LightDiagram diagram = load(o.files[0], o).diagram;
  const Reconstruction reference = bilinear_reconstruction(diagram);
  std::printf("Against the bilinear diagram:\n");
  for (const char* name : {"catmull-rom", "mitchell", "bspline", "two-plane"})
    print_difference(name, compare(reference, reconstruction(diagram, name), o.rows));
  if (diagram.gamma.size() < 3 || diagram.gamma.size() % 2 == 0) {
    std::printf("No odd number of gamma angles: every second one cannot be left out.\n");
    return;
  }
  std::printf("Every second angle left out, and predicted from the rest:\n");
  const LightDiagram half = every_second(diagram);
  for (const char* name : {"bilinear", "catmull-rom", "mitchell", "bspline"}) {
    const Reconstruction rebuilt = reconstruction(half, name);
    const Prediction p = predict_left_out(diagram, rebuilt);
    const LightDifference d = compare(reference, rebuilt, o.rows);
    std::printf("%-14s rms %.5f  largest %.5f at %zu angles;  Hausdorff %.5f  flux %+.3f %%\n",
                name, p.rms, p.largest, p.angles, d.hausdorff, 100 * d.flux);
  }
}

}  // namespace

void add_light(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* light = app.add_subcommand("light", "Luminaires: IES, EULUMDAT and light EXR files");
  light->require_subcommand(1);
  const auto add = [&](const char* name, const char* what) {
    CLI::App* verb = light->add_subcommand(name, what);
    add_reading(*verb, *o);
    return verb;
  };
  const auto one_to_one = [&](CLI::App* verb, const char* out) {
    verb->add_option("IN", o->in, "IES, EULUMDAT or light EXR file, known by its content")
        ->required();
    verb->add_option("OUT", o->out, out)->required();
  };

  CLI::App* verb =
      add("info", "Format, flux, efficacy, intensities, beam and field angles, zonal lumens");
  verb->add_option("FILE", o->files, "IES, EULUMDAT or light EXR files")->required();
  verb->footer("Example:\n  gonio light info downlight.ies street.ldt");
  verb->callback([o] { info(*o); });

  verb = add("validate", "Every deviation from the standard; fails if a file cannot be used");
  verb->add_option("FILE", o->files, "IES, EULUMDAT or light EXR files")->required();
  verb->footer("Example:\n  gonio light validate *.ies *.ldt");
  verb->callback([o] { validate(*o); });

  verb =
      add("convert",
          "To IES (.ies), EULUMDAT (.ldt), EXR (.exr) or a pbrt-v4 light with its image (.pbrt)");
  one_to_one(
      verb, "File to write; its extension is its format. A .pbrt has its image beside it: OUT.exr");
  verb->add_option(
          "--layout", o->layout,
          ".exr: diagram (lossless, read by gonio), octahedral (equal-area) or latlong images")
      ->check(CLI::IsMember({"diagram", "octahedral", "latlong"}))
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
  verb->callback([o, verb] { convert(*verb, *o); });

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
  verb->callback([o] { plot(*o); });

  verb = add("solid", "Photometric solid as a mesh (.obj, .ply), I max at distance 1");
  one_to_one(verb, "Mesh to write");
  verb->add_option("--rows", o->rows, "steps of gamma; twice as many of C")
      ->check(CLI::Range(2, 2000))
      ->capture_default_str();
  add_filter(*verb, *o);
  verb->footer("Example:\n  gonio light solid street.ldt street.ply --filter catmull-rom");
  verb->callback([o] { solid(*o); });

  verb = add("sample", "Draws of the emission as CSV: direction, pdf [1/sr], weight [lm]");
  verb->add_option("IN", o->in, "IES, EULUMDAT or light EXR file")->required();
  verb->add_option("--draws", o->draws, "number of draws")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--seed", o->seed, "of the random numbers")->capture_default_str();
  verb->add_flag("--quality", "instead: relative variance and speed of this and other methods");
  add_normalisation(*verb, *o);
  verb->footer("Example:\n  gonio light sample street.ldt --quality");
  verb->callback([o, verb] { sample(*verb, *o); });

  verb = add("compare",
             "One file: its reconstructions, and how well they predict every second angle; two: "
             "their difference");
  verb->add_option("FILE", o->files, "one or two files")->required()->expected(1, 2);
  verb->add_option("--rows", o->rows, "steps of gamma to compare at; twice as many of C")
      ->check(CLI::Range(2, 2000))
      ->capture_default_str();
  verb->footer(
      "Example:\n  gonio light compare street.ldt\n  gonio light compare street.ldt street.ies");
  verb->callback([o] { compare_files(*o); });
}

}  // namespace gonio
