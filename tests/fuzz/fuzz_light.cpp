#include <cmath>
#include <cstdlib>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/files/eulumdat.h>
#include <gonio/mapping/light/files/ies.h>
#include <gonio/mapping/light/files/luminaire.h>
#include <gonio/mapping/light/files/text_scanner.h>

// Bytes to a luminaire file of either format; what can be used has a flux, and can be written as either.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gonio;
  const std::string text = without_utf16(std::string(reinterpret_cast<const char*>(data), size));
  const LightFormat format = light_format(text);
  if (format == LightFormat::unknown) return 0;
  try {
    Problems deviations;
    const Luminaire light = format == LightFormat::ies
                                ? to_luminaire(read_ies(text, "fuzz", deviations), "fuzz", {}, deviations)
                                : to_luminaire(read_eulumdat(text, "fuzz", deviations), "fuzz", {}, deviations);
    if (!(flux(light.diagram) >= 0)) std::abort();
    if (light.diagram.frame.nadir == LightFrame{}.nadir) {  // others are tabulated anew, which takes long here
      to_ies(light);
      to_eulumdat(light);
    }
  } catch (const Error&) {
  }
  return 0;
}
