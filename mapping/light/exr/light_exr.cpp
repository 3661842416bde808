#include <cmath>
#include <vector>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/files/text_scanner.h>
#include <gonio/mapping/light/texture/octahedral.h>

namespace gonio {
namespace {

constexpr int largest_side = 1 << 14;
constexpr int samples = 4;  // a pixel and axis

Imath::V3d to_imath(const Vec3<double>& v) { return {v.x, v.y, v.z}; }
Vec3<double> from_imath(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

std::vector<float> to_degrees(const std::vector<double>& radians) {
  std::vector<float> degrees;
  degrees.reserve(radians.size());
  for (double r : radians) degrees.push_back(static_cast<float>(r * 180 / pi<double>));
  return degrees;
}

void write(const std::filesystem::path& path, Imf::Header header, const char* channel, int width,
           std::vector<float>& pixels) {
  header.compression() = Imf::ZIP_COMPRESSION;
  header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float),
                                    sizeof(float) * static_cast<std::size_t>(width)));
  // To memory first: OpenEXR finishes its files in destructors, where a full disk goes unnoticed.
  Imf::StdOSStream bytes;
  try {
    Imf::OutputFile file(bytes, header);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(pixels.size()) / width);
  } catch (const std::exception& e) {
    throw Error(path.string() + ": cannot be written: " + e.what());
  }
  write_stream_atomically(path, [&](std::ostream& stream) { stream << bytes.str(); });
}

/// `direction_of(x, y)` at points of the image in pixels.
template <class Direction>
std::vector<float> render(const Reconstruction& intensity, int width, int height, const Direction& direction_of) {
  std::vector<float> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i)
          sum += intensity(direction_of(x + (i + 0.5) / samples, y + (j + 0.5) / samples));
      pixels.push_back(static_cast<float>(sum / (samples * samples)));
    }
  return pixels;
}

void check_resolution(const char* what, int found) {
  if (found < 8 || found > largest_side)
    throw Error(std::string(what) + ": found " + std::to_string(found) + ", expected 8 to " +
                std::to_string(largest_side));
}

template <class Attribute>
auto attribute(const std::string& file, const Imf::Header& header, const char* name) {
  const Attribute* found = header.findTypedAttribute<Attribute>(name);
  if (!found) throw Error(file + ": attribute " + name + ": found none of that type, expected one");
  return found->value();
}

std::optional<double> optional_number(const Imf::Header& header, const char* name) {
  const auto* found = header.findTypedAttribute<Imf::DoubleAttribute>(name);
  return found ? std::optional<double>(found->value()) : std::nullopt;
}

std::string text(const Imf::Header& header, const char* name) {
  const auto* found = header.findTypedAttribute<Imf::StringAttribute>(name);
  return found ? found->value() : std::string();
}

Luminaire read(const std::string& name) {
  Imf::InputFile file(name.c_str());
  const Imf::Header& header = file.header();
  const int version = attribute<Imf::IntAttribute>(name, header, "gonioLight");
  if (version != light_exr_version)
    throw Error(name + ": attribute gonioLight: found version " + std::to_string(version) + ", expected " +
                std::to_string(light_exr_version));
  Luminaire light;
  LightDiagram& d = light.diagram;
  for (float v : attribute<Imf::FloatVectorAttribute>(name, header, "c")) d.c.push_back(v * pi<double> / 180);
  for (float v : attribute<Imf::FloatVectorAttribute>(name, header, "gamma")) d.gamma.push_back(v * pi<double> / 180);
  d.frame = {from_imath(attribute<Imf::V3dAttribute>(name, header, "nadir")),
             from_imath(attribute<Imf::V3dAttribute>(name, header, "c0")),
             from_imath(attribute<Imf::V3dAttribute>(name, header, "c90"))};
  const auto& window = header.dataWindow();
  const long long width = 1LL + window.max.x - window.min.x, height = 1LL + window.max.y - window.min.y;
  if (width != static_cast<long long>(d.gamma.size()) || height != static_cast<long long>(d.c.size()) ||
      width > largest_side || height > largest_side || window.min.x != 0 || window.min.y != 0)
    throw Error(name + ": size: found " + std::to_string(width) + " x " + std::to_string(height) +
                ", expected as many columns as gamma has lines and as many rows as c");
  if (!header.channels().findChannel("cd")) throw Error(name + ": channel cd: found none, expected one");
  std::vector<float> pixels(static_cast<std::size_t>(width * height));
  Imf::FrameBuffer buffer;
  buffer.insert("cd", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float),
                                 sizeof(float) * static_cast<std::size_t>(width)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, static_cast<int>(height) - 1);
  d.cd.assign(pixels.begin(), pixels.end());
  check(d);

  light.format = "EXR light diagram";
  light.manufacturer = text(header, "manufacturer");
  light.name = text(header, "luminaire");
  light.number = text(header, "number");
  light.lamp = text(header, "lamp");
  light.unit = text(header, "unit");
  if (d.frame.nadir == LightFrame{}.nadir)  // none is told of type B, as of its IES file
    light.symmetry = find_symmetry(in_frame(d, LightFrame{}));
  light.lamp_lumens = optional_number(header, "lampLumens");
  light.stated_lumens = optional_number(header, "statedLumens");
  light.downward_fraction = optional_number(header, "downwardFraction");
  light.watts = optional_number(header, "watts").value_or(0);
  light.absolute = attribute<Imf::IntAttribute>(name, header, "absolute") != 0;
  light.round = attribute<Imf::IntAttribute>(name, header, "round") != 0;
  light.size = from_imath(attribute<Imf::V3dAttribute>(name, header, "size"));
  return light;
}

