#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/mapping/light/photometry.h>
#include <gonio/mapping/light/polar_svg.h>
#include <gonio/mapping/light/texture/octahedral.h>

#include "tests/support/light_cases.h"

namespace gonio {
namespace {

using testing::rad;

/// A path in the test's own folder, removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::path(::testing::TempDir()) /
              (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" + name)) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Image {
  int width, height;
  std::vector<float> pixels;
  float at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
};

Image read_image(const std::filesystem::path& path, const char* channel = "Y") {
  Imf::InputFile file(path.c_str());
  const auto& window = file.header().dataWindow();
  Image image{window.max.x + 1, window.max.y + 1, {}};
  image.pixels.resize(static_cast<std::size_t>(image.width * image.height));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.pixels.data()), sizeof(float),
                                    sizeof(float) * static_cast<std::size_t>(image.width)));
  file.setFrameBuffer(buffer);
  file.readPixels(0, image.height - 1);
  return image;
}

double octahedral_flux(const Image& image) {
  double sum = 0;
  for (float v : image.pixels) sum += double(v);
  return sum * 4 * pi<double> / double(image.pixels.size());
}

double latlong_flux(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    const double z = std::cos(pi<double> * y / image.height) - std::cos(pi<double> * (y + 1) / image.height);
    for (int x = 0; x < image.width; ++x) sum += image.at(x, y) * z * 2 * pi<double> / image.width;
  }
  return sum;
}

Vec3<double> brightest(const Image& image, bool octahedral) {
  const auto best = std::max_element(image.pixels.begin(), image.pixels.end()) - image.pixels.begin();
  const double x = (double(best % image.width) + 0.5) / image.width,
               y = (double(best / image.width) + 0.5) / image.height;
  if (octahedral) return octahedral_to_direction(SquarePoint<double>{x, y});
  return {std::sin(pi<double> * y) * std::cos(2 * pi<double> * x),
          std::sin(pi<double> * y) * std::sin(2 * pi<double> * x), std::cos(pi<double> * y)};
}

Vec3<double> farthest(const std::vector<Vec3<double>>& points) {
  const auto best = std::max_element(points.begin(), points.end(),
                                     [](const auto& a, const auto& b) { return glm::length(a) < glm::length(b); });
  return glm::normalize(*best);
}

std::vector<Vec3<double>> obj_vertices(const std::string& text) {
  std::istringstream stream(text);
  std::vector<Vec3<double>> points;
  for (std::string line; std::getline(stream, line);)
    if (Vec3<double> v; std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3) points.push_back(v);
  return points;
}

std::vector<Vec3<double>> ply_vertices(const std::string& data) {
  std::size_t count = 0;
  std::sscanf(data.c_str() + data.find("element vertex"), "element vertex %zu", &count);
  const char* at = data.data() + data.find("end_header\n") + 11;
  std::vector<Vec3<double>> points;
  for (std::size_t k = 0; k < count; ++k) {
    float v[3];
    std::memcpy(v, at + 12 * k, 12);
    points.push_back({double(v[0]), double(v[1]), double(v[2])});
  }
  return points;
}

/// Where a curve of the picture is farthest from the centre: the angle from straight down, positive
/// to the right.
double svg_angle(const std::string& svg, const std::string& id, const PolarScale& scale, double* intensity = nullptr) {
  std::size_t at = svg.find("<path id=\"" + id + "\" d=\"");
  EXPECT_NE(at, std::string::npos);
  at = svg.find("M", at);
  const std::size_t end = svg.find("Z", at);
  double best = 0, angle = 0;
  while (at < end) {
    double x, y;
    EXPECT_EQ(std::sscanf(svg.c_str() + at + 1, "%lf %lf", &x, &y), 2);
    const double dx = x - scale.x, dy = y - scale.y;
    if (dx * dx + dy * dy > best) best = dx * dx + dy * dy, angle = std::atan2(dx, dy);
    at = std::min(svg.find("L", at + 1), end);
  }
  if (intensity) *intensity = std::sqrt(best) / scale.radius_per_unit;
  return angle;
}

