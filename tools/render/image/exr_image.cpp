#include "tools/render/image/exr_image.h"

#include <cmath>
#include <utility>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include <gonio/brdf/exr/check_attributes.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

constexpr long long max_pixels = 1LL << 28;

RgbImage load(const std::string& file) {
  check_attribute_sizes(file);
  Imf::InputFile input(file.c_str(), 1);
  // Files of ours have channels of the same names with another meaning.
  for (const auto& [attribute, found] : {std::pair{"gonio:format", "a stack file"},
                                         {"gonioLight", "a luminaire"},
                                         {"gonio:quantity", "an image of a normal distribution"}})
    if (input.header().find(attribute) != input.header().end())
      throw Error(file + ": content: found " + found + ", expected a picture");
  const auto& window = input.header().dataWindow();
  const long long width = 1LL + window.max.x - window.min.x, height = 1LL + window.max.y - window.min.y;
  if (width < 1 || height < 1 || width * height > max_pixels)
    throw Error(file + ": size: found " + std::to_string(width) + " x " + std::to_string(height) +
                ", expected at most 2^28 pixels");
  RgbImage image{static_cast<int>(width), static_cast<int>(height), {}};
  image.pixels.resize(static_cast<std::size_t>(width * height));
  const bool grey = input.header().channels().findChannel("R") == nullptr;
  const char* names[] = {grey ? "Y" : "R", "G", "B"};
  Imf::FrameBuffer buffer;
  for (int c = 0; c < (grey ? 1 : 3); ++c) {
    const Imf::Channel* channel = input.header().channels().findChannel(names[c]);
    if (!channel || channel->xSampling != 1 || channel->ySampling != 1)
      throw Error(file + ": channels: found no " + names[c] + " of full resolution, expected R, G and B, or Y");
    const std::size_t step = sizeof(glm::vec3);
    char* base = reinterpret_cast<char*>(&image.pixels.front()[c]);
    base -= static_cast<std::ptrdiff_t>(step) * (window.min.x + static_cast<std::ptrdiff_t>(width) * window.min.y);
    buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, step, step * static_cast<std::size_t>(width)));
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  if (grey)
    for (glm::vec3& p : image.pixels) p = glm::vec3(p.r);
  return image;
}

}  // namespace

RgbImage load_rgb(const std::filesystem::path& path) {
  if (!is_exr(path)) throw Error(path.string() + ": content: found no OpenEXR file, expected an image");
  try {
    return load(path.string());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {  // Iex exceptions among them
    throw Error(path.string() + ": damaged OpenEXR file: " + e.what());
  }
}

void save_layers(const std::filesystem::path& path, const std::vector<ImageLayer>& layers) {
  // To memory first: OpenEXR finishes its files in destructors, where a full disk goes unnoticed.
  Imf::StdOSStream bytes;
  try {
    const int width = layers.front().image->width, height = layers.front().image->height;
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    for (const ImageLayer& layer : layers)
      for (std::size_t c = 0; c < layer.channels.size(); ++c) {
        const std::string name = layer.prefix + layer.channels[c];
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        // OpenEXR's interface for reading and writing is one: it does not write to these pixels.
        float* base = const_cast<float*>(&layer.image->pixels.front()[static_cast<int>(c)]);
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), sizeof(glm::vec3),
                                       sizeof(glm::vec3) * static_cast<std::size_t>(width)));
      }
    Imf::OutputFile output(bytes, header, 1);
    output.setFrameBuffer(buffer);
    output.writePixels(height);
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot be written: " + e.what());
  }
  write_stream_atomically(path, [&](std::ostream& stream) { stream << bytes.str(); });
}

}  // namespace gonio
