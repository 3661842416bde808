#include <filesystem>
#include <fstream>
#include <sstream>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/fitting/model/model.h>
#include <gonio/mapping/stack/rounded16.h>

#include "tests/support/light_cases.h"
#include "tests/support/table_files.h"

// Writes a few small valid files of each format to the folders that the fuzzers start from:
// fuzz_corpus FOLDER.

namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

gonio::StackGrid small_stack() {
  gonio::DiagramGrid diagram;
  diagram.phi = {0, 1, gonio::pi<double>};
  diagram.r = {0, 0.25, 1};
  diagram.density = {1, 2, 3, 1, 2, 0, 1, 1, 0};
  return {{0.0, 0.5, 1.4}, {diagram, diagram, diagram}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const fs::path folder = argv[1];
  using namespace gonio::test;
  // The header alone: a whole file has 34 MB.
  std::string merl;
  for (const std::int32_t n : {90, 90, 180}) append(merl, n);
  write(folder / "merl" / "header", merl);
  write(folder / "merl" / "few", merl + std::string(240, '\0'));
  write(folder / "rgl" / "isotropic", make_rgl().bytes());
  write(folder / "rgl" / "plain", make_rgl({1, 1, 1}, false).bytes());
  write(folder / "rgl" / "two", make_rgl({1, 1, 1}, true, 2).bytes());
  write(folder / "mbsdf" / "scalar", make_mbsdf(0, 2, 3, std::vector<float>(12, 0.3f)));
  write(folder / "mbsdf" / "rgb", make_mbsdf(1, 2, 2, std::vector<float>(24, 0.3f)));
  write(folder / "mbsdf" / "transmission",
        make_mbsdf(0, 2, 3, std::vector<float>(12, 0.3f), "MBSDF_DATA_TRANSMISSION=\n"));

  gonio::StackFile stack;
  stack.name = "corpus";
  stack.bsdf.interpolation = gonio::Interpolation::displacement;
  stack.bsdf.diagrams = gonio::Stack<float>(small_stack(), gonio::Interpolation::displacement).grid();
  fs::create_directories(folder / "stack");
  gonio::save_stack(folder / "stack" / "bare.exr", stack);
  stack.bsdf.colour = gonio::Colour({0, 0.5f, 1}, 4, std::vector<glm::vec3>(24, glm::vec3(0.5f)));
  gonio::save_stack(folder / "stack" / "colour.exr", stack);
  for (auto& diagram : stack.bsdf.diagrams.diagrams) diagram = stack.bsdf.diagrams.diagrams.front();
  stack.bsdf.interpolation = gonio::Interpolation::blend;
  stack.bsdf.diagrams = gonio::rounded16(stack.bsdf.diagrams);
  gonio::save_stack(folder / "stack" / "packed.exr", stack);

  fs::create_directories(folder / "image");
  gonio::DiskImage image(4);
  image.at(1, 2) = 0.5;
  gonio::save_disk_image(folder / "image" / "d.exr", image, "D");

  const gonio::Luminaire light = gonio::testing::lambertian();
  std::ostringstream ies, eulumdat;
  gonio::write_ies(ies, gonio::to_ies(light));
  gonio::write_eulumdat(eulumdat, gonio::to_eulumdat(light));
  write(folder / "light" / "lambert.ies", ies.str());
  write(folder / "light" / "lambert.ldt", eulumdat.str());
  write(folder / "light" / "commas.ies",
        "IESNA91\nTilt = include\n1 2\n0 90\n1 0,5\n1 1,000 1 3 2 1 2 -0,5 0 0\n1 1 10\n0 45 90\n0 180\n"
        "1,5 1,25 0\n1,5 1,2 0\n");
  write(folder / "light" / "type_b.ies", "TILT=NONE\n1 -1 1 3 2 2 2 0 0 0\n1 1 10\n-90 0 90\n0 90\n1 2 3\n2 3 4\n");
  std::string stored = "a\n1\n3\n3\n90\n2\n90\n\n\n\n\n\n";
  for (int k = 0; k < 13; ++k) stored += "1,5\n";
  stored += "1\n1\nl\n1000,5\n\n\n10\n";
  for (int k = 0; k < 10; ++k) stored += "0\n";
  write(folder / "light" / "stored.ldt", stored + "-90\n0\n90\n0\n90\n3\n1\n3\n2\n3\n1\n");

  const auto fit = [](const char* model) { return gonio::to_json(gonio::parse_model(model)); };
  write(folder / "fit" / "plastic", fit("default"));
  write(folder / "fit" / "metal", fit("student_t:eta=0.2/0.3/0.4,k=3+oren_nayar"));
  write(folder / "manifest" / "two", R"({"format": "gonio scene", "version": 1, "materials": [
    {"name": "a", "file": "/proc/self/exe", "share": 2, "incidence": [0, 1, 5]}, {"name": "b", "file": "/proc/self/exe", "share": 1}]})");
  write(
      folder / "scene" / "all",
      R"({"camera": {"position": [0, -6, 3], "target": [0, 0, 1], "up": [0, 0, 1], "vertical_fov": 25, "resolution": [64, 32]},
    "environment": {"sky": {"sun": [0, 1, 1], "radius": 2.5, "radiance": 300}, "turn": 90, "scale": 1},
    "materials": {"a": {"albedo": [0.5, 0.4, 0.3], "two_sided": true}, "b": {"albedo": 0.2}},
    "objects": [{"shape": "preview", "material": "a", "scale": [1, 2, 3], "rotate": [90, 0, 0], "translate": [0, 0, 1]},
                {"shape": "square", "material": "b", "emission": [1, 2, 3]}], "lights": []})");
  write(folder / "scene" / "file",
        R"({"environment": {"constant": 1}, "materials": {"a": {"file": "a.bsdf", "sampling": "half"}},
    "objects": [{"file": "a.ply", "material": "a"}], "lights": [{"file": "a.ies", "position": [0, 0, 1], "scale": 2}]})");

  const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar uint vertex_indices\nend_header\n";
  write(folder / "ply" / "ascii",
        "ply\nformat ascii 1.0\ncomment one\n" + vertices + faces + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  std::string binary =
      "ply\nformat binary_little_endian 1.0\n" + vertices + "property list uchar short marks\n" + faces;
  for (const float x : {0.0f, 1.0f, 2.0f, 3.0f}) {
    for (const float p : {x, x * x, 1.0f}) append(binary, p);
    append(binary, std::uint8_t(0));
  }
  append(binary, std::uint8_t(4));
  for (const std::uint32_t v : {0u, 1u, 3u, 2u}) append(binary, v);
  write(folder / "ply" / "binary", binary);
  write(folder / "obj" / "quad",
        "# one\nmtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl b\nf 1/1/1 2/1/1 "
        "\\\n3//1 -1/-1/-1\n");
  return 0;
}
