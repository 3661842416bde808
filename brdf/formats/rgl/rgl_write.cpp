#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

#include <gonio/brdf/formats/repair.h>
#include <gonio/brdf/formats/rgl/rgl_write.h>
#include <gonio/brdf/formats/rgl/spectrum.h>
#include <gonio/brdf/formats/rgl/tensor_write.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

// [slice][channel][height][width] of value(cell, channel).
template <class Value>
std::vector<float> planes(const std::vector<glm::vec3>& cells, std::size_t slices, std::size_t channels,
                          const Value& value) {
  const std::size_t size = cells.size() / slices;
  std::vector<float> values;
  values.reserve(cells.size() * channels);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    for (std::size_t k = 0; k < channels; ++k) {
      for (std::size_t i = 0; i < size; ++i) values.push_back(value(cells[slice * size + i], k));
    }
  }
  return values;
}

// As RglTable repairs them, negative channels at 0.
std::vector<glm::vec3> repaired_colour(const RglFile& file) {
  std::vector<glm::vec3> cells = file.colour;
  std::vector<CellKind> kinds;
  kinds.reserve(cells.size());
  for (const glm::vec3& cell : cells) kinds.push_back(kind_of(cell));
  const std::size_t n = file.theta_i.size();
  const auto height = static_cast<std::size_t>(file.colour_height);
  const auto width = static_cast<std::size_t>(file.colour_width);
  repair_cells(cells, kinds, {},
               {{n * height, width, 1, false}, {n, height, width, false}, {1, n, height * width, false}});
  return cells;
}

// Every slice with an integral of 1, uniform if it is black, as readers take them.
std::vector<float> normalised(const RglFile::Grid& grid) {
  constexpr double rounding = 1e-5;  // of sums of floats
  std::vector<float> values = grid.values;
  float* slice = values.data();
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(grid.height) * grid.width;
  for (int k = 0; k < grid.slices; ++k, slice += size) {
    double sum = 0;
    for (int j = 0; j < grid.height; ++j) {
      for (int i = 0; i < grid.width; ++i) {
        // The trapezoid rule is the integral of the bilinear density.
        const double area = (i % (grid.width - 1) == 0 ? 0.5 : 1.0) * (j % (grid.height - 1) == 0 ? 0.5 : 1.0);
        sum += area * slice[j * grid.width + i];
      }
    }
    const double integral = sum / ((grid.width - 1.0) * (grid.height - 1.0));
    if (std::abs(integral - 1) < rounding) continue;
    std::transform(slice, slice + size, slice,
                   [&](float value) { return integral > 0 ? static_cast<float>(value / integral) : 1.0f; });
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
             normalised(grid));
}

}  // namespace

void write_rgl(const std::filesystem::path& path, const RglFile& stored, RglColour colour) {
  RglFile file = stored;
  repair_densities(file, {});
  const auto text = [](int height, int width) { return std::to_string(height) + " x " + std::to_string(width); };
  const RglFile::Grid& grid = file.luminance;
  if (grid.height != grid.width || file.colour_height != grid.height || file.colour_width != grid.width) {
    throw Error(path.string() + ": luminance and rgb: found " + text(grid.height, grid.width) + " and " +
                text(file.colour_height, file.colour_width) + ", expected squares of one size, as other readers do");
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
             planes(file.colour, n, 3, [](const glm::vec3& cell, std::size_t k) { return cell[static_cast<int>(k)]; }));
  if (colour == RglColour::rgb_and_spectra) {
    const RgbSpectra spectra = rgb_spectra();
    const std::size_t channels = spectra.wavelengths.size();
    writer.add("spectra", {1, n, channels, side, side},
               planes(repaired_colour(file), n, channels,
                      [&](const glm::vec3& cell, std::size_t k) { return glm::dot(spectra.reflectance[k], cell); }));
    writer.add("wavelengths", {channels}, spectra.wavelengths);
  }
  writer.add("jacobian", std::string(1, '\1'));
  write_stream_atomically(path, [&](std::ostream& stream) { writer.write(stream); });
}

}  // namespace gonio
