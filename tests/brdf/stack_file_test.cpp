#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledRgbaFile.h>
#include <gtest/gtest.h>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/stack/rounded16.h>

#include "tests/support/files.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

class StackFileTest : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }

  test::TemporaryFolder folder_;
};

double uniform(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

std::vector<double> random_lines(std::mt19937& random, int count, double last) {
  std::vector<double> lines = {0};
  for (int i = 1; i < count; ++i) lines.push_back(lines.back() + 0.05 + uniform(random));
  for (double& line : lines) line *= last / lines.back();
  return lines;
}

/// Diagrams of different sizes over twelve decades, as a sampler holds them, with colour.
StackFile make_file(int angles = 3, int side = 4) {
  std::mt19937 random(7);
  StackGrid grid;
  for (int k = 0; k < angles; ++k) {
    DiagramGrid diagram;
    diagram.phi = random_lines(random, 3 + k, pi<double>);
    diagram.r = random_lines(random, 5 - k, 1);
    for (std::size_t i = 0; i < diagram.phi.size() * diagram.r.size(); ++i)
      diagram.density.push_back(std::pow(10.0, 12 * uniform(random) - 6));
    grid.theta_i.push_back(0.7 * k);
    grid.diagrams.push_back(std::move(diagram));
  }
  StackFile file;
  file.bsdf.diagrams = rounded16(grid);
  file.bsdf.interpolation = Interpolation::displacement;
  std::vector<glm::vec3> values(angles * side * (side / 2));
  for (glm::vec3& w : values) w = {uniform(random), 1e-30f, 100 * uniform(random)};
  std::vector<float> theta_i;
  for (int k = 0; k < angles; ++k) theta_i.push_back(0.6f * static_cast<float>(k));
  file.bsdf.colour = Colour(std::move(theta_i), side, values);
  file.name = "näme";
  file.source = "some file.binary";
  return file;
}

/// The other values of all attributes that make_file() leaves as they are without them.
StackFile make_packed_file() {
  std::mt19937 random(9);
  StackGrid grid;
  grid.chart = Chart::half;
  const std::vector<double> phi = random_lines(random, 4, pi<double>), r = random_lines(random, 10, 1);
  for (int k = 0; k < 3; ++k) {
    DiagramGrid diagram{Azimuth::half, phi, r, {}};
    for (std::size_t i = 0; i < phi.size() * r.size(); ++i)
      diagram.density.push_back(std::pow(10.0, 6 * uniform(random) - 3));
    grid.theta_i.push_back(0.7 * k);
    grid.diagrams.push_back(std::move(diagram));
  }
  StackFile file = make_file();
  file.comments = "made by hand\nCC0, \xc3\xa9";
  file.bsdf.diagrams = rounded16(grid);
  file.bsdf.interpolation = Interpolation::blend;
  file.bsdf.colour = Colour({0.1f, 0.9f, 1.0f, 1.2f}, 2, std::vector<glm::vec3>(8, glm::vec3(0.2f, 0.4f, 0.6f)));
  return file;
}

void expect_same(const StackGrid& a, const StackGrid& b) {
  EXPECT_EQ(a.theta_i, b.theta_i);
  ASSERT_EQ(a.diagrams.size(), b.diagrams.size());
  for (std::size_t k = 0; k < a.diagrams.size(); ++k) {
    EXPECT_EQ(a.diagrams[k].azimuth, b.diagrams[k].azimuth);
    EXPECT_EQ(a.diagrams[k].phi, b.diagrams[k].phi);
    EXPECT_EQ(a.diagrams[k].r, b.diagrams[k].r);
    EXPECT_EQ(a.diagrams[k].density, b.diagrams[k].density);
  }
}

std::string message_of(const fs::path& path) {
  try {
    load_stack(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  fs::remove(path);  // replacing the content of a file makes some file systems wait for the disk
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A stack file as another program would write it from docs/formats/stack-file.md, open to changes.
struct RawPart {
  Imf::Header header;
  std::vector<std::string> channels;
  std::vector<float> pixels;
};

std::vector<RawPart> make_parts() {
  const auto part = [](const char* name, int width, int height, std::vector<std::string> channels) {
    RawPart raw{Imf::Header(width, height), std::move(channels), {}};
    raw.header.setName(name);
    raw.header.setType(Imf::SCANLINEIMAGE);
    raw.header.compression() = Imf::ZIPS_COMPRESSION;
    raw.header.displayWindow() = Imath::Box2i({0, 0}, {3, 3});
    raw.pixels.assign(raw.channels.size() * width * height, 0.5f);
    return raw;
  };
  std::vector<RawPart> parts = {part("diagram.000", 3, 2, {"Y"}), part("diagram.001", 3, 2, {"Y"}),
                                part("colour", 4, 4, {"R", "G", "B"})};
  for (int k = 0; k < 2; ++k) {
    parts[k].header.insert("gonio:theta_i", Imf::FloatAttribute(static_cast<float>(k)));
    parts[k].header.insert("gonio:phi", Imf::FloatVectorAttribute({0, pi<float>}));
    parts[k].header.insert("gonio:r", Imf::FloatVectorAttribute({0, 0.5f, 1}));
  }
  parts[2].header.insert("gonio:theta_i", Imf::FloatVectorAttribute({0.0f, 1.0f}));
  Imf::Header& first = parts.front().header;
  first.insert("gonio:format", Imf::IntAttribute(2));
  first.insert("gonio:name", Imf::StringAttribute("raw"));
  first.insert("gonio:source", Imf::StringAttribute(""));
  first.insert("gonio:chart", Imf::StringAttribute("outgoing"));
  return parts;
}

void write_parts(const fs::path& path, std::vector<RawPart>& parts) {
  std::vector<Imf::Header> headers;
  for (RawPart& part : parts) {
    for (const std::string& c : part.channels) part.header.channels().insert(c, Imf::Channel(Imf::FLOAT));
    headers.push_back(part.header);
  }
  Imf::MultiPartOutputFile output(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto& window = parts[k].header.dataWindow();
    const std::size_t pixel = parts[k].channels.size() * sizeof(float);
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < parts[k].channels.size(); ++c)
      buffer.insert(parts[k].channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(parts[k].pixels.data() + c),
                                                     pixel, pixel * (window.max.x + 1)));
    Imf::OutputPart out(output, static_cast<int>(k));
    out.setFrameBuffer(buffer);
    out.writePixels(window.max.y + 1);
  }
}

TEST_F(StackFileTest, RoundTripIsBitExact) {
  for (const StackFile& saved : {make_file(), make_packed_file()}) {
    save_stack(path("a.exr"), saved);
    const StackFile loaded = load_stack(path("a.exr"));
    expect_same(saved.bsdf.diagrams, loaded.bsdf.diagrams);
    expect_same(sampled_stack(saved.bsdf).grid(), sampled_stack(loaded.bsdf).grid());
    EXPECT_EQ(saved.bsdf.colour.side(), loaded.bsdf.colour.side());
    EXPECT_EQ(saved.bsdf.colour.theta_i(), loaded.bsdf.colour.theta_i());
    EXPECT_EQ(saved.bsdf.colour.values(), loaded.bsdf.colour.values());
    EXPECT_EQ(saved.name, loaded.name);
    EXPECT_EQ(saved.source, loaded.source);
    EXPECT_EQ(saved.comments, loaded.comments);
    EXPECT_EQ(saved.bsdf.diagrams.chart, loaded.bsdf.diagrams.chart);
    EXPECT_EQ(saved.bsdf.interpolation, loaded.bsdf.interpolation);
    save_stack(path("b.exr"), loaded);
    EXPECT_EQ(read_bytes(path("a.exr")), read_bytes(path("b.exr")));
  }
}

TEST_F(StackFileTest, RoundTripWithoutColour) {
  StackFile saved = make_file(1);
  saved.bsdf.colour = {};
  save_stack(path("a.exr"), saved);
  const StackFile loaded = load_stack(path("a.exr"));
  expect_same(saved.bsdf.diagrams, loaded.bsdf.diagrams);
  EXPECT_TRUE(loaded.bsdf.colour.empty());
  EXPECT_THROW(load_bsdf(path("a.exr")), Error);
}

TEST_F(StackFileTest, LoadedBsdfIsTheSavedOne) {
  const StackFile file = make_file();
  save_stack(path("a.exr"), file);
  const Bsdf saved(file.bsdf), loaded = load_bsdf(path("a.exr"));
  const glm::vec3 wi(0.6f, 0, 0.8f);
  for (int k = 0; k < 64; ++k) {
    const glm::vec2 u((static_cast<float>(k % 8) + 0.5f) / 8, (static_cast<float>(k / 8) + 0.5f) / 8);
    const auto a = saved.sample(wi, u), b = loaded.sample(wi, u);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->wo, b->wo);
    EXPECT_EQ(a->pdf, b->pdf);
    EXPECT_EQ(a->weight, b->weight);
  }
}

TEST_F(StackFileTest, RecognisedByContent) {
  save_stack(path("a.binary"), make_file());
  EXPECT_TRUE(is_exr(path("a.binary")));
  write_bytes(path("b.exr"), "tensor_file");
  EXPECT_FALSE(is_exr(path("b.exr")));
  EXPECT_NE(message_of(path("b.exr")).find("b.exr: content: found no OpenEXR file"), std::string::npos);
  EXPECT_THROW(is_exr(path("missing.exr")), Error);
  EXPECT_THROW(is_exr(folder_.path()), Error);
}

TEST_F(StackFileTest, TruncatedAtAnyLength) {
  save_stack(path("a.exr"), make_packed_file());
  const std::string bytes = read_bytes(path("a.exr"));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(path("b.exr"), bytes.substr(0, length));
    ASSERT_NE(message_of(path("b.exr")).find("b.exr: "), std::string::npos) << length << " bytes";
  }
}

