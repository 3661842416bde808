#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <gonio/brdf/exr/check_attributes.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& field, const std::string& found,
                       const std::string& expected) {
  throw Error(file + ": " + field + ": found " + found + ", expected " + expected);
}

Imf::Slice slice(std::vector<float>& pixels, int width) {
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float),
                    sizeof(float) * static_cast<std::size_t>(width));
}

DiskImage load(const std::string& file) {
  check_attribute_sizes(file);
  Imf::InputFile input(file.c_str(), 1);
  const Imf::Header& header = input.header();
  if (header.find("gonio:format") != header.end())
    fail(file, "content", "a stack file", "a table, or an image of a normal distribution");
  const auto* quantity = header.findTypedAttribute<Imf::StringAttribute>("gonio:quantity");
  if (quantity && quantity->value() != "D") fail(file, "attribute gonio:quantity", quantity->value(), "D");
  const auto& window = header.dataWindow();
  const long long width = 1LL + window.max.x - window.min.x, height = 1LL + window.max.y - window.min.y;
  if (width != height || width < 1 || width > max_disk_image_side)
    fail(file, "size", std::to_string(width) + " x " + std::to_string(height),
         "a square of at most " + std::to_string(max_disk_image_side) + " pixels");
  if (!input.isComplete()) fail(file, "content", "an incomplete image", "all its rows");
  const bool grey = header.channels().findChannel("Y") != nullptr;
  const std::vector<std::string> channels =
      grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  const float weights[] = {grey ? 1.0f : 0.2126f, 0.7152f, 0.0722f};
  DiskImage image(static_cast<int>(width));
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Imf::Channel* channel = header.channels().findChannel(channels[c].c_str());
    if (!channel || channel->xSampling != 1 || channel->ySampling != 1)
      fail(file, "channels", "no " + channels[c] + " of full resolution", "Y, or R, G and B");
    std::vector<float> pixels(image.values.size());
    // OpenEXR addresses pixels by their place in the data window.
    Imf::Slice place = slice(pixels, image.size);
    place.base -= static_cast<std::ptrdiff_t>(place.xStride) * window.min.x +
                  static_cast<std::ptrdiff_t>(place.yStride) * window.min.y;
    Imf::FrameBuffer buffer;
    buffer.insert(channels[c], place);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    for (std::size_t i = 0; i < pixels.size(); ++i) image.values[i] += weights[c] * pixels[i];
  }
  return image;
}

}  // namespace

void save_disk_image(const std::filesystem::path& path, const DiskImage& image, const std::string& quantity) {
  // To memory first: OpenEXR finishes its files in destructors, where a full disk goes unnoticed.
  Imf::StdOSStream bytes;
  try {
    Imf::Header header(image.size, image.size);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.insert("gonio:quantity", Imf::StringAttribute(quantity));
    header.insert("gonio:version", Imf::StringAttribute(GONIO_VERSION));
    header.insert(
        "gonio:layout",
        Imf::StringAttribute("the hemisphere on its disk z = 0: x to the right, y up, the circle touches the sides"));
    std::vector<float> pixels = image.values;
    Imf::FrameBuffer buffer;
    buffer.insert("Y", slice(pixels, image.size));
    Imf::OutputFile output(bytes, header, 1);
    output.setFrameBuffer(buffer);
    output.writePixels(image.size);
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot be written: " + e.what());
  }
  write_stream_atomically(path, [&](std::ostream& stream) { stream << bytes.str(); });
}

DiskImage load_ndf_image(const std::filesystem::path& path) {
  if (!is_exr(path)) fail(path.string(), "content", "no OpenEXR file", "an image of a normal distribution");
  try {
    return load(path.string());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {  // Iex exceptions among them
    throw Error(path.string() + ": damaged OpenEXR file: " + e.what());
  }
}

}  // namespace gonio
