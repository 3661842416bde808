#include <filesystem>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/polar_svg.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/options.h"
#include "tools/cli/written.h"
#include "tools/light/command.h"

namespace gonio {

void light_convert(const CLI::App& verb, const LightCommand& o) {
  const std::string extension = checked_extension(o.out, {".ies", ".ldt", ".exr", ".pbrt"});
  const bool image = extension == ".pbrt" || (extension == ".exr" && o.layout != "diagram");
  if (!image)
    for (const char* option : {"--filter", "--resolution"})
      if (verb.count(option) > 0)
        throw Error(std::string(option) + ": found one, expected none: only images are reconstructed");
  if (extension != ".exr" && verb.count("--layout") > 0)
    throw Error("--layout: found one, expected none: only .exr has layouts");
  const std::filesystem::path picture = std::filesystem::path(o.out) += extension == ".pbrt" ? ".exr" : "";
  check_not_input(o.out, {o.in});
  check_not_input(picture, {o.in});
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
    print_written(o.out);
    return;
  }
  if (!image)
    save_light(picture, light);
  else if (extension == ".pbrt" || o.layout == "octahedral")
    save_octahedral(picture, reconstruction(light.diagram, o.filter), o.resolution);
  else
    save_latlong(picture, reconstruction(light.diagram, o.filter), o.resolution);
  if (extension == ".pbrt")
    write_stream_atomically(
        o.out, [&](std::ostream& stream) { stream << pbrt_goniometric_light(picture.filename().string()); });
  print_written(o.out);
  if (extension == ".pbrt") print_written(picture);
}

void light_plot(const LightCommand& o) {
  checked_extension(o.out, {".svg"});
  check_not_input(o.out, {o.in});
  PolarPlot plot;
  plot.planes.clear();
  for (double c : o.planes) plot.planes.push_back(c * pi<double> / 180);
  plot.per_klm = o.per_klm;
  const std::string svg = polar_svg(load(o.in, o), plot);
  write_stream_atomically(o.out, [&](std::ostream& stream) { stream << svg; });
  print_written(o.out);
}

void light_solid(const LightCommand& o) {
  const std::string extension = checked_extension(o.out, {".obj", ".ply"});
  check_not_input(o.out, {o.in});
  const Luminaire light = load(o.in, o);
  const double largest = max_intensity(light.diagram);
  if (!(largest > 0)) throw Error(o.in + ": found a luminaire that is dark, expected some light");
  const Mesh mesh = photometric_solid(reconstruction(light.diagram, o.filter), o.rows, 2 * o.rows, 1 / largest);
  write_stream_atomically(o.out, [&](std::ostream& stream) {
    extension == ".obj" ? write_obj(stream, mesh, light.name) : write_ply(stream, mesh);
  });
  print_written(o.out);
}

}  // namespace gonio