TEST_F(StackFileTest, AnyByteDamaged) {
  save_stack(path("a.exr"), make_file());
  const std::string bytes = read_bytes(path("a.exr"));
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      write_bytes(path("b.exr"), damaged);
      try {
        const StackFile file = load_stack(path("b.exr"));
        // Damage that is not seen must still leave something that can be sampled.
        if (!file.bsdf.colour.empty()) {
          EXPECT_NO_THROW(sampled_stack(file.bsdf)) << at;
        }
      } catch (const Error& error) {
        ++refused;
        ASSERT_NE(std::string(error.what()).find("b.exr: "), std::string::npos) << at;
      }
    }
  }
  EXPECT_GT(refused, static_cast<int>(bytes.size()));
}

/// The first number of what the BSDF says that is no number, infinite or negative; empty if there is none.
template <class S>
std::string not_finite(const S& bsdf) {
  const auto good = [](float value) { return value >= 0 && std::isfinite(value); };
  const auto all_good = [&](const glm::vec3& v) { return good(v.r) && good(v.g) && good(v.b); };
  for (const float theta_i : {0.0f, 0.3f, 0.65f, 1.0f, 1.35f, 1.57f}) {
    const glm::vec3 wi(std::sin(theta_i), 0, std::cos(theta_i));
    const auto where = " at theta_i = " + std::to_string(theta_i);
    for (int k = 0; k < 64; ++k) {
      const float u = static_cast<float>(k % 8) / 7 * (1 - 0x1p-24f),
                  v = static_cast<float>(k / 8) / 7 * (1 - 0x1p-24f);
      const auto drawn = bsdf.sample(wi, {u, v});
      if (drawn && !(good(drawn->pdf) && all_good(drawn->weight) && std::abs(drawn->wo.z) <= 1))
        return "a draw" + where;
      const float z = std::max(u, 1e-6f), r = std::sqrt(1 - z * z), phi = 2 * pi<float> * v;
      const glm::vec3 wo(r * std::cos(phi), r * std::sin(phi), z);
      if (!good(bsdf.pdf(wi, wo))) return "a pdf" + where;
      if (!all_good(bsdf.eval(wi, wo))) return "f_r" + where;
    }
  }
  return "";
}

