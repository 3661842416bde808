#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <gonio/brdf/exr/check_attributes.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/code16.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio {
namespace {

constexpr std::size_t most_values = std::size_t{1} << 23;  // of a part
constexpr int largest_side = 1 << 14;                      // lines or cells a part may have: no real stack comes near

[[noreturn]] void fail(const std::string& file, const std::string& field, const std::string& found,
                       const std::string& expected) {
  throw Error(file + ": " + field + ": found " + found + ", expected " + expected);
}

std::vector<float> to_float(const std::vector<double>& values) { return {values.begin(), values.end()}; }
std::vector<double> to_double(const std::vector<float>& values) { return {values.begin(), values.end()}; }

/// A part's pixels and what describes them.
struct Part {
  Imf::Header header;
  std::vector<std::string> channels;
  std::vector<std::uint16_t> pixels;  // half floats, channels interleaved
};

Part make_part(const std::string& name, int width, int height, std::vector<std::string> channels) {
  Part part{Imf::Header(width, height), std::move(channels), {}};
  part.header.setName(name);
  part.header.setType(Imf::SCANLINEIMAGE);
  part.header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& c : part.channels) part.header.channels().insert(c, Imf::Channel(Imf::HALF));
  return part;
}

template <class Pixel>
Imf::FrameBuffer frame_buffer(const std::vector<std::string>& channels, int width, Pixel* pixels) {
  Imf::FrameBuffer buffer;
  const std::size_t stride = channels.size() * sizeof(Pixel);
  for (std::size_t c = 0; c < channels.size(); ++c)
    buffer.insert(channels[c],
                  Imf::Slice(std::is_same_v<Pixel, float> ? Imf::FLOAT : Imf::HALF, reinterpret_cast<char*>(pixels + c),
                             stride, stride * static_cast<std::size_t>(width)));
  return buffer;
}

template <class Attribute, class Value>
Value attribute(const std::string& file, const Imf::Header& header, const char* name) {
  const Attribute* found = header.findTypedAttribute<Attribute>(name);
  if (!found) fail(file, "part " + header.name() + ": attribute " + name, "none of that type", "one");
  return found->value();
}

/// What a pixel of 1 stands for.
double scale_of(const std::string& file, const Imf::Header& header) {
  if (header.find("gonio:scale") == header.end()) return 1;  // floats as they are
  const float scale = attribute<Imf::FloatAttribute, float>(file, header, "gonio:scale");
  if (!(scale > 0 && std::isfinite(scale)))
    fail(file, "part " + header.name() + ": attribute gonio:scale", std::to_string(scale), "a positive, finite number");
  return scale;
}

/// One of the values that have a name; `absent` for files that are older than the attribute.
template <class Value, std::size_t N>
Value choice(const std::string& file, const Imf::Header& header, const char* name, const Value (&known)[N],
             Value absent) {
  if (header.find(name) == header.end()) return absent;
  const std::string found = attribute<Imf::StringAttribute, std::string>(file, header, name);
  std::string expected;
  for (const Value value : known) {
    if (found == to_string(value)) return value;
    expected += (expected.empty() ? "" : ", ") + std::string(to_string(value));
  }
  fail(file, std::string("attribute ") + name, found, "one of " + expected);
}

std::vector<float> read_pixels(const std::string& file, Imf::MultiPartInputFile& input, int k, int width, int height,
                               const std::vector<std::string>& channels) {
  const Imf::Header& header = input.header(k);
  const auto& window = header.dataWindow();
  // In 64 bits: a damaged window may span more than an int holds.
  const long long found_width = 1LL + window.max.x - window.min.x, found_height = 1LL + window.max.y - window.min.y;
  if (found_width != width || found_height != height || window.min.x != 0 || window.min.y != 0)
    fail(file, "part " + header.name() + ": size", std::to_string(found_width) + " x " + std::to_string(found_height),
         std::to_string(width) + " x " + std::to_string(height) + " from 0, 0");
  for (const std::string& c : channels) {
    const Imf::Channel* channel = header.channels().findChannel(c);
    if (!channel || (channel->type != Imf::FLOAT && channel->type != Imf::HALF))
      fail(file, "part " + header.name() + ": channel " + c, "none of type HALF or FLOAT", "one");
  }
  const std::size_t values = channels.size() * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (values > most_values)  // a few bytes of a damaged header would ask for all memory
    fail(file, "part " + header.name() + ": size", std::to_string(values) + " values",
         "at most " + std::to_string(most_values));
  std::vector<float> pixels(values);
  Imf::InputPart part(input, k);
  part.setFrameBuffer(frame_buffer(channels, width, pixels.data()));
  part.readPixels(0, height - 1);
  return pixels;
}

int checked_size(const std::string& file, const std::string& field, std::size_t size) {
  if (size < 2 || size > largest_side)
    fail(file, field, std::to_string(size) + " values", "2 to " + std::to_string(largest_side));
  return static_cast<int>(size);
}

