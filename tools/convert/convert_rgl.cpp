#include "tools/convert/convert_rgl.h"

#include <cstdio>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/formats/rgl/rgl_write.h>
#include <gonio/brdf/formats/sniff.h>
#include <gonio/brdf/resample/rgl_resample.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/input.h"
#include "tools/cli/progress.h"

namespace gonio {
namespace {

RglFile resample(const std::filesystem::path& in, const std::filesystem::path& out, const Reflectance& f_r,
                 const std::string& description) {
  ProgressLine progress("writing " + out.string());
  const std::string text = description.empty() ? in.stem().string() : description;
  const RglSize size;
  RglFile file = resample_as_rgl(f_r, text, size, [&](double done) { progress.update(done); });
  return file;
}

RglFile to_rgl(const std::filesystem::path& in, const std::filesystem::path& out, const CellPolicies& policies,
               bool rgb_only) {
  if (is_exr(in)) {
    const StackFile stack = load_stack(in);
    const Bsdf bsdf = to_bsdf(stack, in);
    return resample(
        in, out, [&](const auto& wi, const auto& wo) { return bsdf.eval(wi, wo); }, stack.name);
  }
  if (is_model_file(in)) {
    const LobeModel model = load_model(in);
    return resample(
        in, out, [&](const auto& wi, const auto& wo) { return model.eval(wi, wo); }, describe(model));
  }
  if (sniff_format(in) == TableFormat::rgl) {
    load_input(in);  // what cannot be used is not copied either
    RglFile file = read_rgl(in);
    if (file.n_wavelengths > 0 && !rgb_only) {
      throw Error(in.string() + ": spectra: found " + std::to_string(file.n_wavelengths) +
                  " wavelengths, expected none: renderers read this file as it is; --rgb writes its colours");
    }
    return file;
  }
  const BrdfTable table = load_input(in, policies);
  return resample(
      in, out, [&](const auto& wi, const auto& wo) { return table.eval(wi, wo); }, table.info().description);
}

}  // namespace

void convert_to_rgl(const std::filesystem::path& in, const std::filesystem::path& out, const CellPolicies& policies,
                    bool rgb_only) {
  const RglFile file = to_rgl(in, out, policies, rgb_only);
  write_rgl(out, file, rgb_only ? RglColour::rgb : RglColour::rgb_and_spectra);
  std::printf("%zu incident angles, colours %d x %d%s\n", file.theta_i.size(), file.colour_height, file.colour_width,
              rgb_only ? "" : " with spectra");
}

}  // namespace gonio