TEST(Octahedral, MapsAreInverseAndEqualArea) {
  for (const Vec3<double>& w : testing::directions(5000)) {
    const auto p = direction_to_octahedral(w);
    EXPECT_LT(glm::length(octahedral_to_direction(p) - w), 1e-9);
  }
  // The layout that pbrt-v4 reads: zenith in the centre, +x right, +y down the image, nadir in the
  // corners.
  EXPECT_NEAR(octahedral_to_direction(SquarePoint<double>{0.5, 0.5}).z, 1, 1e-12);
  EXPECT_NEAR(octahedral_to_direction(SquarePoint<double>{1, 0.5}).x, 1, 1e-12);
  EXPECT_NEAR(octahedral_to_direction(SquarePoint<double>{0.5, 1}).y, 1, 1e-12);
  for (double u : {0.0, 1.0})
    for (double v : {0.0, 1.0}) EXPECT_NEAR(octahedral_to_direction(SquarePoint<double>{u, v}).z, -1, 1e-12);
  // Area: a grid of points has the moments of the sphere.
  double z = 0, zz = 0, x3 = 0;
  const int n = 400;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto w = octahedral_to_direction(SquarePoint<double>{(i + 0.5) / n, (j + 0.5) / n});
      z += w.z / (n * n), zz += w.z * w.z / (n * n), x3 += w.x * w.x / (n * n);
    }
  EXPECT_NEAR(z, 0, 1e-9);
  EXPECT_NEAR(zz, 1.0 / 3, 1e-4);
  EXPECT_NEAR(x3, 1.0 / 3, 1e-4);
}

TEST(LightExport, Lambertian1000LumensThroughEverything) {
  const Luminaire light = testing::lambertian();
  const double straight = 1000 / pi<double>;
  const auto check_light = [&](const Luminaire& l, const char* what) {
    EXPECT_NEAR(flux(l.diagram), 1000, 0.1) << what;
    EXPECT_NEAR(l.diagram.intensity({0, 0, -1}), straight, 1e-4) << what;
    EXPECT_NEAR(EmissionSampler<float>(l.diagram).flux(), 1000, 0.1) << what;
  };
  check_light(light, "made");
  check_light(testing::from_ies(testing::ies_text(light)), "IES");
  check_light(testing::from_eulumdat(testing::eulumdat_text(light)), "EULUMDAT");
  const TemporaryFile own("own.exr"), octahedral("oct.exr"), latlong("ll.exr");
  save_light(own.path(), light);
  check_light(load_light_exr(own.path()), "EXR");
  // Once around all formats.
  Luminaire round = testing::from_ies(testing::ies_text(load_light_exr(own.path())));
  check_light(testing::from_eulumdat(testing::eulumdat_text(round)), "all formats");

  for (int filter = 0; filter < 4; ++filter) {
    const auto rebuilt = texture_reconstruction(LightTexture(light.diagram, static_cast<LightFilter>(filter)));
    save_octahedral(octahedral.path(), rebuilt, 512);
    const Image square = read_image(octahedral.path());
    EXPECT_NEAR(octahedral_flux(square), 1000, 0.1) << filter;
    EXPECT_NEAR(square.at(0, 0), straight, 0.02) << filter;
    EXPECT_NEAR(square.at(511, 511), straight, 0.02) << filter;
    EXPECT_EQ(square.at(256, 256), 0);
    save_latlong(latlong.path(), rebuilt, 512);
    const Image image = read_image(latlong.path());
    EXPECT_NEAR(latlong_flux(image), 1000, 0.1) << filter;
    EXPECT_NEAR(image.at(7, 511), straight, 0.02) << filter;
  }

  double down = 0;
  const std::string svg = polar_svg(light);
  EXPECT_NEAR(svg_angle(svg, "plane0", polar_scale(light), &down), 0, 1e-3);
  EXPECT_NEAR(down, straight, 0.02);
  const auto solid = photometric_solid(bilinear_reconstruction(light.diagram), 90, 180, 1);
  std::ostringstream obj, ply;
  write_obj(obj, solid, "Lambertian");
  write_ply(ply, solid);
  for (const auto& points : {obj_vertices(obj.str()), ply_vertices(ply.str())}) {
    ASSERT_EQ(points.size(), solid.vertices.size());
    EXPECT_NEAR(points[0].z, -straight, 1e-3);
  }
}