std::string diagram_name(std::size_t k) {
  std::string number = std::to_string(k);
  number.insert(0, number.size() < 3 ? 3 - number.size() : 0, '0');
  return "diagram." + number;
}

StackFile load(const std::string& file) {
  check_attribute_sizes(file);
  Imf::MultiPartInputFile input(file.c_str(), 1);
  StackFile result;
  const Imf::Header& first = input.header(0);
  const int version = first.findTypedAttribute<Imf::IntAttribute>("gonio:format")
                          ? attribute<Imf::IntAttribute, int>(file, first, "gonio:format")
                          : 0;
  if (version != stack_file_version && version != oldest_stack_file_version)
    fail(file, "attribute gonio:format", version ? std::to_string(version) : "none",
         std::to_string(oldest_stack_file_version) + " or " + std::to_string(stack_file_version) +
             " (a stack file of this library)");
  result.name = attribute<Imf::StringAttribute, std::string>(file, first, "gonio:name");
  result.source = attribute<Imf::StringAttribute, std::string>(file, first, "gonio:source");
  if (first.find("comments") != first.end())
    result.comments = attribute<Imf::StringAttribute, std::string>(file, first, "comments");
  result.bsdf.diagrams.chart = choice(file, first, "gonio:chart", charts, Chart::outgoing);
  result.bsdf.interpolation = choice(file, first, "gonio:interpolation", interpolations, Interpolation::displacement);

  for (int k = 0; k < input.parts(); ++k) {
    const Imf::Header& header = input.header(k);
    if (!input.partComplete(k)) fail(file, "part " + header.name(), "an incomplete part", "all its rows");
    if (!result.bsdf.colour.empty())
      fail(file, "part " + header.name(), "a part after colour", "colour to be the last");
    if (header.name() == "colour") {
      if (result.bsdf.diagrams.theta_i.empty())
        fail(file, "part colour", "no diagrams before it", "it to be the last part");
      auto theta_i = attribute<Imf::FloatVectorAttribute, std::vector<float>>(file, header, "gonio:theta_i");
      const int side = header.dataWindow().max.x < largest_side ? header.dataWindow().max.x + 1 : 0;
      if (side < 2 || theta_i.empty() || theta_i.size() > largest_side)
        fail(file, "part colour", "no cells or no gonio:theta_i", "some");
      const auto pixels =
          read_pixels(file, input, k, side, static_cast<int>(theta_i.size()) * (side / 2), {"R", "G", "B"});
      const auto scale = static_cast<float>(scale_of(file, header));
      std::vector<glm::vec3> values(pixels.size() / 3);
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = scale * glm::vec3(pixels[3 * i], pixels[3 * i + 1], pixels[3 * i + 2]);
      result.bsdf.colour = Colour(std::move(theta_i), side, values);
      continue;
    }
    if (const std::string name = diagram_name(result.bsdf.diagrams.theta_i.size()); header.name() != name)
      fail(file, "name of part " + std::to_string(k), header.name(), name + ", or colour as the last part");
    const std::string field = "part " + header.name() + ": ";
    DiagramGrid grid;
    grid.azimuth = Azimuth::half;
    grid.phi = to_double(attribute<Imf::FloatVectorAttribute, std::vector<float>>(file, header, "gonio:phi"));
    grid.r = to_double(attribute<Imf::FloatVectorAttribute, std::vector<float>>(file, header, "gonio:r"));
    const int m = checked_size(file, field + "gonio:phi", grid.phi.size());
    const int n = checked_size(file, field + "gonio:r", grid.r.size());
    grid.density = to_double(read_pixels(file, input, k, n, m, {"Y"}));
    const double scale = scale_of(file, header);
    for (double& density : grid.density) density *= scale;
    result.bsdf.diagrams.theta_i.push_back(attribute<Imf::FloatAttribute, float>(file, header, "gonio:theta_i"));
    result.bsdf.diagrams.diagrams.push_back(std::move(grid));
  }
  return result;
}

}  // namespace

