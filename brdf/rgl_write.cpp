#include <gonio/brdf/rgl_write.h>
#include <gonio/brdf/spectrum.h>
#include <gonio/brdf/tensor_write.h>
#include <gonio/mapping/atomic_file.h>
#include <gonio/mapping/error.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace gonio {
namespace {

// [slice][channel][height][width]; `weights` makes a channel of a colour.
std::vector<float> planes(const RglFile& file, const std::vector<glm::vec3>& weights, float least) {
  const std::size_t size = file.colour.size() / file.theta_i.size();
  std::vector<float> values;
  values.reserve(file.colour.size() * weights.size());
  for (std::size_t slice = 0; slice < file.theta_i.size(); ++slice) {
    for (const glm::vec3& weight : weights) {
      for (std::size_t i = 0; i < size; ++i) {
        values.push_back(std::max(glm::dot(weight, file.colour[slice * size + i]), least));
      }
    }
  }
  return values;
}

void add_grid(TensorWriter& writer, const std::string& name, const RglFile::Grid& grid) {
  // Readers interpolate between rows and need two of them.
  std::vector<float> values = grid.values;
  const int rows = std::max(grid.height, 2);
  if (grid.height == 1) values.insert(values.end(), grid.values.begin(), grid.values.end());
  writer.add(name, {static_cast<std::uint64_t>(rows), static_cast<std::uint64_t>(grid.width)}, values);
}

void add_slices(TensorWriter& writer, const std::string& name, const RglFile::Grid& grid) {
  writer.add(name,
             {1, static_cast<std::uint64_t>(grid.slices), static_cast<std::uint64_t>(grid.height),
              static_cast<std::uint64_t>(grid.width)},
             grid.values);
}

}  // namespace

void write_rgl(const std::filesystem::path& path, const RglFile& file, RglColour colour) {
  const auto text = [](int height, int width) {
    return std::to_string(height) + " x " + std::to_string(width);
  };
  const RglFile::Grid& grid = file.luminance;
  if (grid.height != grid.width || file.colour_height != grid.height ||
      file.colour_width != grid.width) {
    throw Error(path.string() + ": luminance and rgb: found " + text(grid.height, grid.width) +
                " and " + text(file.colour_height, file.colour_width) +
                ", expected squares of one size, as other readers do");
  }
  if (!file.jacobian) throw Error(path.string() + ": jacobian: found 0, expected 1: pbrt-v4 does not read it");
  const auto n = static_cast<std::uint64_t>(file.theta_i.size());
  const auto side = static_cast<std::uint64_t>(grid.width);
  TensorWriter writer;
  writer.add("description", file.description);
  writer.add("phi_i", {1}, {0.0f});
  writer.add("theta_i", {n}, file.theta_i);
  add_grid(writer, "sigma", file.sigma);
  add_grid(writer, "ndf", file.ndf);
  add_slices(writer, "vndf", file.vndf);
  add_slices(writer, "luminance", file.luminance);
  writer.add("rgb", {1, n, 3, side, side},
             planes(file, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, std::numeric_limits<float>::lowest()));
  if (colour == RglColour::rgb_and_spectra) {
    const RgbSpectra spectra = rgb_spectra();
    writer.add("spectra", {1, n, spectra.wavelengths.size(), side, side},
               planes(file, spectra.reflectance, 0.0f));
    writer.add("wavelengths", {spectra.wavelengths.size()}, spectra.wavelengths);
  }
  writer.add("jacobian", std::string(1, '\1'));
  write_stream_atomically(path, [&](std::ostream& stream) { writer.write(stream); });
}

}  // namespace gonio