// One luminaire, strongest towards C = 30, gamma = 40 degrees, in everything that is written.
TEST(LightExport, EverythingPointsTheSameWay) {
  const Luminaire light = testing::asymmetric();
  const Vec3<double> peak = testing::asymmetric_peak();
  EXPECT_GT(peak.x, 0.5);  // towards +x, a little +y, down
  EXPECT_LT(peak.z, -0.7);
  const auto points_at = [&](const Vec3<double>& w, double degrees, const char* what) {
    EXPECT_LT(glm::length(w - peak), rad(degrees)) << what;
  };
  const auto direction = [](const LightDiagram& d) {
    const LightAngles a = photometry(d).max_at;
    return LightFrame{}.direction(a.c, a.gamma);
  };
  points_at(direction(light.diagram), 0.1, "made");
  points_at(direction(testing::from_ies(testing::ies_text(light)).diagram), 0.1, "IES");
  points_at(direction(testing::from_eulumdat(testing::eulumdat_text(light)).diagram), 0.1, "EULUMDAT");
  const TemporaryFile own("own.exr"), octahedral("oct.exr"), latlong("ll.exr");
  save_light(own.path(), light);
  points_at(direction(load_light_exr(own.path()).diagram), 0.1, "EXR");
  const Reconstruction bilinear = bilinear_reconstruction(light.diagram);
  save_octahedral(octahedral.path(), bilinear, 256);
  points_at(brightest(read_image(octahedral.path()), true), 1.5, "octahedral");
  save_latlong(latlong.path(), bilinear, 256);
  points_at(brightest(read_image(latlong.path()), false), 1.5, "latitude-longitude");
  for (int filter = 0; filter < 4; ++filter) {
    const LightTexture texture(light.diagram, static_cast<LightFilter>(filter));
    Vec3<double> best{0, 0, 1};
    for (const Vec3<double>& w : testing::directions(100000))
      if (texture.intensity(w) > texture.intensity(best)) best = w;
    points_at(best, 1, "texture");
  }
  const Mesh solid = photometric_solid(bilinear, 180, 360, 1e-3);
  std::ostringstream obj, ply;
  write_obj(obj, solid, light.name);
  write_ply(ply, solid);
  points_at(farthest(obj_vertices(obj.str())), 0.1, "OBJ");
  points_at(farthest(ply_vertices(ply.str())), 0.1, "PLY");

  const EmissionSampler<float> sampler(light.diagram);
  Vec3<double> mean{0, 0, 0};
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 100; ++i)
      mean += Vec3<double>(sampler.sample((float(i) + 0.5f) / 100, (float(j) + 0.5f) / 100).direction);
  const Vec3<double> w = glm::normalize(mean);
  EXPECT_LT(std::abs(to_light_angles({}, w).c - rad(30)),
            rad(6));  // the weaker lobe pulls a little

  // The picture: C30 to the right and down, and nothing to the left.
  PolarPlot plot;
  plot.planes = {rad(30), rad(120)};
  EXPECT_NEAR(svg_angle(polar_svg(light, plot), "plane0", polar_scale(light, plot)), rad(40), rad(0.6));
  // In the default planes the stronger side of both is on the right: towards C0 and C90.
  const std::string svg = polar_svg(light);
  EXPECT_GT(svg_angle(svg, "plane0", polar_scale(light)), rad(20));
  EXPECT_GT(svg_angle(svg, "plane1", polar_scale(light)), rad(10));
}

TEST(LightExport, SolidIsClosedAndFacesOut) {
  const Mesh mesh = photometric_solid(bilinear_reconstruction(testing::asymmetric().diagram), 36, 72, 1);
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[static_cast<std::size_t>(k)], t[static_cast<std::size_t>((k + 1) % 3)]}];
    const auto v = [&](std::size_t k) { return Vec3<double>(mesh.vertices[static_cast<std::size_t>(t[k])]); };
    volume += glm::dot(v(0), glm::cross(v(1), v(2))) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first}));
  }
  EXPECT_GT(volume, 0);
  EXPECT_THROW(photometric_solid(bilinear_reconstruction(testing::asymmetric().diagram), 1, 72, 1), Error);
}

TEST(LightExport, OwnFileKeepsEverything) {
  Luminaire light = testing::asymmetric();
  light.absolute = true;
  light.unit = "mW/sr";
  light.stated_lumens = 123.5;
  const TemporaryFile own("own.exr");
  save_light(own.path(), light);
  Problems deviations;
  const Luminaire again = load_any_light(own.path(), {}, deviations);
  EXPECT_EQ(again.name, light.name);
  EXPECT_EQ(again.unit, light.unit);
  EXPECT_EQ(again.absolute, true);
  EXPECT_EQ(again.stated_lumens, light.stated_lumens);
  EXPECT_EQ(again.size, light.size);
  EXPECT_EQ(again.watts, light.watts);
  EXPECT_LT(testing::largest_difference(light.diagram, again.diagram), 1e-6);
  save_light(own.path(), again);
  EXPECT_EQ(load_light_exr(own.path()).diagram.cd, again.diagram.cd);
}

