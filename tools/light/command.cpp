#include <gonio/brdf/bytes.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/sniff.h>
#include <gonio/mapping/error.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/light_texture.h>
#include <gonio/mapping/light/photometry.h>
#include <gonio/tools/input.h>
#include <gonio/tools/light/command.h>

#include <filesystem>
#include <map>

namespace gonio {
namespace {

const std::map<std::string, LightFilter> filters{{"bilinear", LightFilter::bilinear},
                                                 {"catmull-rom", LightFilter::catmull_rom},
                                                 {"mitchell", LightFilter::mitchell},
                                                 {"bspline", LightFilter::bspline}};

/// What a file that is no luminaire is, and what takes it; empty if that is not known.
std::string other_kind(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) return {};
  if (is_exr(file))
    return "an EXR file without a luminaire (gonio info takes stack files; images are only "
           "written)";
  switch (sniff_format(file)) {
    case TableFormat::merl:
      return "a measured BRDF (MERL), which gonio info and gonio convert take";
    case TableFormat::rgl:
      return "a measured BRDF (RGL), which gonio info and gonio convert take";
    case TableFormat::mbsdf:
      return "a measured BRDF (MBSDF), which gonio info and gonio convert take";
    case TableFormat::unknown:
      break;
  }
  if (is_model_file(file)) return "a JSON file (gonio info takes fits, gonio render takes scenes)";
  if (read_bytes(file, 40).find("version https://git-lfs") == 0)
    return "a Git LFS pointer, which only names the file (git lfs pull brings it)";
  return {};
}

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

Luminaire load_as_is(const std::string& file, const LightCommand& o, Deviations& deviations) {
  if (!is_light_file(file))
    if (const std::string kind = other_kind(file); !kind.empty())
      throw Error(file + ": found " + kind + ", expected a luminaire (IES, EULUMDAT or light EXR)");
  return load_any_light(file, o.reading(), deviations);
}

Luminaire load(const std::string& file, const LightCommand& o) {
  Deviations ignored;
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
