#include "tools/light/command.h"

#include <map>

#include <gonio/brdf/formats/sniff.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/photometry.h>
#include <gonio/mapping/light/texture/light_texture.h>

namespace gonio {
namespace {

const std::map<std::string, LightFilter> filters{{"bilinear", LightFilter::bilinear},
                                                 {"catmull-rom", LightFilter::catmull_rom},
                                                 {"mitchell", LightFilter::mitchell},
                                                 {"bspline", LightFilter::bspline}};

}  // namespace

LightOptions LightCommand::reading() const {
  constexpr double degree = pi<double> / 180;
  LightOptions o;
  o.clockwise = clockwise;
  o.ies_zero = ies_zero * degree;
  o.tilt = tilt * degree;
  o.lamp_set = lamp_set;
  return o;
}

Luminaire load_as_is(const std::string& file, const LightCommand& o, Problems& deviations) {
  if (!is_light_file(file))
    throw Error(file + ": found " + describe_file(file) + ", expected a luminaire (IES, EULUMDAT or light EXR)");
  return load_any_light(file, o.reading(), deviations);
}

Luminaire load(const std::string& file, const LightCommand& o) {
  Problems ignored;
  Luminaire light = load_as_is(file, o, ignored);
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

std::vector<std::string> reconstruction_names() {
  std::vector<std::string> names{"two-plane"};
  for (const auto& [name, filter] : filters) names.push_back(name);
  return names;
}

Reconstruction reconstruction(const LightDiagram& diagram, const std::string& filter) {
  if (filter == "two-plane") return two_plane_reconstruction(in_frame(diagram, LightFrame{}));
  if (filter == "bilinear") return bilinear_reconstruction(diagram);
  return texture_reconstruction(LightTexture(diagram, filters.at(filter)));
}

}  // namespace gonio