void save_stack(const std::filesystem::path& path, const StackFile& file) {
  if (file.bsdf.diagrams.theta_i.empty()) fail(path.string(), "diagrams", "none", "at least one");
  for (std::size_t k = 0; k < file.bsdf.diagrams.diagrams.size(); ++k)
    if (file.bsdf.diagrams.diagrams[k].azimuth != Azimuth::half)
      fail(path.string(), "diagram " + std::to_string(k), "a full azimuth", "half, mirrored");
  const StackGrid diagrams = rounded16(file.bsdf.diagrams);
  std::vector<Part> parts;
  for (std::size_t k = 0; k < diagrams.theta_i.size(); ++k) {
    const DiagramGrid& grid = diagrams.diagrams[k];
    Part part = make_part(diagram_name(k), static_cast<int>(grid.r.size()), static_cast<int>(grid.phi.size()), {"Y"});
    part.header.insert("gonio:theta_i", Imf::FloatAttribute(static_cast<float>(diagrams.theta_i[k])));
    part.header.insert("gonio:phi", Imf::FloatVectorAttribute(to_float(grid.phi)));
    part.header.insert("gonio:r", Imf::FloatVectorAttribute(to_float(grid.r)));
    const double largest = *std::max_element(grid.density.begin(), grid.density.end());
    part.header.insert("gonio:scale", Imf::FloatAttribute(static_cast<float>(largest) * half_unit));
    for (const double density : grid.density) part.pixels.push_back(encode16(density / largest));
    parts.push_back(std::move(part));
  }
  if (!file.bsdf.colour.empty()) {
    const int side = file.bsdf.colour.side();
    Part part =
        make_part("colour", side, static_cast<int>(file.bsdf.colour.theta_i().size()) * (side / 2), {"R", "G", "B"});
    part.header.insert("gonio:theta_i", Imf::FloatVectorAttribute(file.bsdf.colour.theta_i()));
    part.header.insert("gonio:units",
                       Imf::StringAttribute("pixel x gonio:scale is W = f_r cos(theta_o) / pdf, linear Rec. 709"));
    part.header.insert(
        "gonio:scale",
        Imf::FloatAttribute(file.bsdf.colour.largest() > 0 ? file.bsdf.colour.largest() * half_unit : 1.0f));
    const auto codes = file.bsdf.colour.codes().begin();
    part.pixels.assign(codes, codes + static_cast<std::ptrdiff_t>(3 * file.bsdf.colour.cells()));
    parts.push_back(std::move(part));
  }
  Imf::Header& first = parts.front().header;
  first.insert("gonio:format", Imf::IntAttribute(stack_file_version));
  first.insert("gonio:version", Imf::StringAttribute(GONIO_VERSION));
  first.insert("gonio:name", Imf::StringAttribute(file.name));
  first.insert("gonio:source", Imf::StringAttribute(file.source));
  if (!file.comments.empty()) first.insert("comments", Imf::StringAttribute(file.comments));
  first.insert("gonio:chart", Imf::StringAttribute(to_string(diagrams.chart)));
  first.insert("gonio:interpolation", Imf::StringAttribute(to_string(file.bsdf.interpolation)));
  first.insert("gonio:units",
               Imf::StringAttribute("pixel x gonio:scale is the pdf per 2 r dr dphi in 1/sr; angles in radians"));
  first.insert("gonio:layout",
               Imf::StringAttribute("one part per incident angle: columns r, rows phi in 0..pi, mirrored"));

  // To memory first: OpenEXR finishes its files in destructors, where a full disk goes unnoticed.
  Imf::StdOSStream bytes;
  try {
    // All parts of a file share one display window: it covers them all.
    Imath::Box2i display;
    for (const Part& part : parts) display.extendBy(part.header.dataWindow());
    std::vector<Imf::Header> headers;
    for (Part& part : parts) {
      part.header.displayWindow() = display;
      headers.push_back(part.header);
    }
    Imf::MultiPartOutputFile output(bytes, headers.data(), static_cast<int>(headers.size()), false, 1);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto& window = parts[k].header.dataWindow();
      Imf::OutputPart out(output, static_cast<int>(k));
      out.setFrameBuffer(frame_buffer(parts[k].channels, window.max.x + 1, parts[k].pixels.data()));
      out.writePixels(window.max.y + 1);
    }
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot be written: " + e.what());
  }
  write_stream_atomically(path, [&](std::ostream& stream) { stream << bytes.str(); });
}

StackFile load_stack(const std::filesystem::path& path) {
  if (!is_exr(path)) fail(path.string(), "content", "no OpenEXR file", "a stack file");
  try {
    StackFile file = load(path.string());
    // What cannot be sampled is refused here, with the name of the file.
    sampled_stack(file.bsdf);
    return file;
  } catch (const Error& e) {
    const std::string what = e.what();
    throw Error(what.compare(0, path.string().size(), path.string()) == 0 ? what : path.string() + ": " + what);
  } catch (const std::exception& e) {  // Iex exceptions among them
    throw Error(path.string() + ": damaged OpenEXR file: " + e.what());
  }
}

bool is_exr(const std::filesystem::path& path) { return begins_as_exr(read_bytes(path, 4)); }

Bsdf load_bsdf(const std::filesystem::path& path, std::shared_ptr<const BrdfTable> table) {
  return to_bsdf(load_stack(path), path, std::move(table));
}

Bsdf to_bsdf(const StackFile& file, const std::filesystem::path& path, std::shared_ptr<const BrdfTable> table) {
  if (file.bsdf.colour.empty() && !table)
    fail(path.string(), "part colour", "none", "one (a self-contained stack), or a table");
  return Bsdf(file.bsdf, std::move(table));
}

}  // namespace gonio
