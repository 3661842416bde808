#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include <gonio/mapping/light/files/luminaire.h>
#include <gonio/mapping/light/texture/solid.h>

namespace gonio {

/// The command line of `gonio light VERB`; angles in degrees.
struct LightCommand {
  std::vector<std::string> files;
  std::string in, out, filter = "bilinear", normalise = "none", layout = "diagram";
  bool clockwise = false, per_klm = false;
  double ies_zero = 90, tilt = 0, target = 1;
  std::size_t lamp_set = 0;
  std::vector<double> planes{0, 90};
  int rows = 180, resolution = 512, draws = 1000;
  unsigned seed = 1;

  /// How files are read.
  LightOptions reading() const;
};

/// The verbs. @throws Error if a file cannot be read or written, or an option would have no effect.
void light_info(const LightCommand& o);
void light_validate(const LightCommand& o);
void light_convert(const CLI::App& verb, const LightCommand& o);
void light_plot(const LightCommand& o);
void light_solid(const LightCommand& o);
void light_sample(const CLI::App& verb, const LightCommand& o);
void light_compare(const LightCommand& o);

/// Loads a file as it is. @throws Error as load_any_light(); a file of another kind is named as
/// what it is, with the verb that takes it.
Luminaire load_as_is(const std::string& file, const LightCommand& o, Problems& deviations);
/// Loads a file and normalises it as the command says.
Luminaire load(const std::string& file, const LightCommand& o);

/// The names of --filter, and what they mean.
std::vector<std::string> reconstruction_names();
Reconstruction reconstruction(const LightDiagram& diagram, const std::string& filter);

}  // namespace gonio
