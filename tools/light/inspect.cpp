#include <cmath>
#include <cstdio>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/text_scanner.h>
#include <gonio/mapping/light/photometry.h>

#include "tools/cli/failures.h"
#include "tools/light/command.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

std::string shown(const std::string& text) { return text.empty() ? "-" : text; }

void print_light(const std::string& file, const LightCommand& o) {
  Problems deviations;
  const Luminaire light = load_as_is(file, o, deviations);
  const Photometry p = photometry(light.diagram);
  const auto line = [](const char* name, const std::string& value) {
    std::printf("  %-16s %s\n", name, value.c_str());
  };
  const auto text = [](const char* format, auto... values) {
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return std::string(buffer);
  };
  const std::string total = flux_unit(light);
  std::printf("%s\n", file.c_str());
  line("format", light.format);
  line("manufacturer", shown(light.manufacturer));
  line("luminaire", shown(light.name));
  line("lamp", shown(light.lamp));
  line("unit", light.unit);
  line("angles", text("%zu C planes, %zu gamma, symmetry: ", light.diagram.c.size() - 1, light.diagram.gamma.size()) +
                     to_string(light.symmetry));
  line("flux", format_quantity(p.flux) + " " + total +
                   text(", %.1f %% of it down", p.flux > 0 ? 100 * p.downward_flux / p.flux : 0.0));
  if (light.stated_lumens)
    line("stated flux", format_quantity(*light.stated_lumens) + " " + total +
                            text(" (%+.2f %%)", 100 * (p.flux / *light.stated_lumens - 1)));
  if (light.lamp_lumens)
    line("lamps", format_quantity(*light.lamp_lumens) + " " + total + (light.absolute ? ", absolute photometry" : ""));
  if (const auto ratio = light_output_ratio(light)) line("output ratio", text("%.2f %%", 100 * *ratio));
  if (const auto e = efficacy(light))  // of radiometric files the efficiency
    line("efficacy", format_quantity(*e) + " " + total + text("/W at %.4g W", light.watts));
  line("I max", format_quantity(p.max_cd) + " " + light.unit +
                    text(" at C %.4g, gamma %.4g degrees", p.max_at.c / degree, p.max_at.gamma / degree));
  line("beam angle", text("%.1f degrees in C0-C180, %.1f in C90-C270", p.c0.beam / degree, p.c90.beam / degree));
  line("field angle", text("%.1f degrees in C0-C180, %.1f in C90-C270", p.c0.field / degree, p.c90.field / degree));
  std::string zones;
  for (double z : p.zones)  // less is rounding
    zones += text("%.4g ", z > 1e-9 * p.flux ? z : 0.0);
  line(total == "lm" ? "zonal lumens" : "zonal flux", zones + total + ", every 10 degrees from the nadir");
  if (!deviations.empty()) line("deviations", text("%zu, see gonio light validate", deviations.size()));
  if (!light.other_zero.empty())
    line("hint", light.other_zero + ": if C0 is the file's 0-degree plane, use --ies-zero 0");
}

}  // namespace

void light_info(const LightCommand& o) {
  Failures failures;
  for (const std::string& file : o.files) failures.survives([&] { print_light(file, o); });
  failures.throw_any(o.files.size());
}

void light_validate(const LightCommand& o) {
  int broken = 0, deviating = 0;
  for (const std::string& file : o.files) {
    Problems deviations;
    try {
      const Luminaire light = load_as_is(file, o, deviations);
      const double total = flux(light.diagram);
      if (light.stated_lumens && std::abs(total / *light.stated_lumens - 1) > 0.05)
        deviations.push_back({"flux", format_number(total) + " " + flux_unit(light) + " by quadrature",
                              format_number(*light.stated_lumens) + " as the file states", false});
      std::printf("%s: %s, %zu deviation%s\n", file.c_str(), light.format.c_str(), deviations.size(),
                  deviations.size() == 1 ? "" : "s");
      deviating += !deviations.empty();
    } catch (const Error& error) {
      std::printf("%s: rejected\n  %s\n", file.c_str(), error.what());
      ++broken;
    }
    for (const Problem& d : deviations) std::printf("  %s\n", to_string(d).c_str());
  }
  if (broken > 0)
    throw Error("found " + std::to_string(broken) + " of " + std::to_string(o.files.size()) + " files unusable" +
                (deviating > 0 ? ", " + std::to_string(deviating) + " with deviations" : "") + ", expected none");
}

}  // namespace gonio