/// All numbers that are sampled: the same for files that differ elsewhere.
std::string content(const BsdfData& data) {
  std::string all(to_string(data.diagrams.chart));
  all += to_string(data.interpolation);
  const auto add = [&all](const auto& values) {
    all.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  add(data.diagrams.theta_i);
  for (const DiagramGrid& d : data.diagrams.diagrams) add(d.phi), add(d.r), add(d.density);
  add(data.colour.theta_i()), add(data.colour.values());
  return all;
}

TEST_F(StackFileTest, WhatIsAcceptedIsFinite) {
  for (const StackFile& saved : {make_file(2, 2), make_packed_file()}) {
    save_stack(path("a.exr"), saved);
    const std::string bytes = read_bytes(path("a.exr"));
    std::set<std::string> accepted;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const int flip : {0x40, 0x7f, 0xff}) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ flip);
        write_bytes(path("b.exr"), damaged);
        try {
          const BsdfData data = load_stack(path("b.exr")).bsdf;
          const StackBsdf plain(data);
          if (!accepted.insert(content(data)).second) continue;
          EXPECT_EQ(not_finite(plain), "") << "byte " << at << " with " << flip;
          if (accepted.size() % 16 != 1) continue;  // making a Bsdf draws 184,320 times
          EXPECT_EQ(not_finite(load_bsdf(path("b.exr"))), "") << "byte " << at << " with " << flip;
        } catch (const Error&) {  // refused: as good
        }
      }
    }
    EXPECT_GT(accepted.size(), 1u);  // words change nothing; numbers, at least, do
  }
}