bool is_exr(const std::filesystem::path& path) { return begins_as_exr(read_bytes(path, 4)); }

}  // namespace

void save_light(const std::filesystem::path& path, const Luminaire& light) {
  const LightDiagram& d = light.diagram;
  check(d);
  Imf::Header header(static_cast<int>(d.gamma.size()), static_cast<int>(d.c.size()));
  header.insert("gonioLight", Imf::IntAttribute(light_exr_version));
  header.insert("c", Imf::FloatVectorAttribute(to_degrees(d.c)));
  header.insert("gamma", Imf::FloatVectorAttribute(to_degrees(d.gamma)));
  header.insert("nadir", Imf::V3dAttribute(to_imath(d.frame.nadir)));
  header.insert("c0", Imf::V3dAttribute(to_imath(d.frame.c0)));
  header.insert("c90", Imf::V3dAttribute(to_imath(d.frame.c90)));
  header.insert("manufacturer", Imf::StringAttribute(light.manufacturer));
  header.insert("luminaire", Imf::StringAttribute(light.name));
  header.insert("number", Imf::StringAttribute(light.number));
  header.insert("lamp", Imf::StringAttribute(light.lamp));
  header.insert("unit", Imf::StringAttribute(light.unit));
  header.insert("absolute", Imf::IntAttribute(light.absolute));
  header.insert("round", Imf::IntAttribute(light.round));
  header.insert("size", Imf::V3dAttribute(to_imath(light.size)));
  header.insert("watts", Imf::DoubleAttribute(light.watts));
  if (light.lamp_lumens) header.insert("lampLumens", Imf::DoubleAttribute(*light.lamp_lumens));
  if (light.stated_lumens) header.insert("statedLumens", Imf::DoubleAttribute(*light.stated_lumens));
  if (light.downward_fraction) header.insert("downwardFraction", Imf::DoubleAttribute(*light.downward_fraction));
  std::vector<float> pixels(d.cd.begin(), d.cd.end());
  write(path, header, "cd", static_cast<int>(d.gamma.size()), pixels);
}

Luminaire load_light_exr(const std::filesystem::path& path) {
  try {
    return read(path.string());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(path.string() + ": damaged: " + e.what());
  }
}

bool is_light_file(const std::filesystem::path& path) {
  if (is_exr(path)) {
    try {
      const Imf::InputFile file(path.c_str());
      return file.header().find("gonioLight") != file.header().end();
    } catch (const std::exception&) {
      return false;  // another kind of EXR, or a damaged one
    }
  }
  return light_format(without_utf16(read_bytes(path, 1 << 16))) != LightFormat::unknown;
}

Luminaire load_any_light(const std::filesystem::path& path, const LightOptions& options, Problems& deviations) {
  return is_exr(path) ? load_light_exr(path) : load_light(path, options, deviations);
}

void save_octahedral(const std::filesystem::path& path, const Reconstruction& intensity, int resolution) {
  check_resolution("octahedral image: resolution", resolution);
  std::vector<float> pixels = render(intensity, resolution, resolution, [&](double x, double y) {
    return octahedral_to_direction(SquarePoint<double>{x / resolution, y / resolution});
  });
  Imf::Header header(resolution, resolution);
  header.insert("comments", Imf::StringAttribute("luminous intensity [cd], equal-area octahedral, +z in the centre"));
  write(path, header, "Y", resolution, pixels);
}

void save_latlong(const std::filesystem::path& path, const Reconstruction& intensity, int height) {
  check_resolution("latitude-longitude image: height", height);
  std::vector<float> pixels = render(intensity, 2 * height, height, [&](double x, double y) {
    // Within a pixel row points are even in the cosine: the mean is one over solid angle.
    const double row = std::floor(y), top = std::cos(pi<double> * row / height);
    const double z = top + (y - row) * (std::cos(pi<double> * (row + 1) / height) - top);
    const double s = std::sqrt(std::max(1 - z * z, 0.0)), c = pi<double> * x / height;
    return Vec3<double>{s * std::cos(c), s * std::sin(c), z};
  });
  Imf::Header header(2 * height, height);
  header.insert("comments",
                Imf::StringAttribute("luminous intensity [cd], zenith at the top, C from 0 to 360 degrees"));
  write(path, header, "Y", 2 * height, pixels);
}

std::string pbrt_goniometric_light(const std::string& image) {
  return "AttributeBegin\n"
         "  # In the light's frame: zenith +y, C0 +x, C90 +z. For a scene whose z axis is up, "
         "uncomment:\n"
         "  # ConcatTransform [ 1 0 0 0  0 0 1 0  0 1 0 0  0 0 0 1 ]\n"
         "  # The image is in cd; \"float power\" [ lumens ] would scale it to a flux instead.\n"
         "  LightSource \"goniometric\" \"string filename\" [ \"" +
         image + "\" ] \"float scale\" [ 1 ]\nAttributeEnd\n";
}

}  // namespace gonio