// In the frame of the library, whatever that of the diagram is.
TEST(LightExport, SymmetryIsThatOfTheFrame) {
  const TemporaryFile own("own.exr");
  Luminaire light = testing::asymmetric();
  light.diagram =
      testing::tabulate(36, 18, pi<double>, [](double c, double g) { return 100 * (2 + std::sin(c)) * std::exp(-g); });
  save_light(own.path(), light);
  EXPECT_EQ(load_light_exr(own.path()).symmetry, LightSymmetry::c90_c270);
  light.diagram.frame.c0 = {0, 1, 0}, light.diagram.frame.c90 = {-1, 0, 0};  // a quarter turn
  save_light(own.path(), light);
  EXPECT_EQ(load_light_exr(own.path()).symmetry, LightSymmetry::c0_c180);
  light.diagram.frame = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};  // type B
  save_light(own.path(), light);
  EXPECT_EQ(load_light_exr(own.path()).symmetry, LightSymmetry::none);
}

TEST(LightExport, BadFilesAreRefused) {
  const TemporaryFile own("own.exr"), other("oct.exr");
  save_octahedral(other.path(), bilinear_reconstruction(testing::lambertian().diagram), 16);
  EXPECT_THROW(load_light_exr(other.path()), Error);  // an image, not a diagram
  EXPECT_FALSE(is_light_file(other.path()));
  EXPECT_THROW(is_light_file("/nonexistent"), Error);
  save_light(own.path(), testing::lambertian());
  EXPECT_TRUE(is_light_file(own.path()));
  const auto size = std::filesystem::file_size(own.path());
  std::filesystem::resize_file(own.path(), size / 2);
  EXPECT_THROW(load_light_exr(own.path()), Error);
  EXPECT_THROW(save_light("/nonexistent/folder/x.exr", testing::lambertian()), Error);
  EXPECT_THROW(save_octahedral(own.path(), bilinear_reconstruction(testing::lambertian().diagram), 2), Error);
}

TEST(LightExport, PolarDiagramShowsWhatItSays) {
  const Luminaire light = testing::lambertian();
  const std::string svg = polar_svg(light);
  EXPECT_NE(svg.find("beam 120&#176;"), std::string::npos);
  EXPECT_NE(svg.find("field 168.5&#176;"), std::string::npos);
  EXPECT_NE(svg.find("C0 right, C180 left"), std::string::npos);
  PolarPlot klm;
  klm.per_klm = true;
  Luminaire twice = light;
  for (double& v : twice.diagram.cd) v *= 2;
  double value = 0;
  const std::string per_klm = polar_svg(twice, klm);
  svg_angle(per_klm, "plane0", polar_scale(twice, klm), &value);
  EXPECT_NEAR(value, 1000 / pi<double>, 0.05);  // whatever the flux
  EXPECT_NE(per_klm.find("cd/klm"), std::string::npos);
  Luminaire odd = light;
  odd.name = "<Gl\xFChlampe & \"Co\">";
  const std::string escaped = polar_svg(odd);
  EXPECT_NE(escaped.find("&lt;Gl\xC3\xBChlampe &amp; &quot;Co&quot;&gt;"), std::string::npos);
  klm.planes.clear();
  EXPECT_THROW(polar_svg(light, klm), Error);
}

// The outermost circle is I max or more, whether a plane that is drawn has it or not.
TEST(LightExport, PolarAxisHoldsTheMaximum) {
  const Luminaire light = testing::asymmetric();  // I max is 1000 cd at C 30
  PolarPlot plot;
  for (const std::vector<double>& planes : {std::vector<double>{rad(30)}, {rad(31)}, {0, rad(90)}, {rad(120)}}) {
    plot.planes = planes;
    const PolarScale scale = polar_scale(light, plot);
    EXPECT_GE(230 / scale.radius_per_unit, 1000 * (1 - 1e-9));
    EXPECT_LE(230 / scale.radius_per_unit, 1400);
    EXPECT_NE(polar_svg(light, plot).find(">1000<"), std::string::npos);
  }
}

TEST(LightExport, SmallValuesAreNotRoundedAway) {
  Luminaire light = testing::lambertian();
  for (double& v : light.diagram.cd) v *= 1e-6;
  EXPECT_NE(polar_svg(light).find("cd, flux 0.001 lm<"), std::string::npos);
  EXPECT_EQ(format_quantity(0), "0.00");
  EXPECT_EQ(format_quantity(0.0012345), "0.001234");
  EXPECT_EQ(format_quantity(1234.567), "1234.57");
  EXPECT_EQ(format_number(-0.0), "0");
}

TEST(LightExport, PbrtSnippetNamesTheImage) {
  const std::string scene = pbrt_goniometric_light("lamp.exr");
  EXPECT_NE(scene.find("\"string filename\" [ \"lamp.exr\" ]"), std::string::npos);
  EXPECT_EQ(std::count(scene.begin(), scene.end(), '"') % 2, 0);
}

}  // namespace
}  // namespace gonio