TEST_F(StackFileTest, OtherImagesAreRefused) {
  std::vector<Imf::Rgba> pixels(16 * 16);
  {
    Imf::RgbaOutputFile image(path("rgba.exr").c_str(), 16, 16);
    image.setFrameBuffer(pixels.data(), 1, 16);
    image.writePixels(16);
  }
  {
    Imf::TiledRgbaOutputFile image(path("tiled.exr").c_str(), 16, 16, 8, 8, Imf::ONE_LEVEL);
    image.setFrameBuffer(pixels.data(), 1, 16);
    image.writeTiles(0, image.numXTiles() - 1, 0, image.numYTiles() - 1);
  }
  for (const char* name : {"rgba.exr", "tiled.exr"})
    EXPECT_NE(message_of(path(name)).find("attribute gonio:format: found none"), std::string::npos)
        << message_of(path(name));
}

TEST_F(StackFileTest, WrittenByAnotherProgram) {
  std::vector<RawPart> parts = make_parts();
  write_parts(path("a.exr"), parts);
  const StackFile file = load_stack(path("a.exr"));
  EXPECT_EQ(file.name, "raw");
  EXPECT_EQ(file.bsdf.diagrams.theta_i, (std::vector<double>{0, 1}));
  EXPECT_EQ(file.bsdf.diagrams.diagrams[0].r, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(file.bsdf.colour.side(), 4);
}

/// The header without one attribute. (Imf::Header::erase of OpenEXR 3.1 leaks it.)
Imf::Header without(const Imf::Header& header, const std::string& name) {
  Imf::Header result;
  for (auto it = header.begin(); it != header.end(); ++it)
    if (it.name() != name) result.insert(it.name(), it.attribute());
  return result;
}

/// What is changed in the parts of make_parts(), and what the message must name.
struct Fault {
  const char* name;
  void (*apply)(std::vector<RawPart>&);
  const char* message;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class FaultTest : public StackFileTest, public testing::WithParamInterface<Fault> {};

TEST_P(FaultTest, IsNamed) {
  std::vector<RawPart> parts = make_parts();
  GetParam().apply(parts);
  write_parts(path("a.exr"), parts);
  const std::string message = message_of(path("a.exr"));
  EXPECT_NE(message.find("a.exr: "), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Parts = std::vector<RawPart>;
const Fault faults[] = {
    {"Version", [](Parts& p) { p[0].header.insert("gonio:format", Imf::IntAttribute(1)); },
     "attribute gonio:format: found 1, expected 2 or 3"},
    {"Scale", [](Parts& p) { p[1].header.insert("gonio:scale", Imf::FloatAttribute(0)); },
     "part diagram.001: attribute gonio:scale: found 0.000000, expected a positive, finite number"},
    {"ColourWithoutAngles", [](Parts& p) { p[2].header = without(p[2].header, "gonio:theta_i"); },
     "part colour: attribute gonio:theta_i"},
    {"ColourAnglesNotAscending",
     [](Parts& p) {
       p[2].header.insert("gonio:theta_i", Imf::FloatVectorAttribute({0.6f, 0.0f}));
     },
     "colour: theta_i[1]"},
    {"Chart", [](Parts& p) { p[0].header.insert("gonio:chart", Imf::StringAttribute("sideways")); },
     "attribute gonio:chart: found sideways, expected one of outgoing, half"},
    {"NoName", [](Parts& p) { p[0].header = without(p[0].header, "gonio:name"); }, "attribute gonio:name"},
    {"NoLines", [](Parts& p) { p[1].header = without(p[1].header, "gonio:phi"); },
     "part diagram.001: attribute gonio:phi"},
    {"LinesOfAnotherType",
     [](Parts& p) {
       p[1].header = without(p[1].header, "gonio:r"), p[1].header.insert("gonio:r", Imf::FloatAttribute(1));
     },
     "part diagram.001: attribute gonio:r"},
    {"TooFewLines", [](Parts& p) { p[0].header.insert("gonio:phi", Imf::FloatVectorAttribute({0})); },
     "part diagram.000: gonio:phi: found 1 values"},
    {"TooManyLines",
     [](Parts& p) {
       p[0].header.insert("gonio:r", Imf::FloatVectorAttribute({0, 0.25f, 0.5f, 1}));
     },
     "part diagram.000: size: found 3 x 2, expected 4 x 2"},
    {"LinesNotAscending",
     [](Parts& p) {
       p[0].header.insert("gonio:r", Imf::FloatVectorAttribute({0, 2, 1}));
     },
     "parallels"},
    {"LinesNotANumber",
     [](Parts& p) {
       p[0].header.insert("gonio:r", Imf::FloatVectorAttribute({0, nan, 1}));
     },
     "parallels"},
    {"AnglesNotAscending", [](Parts& p) { p[1].header.insert("gonio:theta_i", Imf::FloatAttribute(0)); }, "theta_i[1]"},
    {"AngleNotANumber", [](Parts& p) { p[1].header.insert("gonio:theta_i", Imf::FloatAttribute(nan)); }, "theta_i[1]"},
    {"DensityNotANumber", [](Parts& p) { p[1].pixels[3] = nan; }, "density[3]: found nan"},
    {"DensityInfinite", [](Parts& p) { p[1].pixels[0] = std::numeric_limits<float>::infinity(); },
     "density[0]: found inf"},
    {"DensityNegative", [](Parts& p) { p[0].pixels[5] = -1; }, "density[5]: found -1"},
    {"DensityZero", [](Parts& p) { p[0].pixels.assign(6, 0.0f); }, "zero everywhere"},
    {"ColourNotANumber", [](Parts& p) { p[2].pixels[7] = nan; }, "colour: found nan"},
    {"ColourTooLarge", [](Parts& p) { p[2].pixels[7] = 3e38f; }, "colour: found 3e+38, expected weights from 0 to 1e6"},
    {"ColourNegative", [](Parts& p) { p[2].pixels[7] = -1; }, "colour: found -1"},
    {"ColourChannel", [](Parts& p) { p[2].channels[1] = "H"; }, "part colour: channel G"},
    {"ColourFirst", [](Parts& p) { std::swap(p[0].pixels, p[2].pixels), std::swap(p[0], p[2]); },
     "attribute gonio:format"},
    {"ColourBetween", [](Parts& p) { std::swap(p[1], p[2]); }, "a part after colour"},
    {"FirstPartRenamed", [](Parts& p) { p[0].header.setName("picture"); },
     "name of part 0: found picture, expected diagram.000"},
    {"FirstPartMissing",
     [](Parts& p) {
       p[0].header.setName("diagram.001");
       p[1].header.setName("diagram.002");
     },
     "name of part 0: found diagram.001, expected diagram.000"},
    {"GapInTheNumbers", [](Parts& p) { p[1].header.setName("diagram.002"); },
     "name of part 1: found diagram.002, expected diagram.001"},
    {"ShortNumber", [](Parts& p) { p[1].header.setName("diagram.1"); },
     "name of part 1: found diagram.1, expected diagram.001"},
    {"ColourRenamed", [](Parts& p) { p[2].header.setName("color"); },
     "name of part 2: found color, expected diagram.002, or colour as the last part"},
    {"NoDiagram", [](Parts& p) { p.resize(1), p[0].header.setName("colour"); }, "part colour"},
};

INSTANTIATE_TEST_SUITE_P(StackFile, FaultTest, testing::ValuesIn(faults),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(StackFileTest, SaveRefusesWhatIsNoStack) {
  EXPECT_THROW(save_stack(path("a.exr"), {}), Error);
  StackFile full = make_file(1);
  full.bsdf.diagrams.diagrams[0].azimuth = Azimuth::full;
  EXPECT_THROW(save_stack(path("a.exr"), full), Error);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(StackFileTest, SaveLeavesNothingHalfWritten) {
  const StackFile file = make_file();
  EXPECT_THROW(save_stack(path("missing/a.exr"), file), Error);
  fs::create_directory(path("folder.exr"));
  EXPECT_THROW(save_stack(path("folder.exr"), file), Error);
  EXPECT_THROW(save_stack("/proc/a.exr", file), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace gonio
