#include <gonio/brdf/exr/disk_image_file.h>
#include <gonio/brdf/exr/stack_file.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "../light_cases.h"
#include "../table_files.h"

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
  write(folder / "mbsdf" / "transmission", make_mbsdf(0, 2, 3, std::vector<float>(12, 0.3f), "MBSDF_DATA_TRANSMISSION=\n"));

  gonio::StackFile stack;
  stack.name = "corpus";
  stack.diagrams = gonio::Stack<float>(small_stack(), gonio::Interpolation::displacement).grid();
  fs::create_directories(folder / "stack");
  gonio::save_stack(folder / "stack" / "bare.exr", stack);
  stack.colour = gonio::Colour({0, 0.5f, 1}, 4, std::vector<glm::vec3>(24, glm::vec3(0.5f)));
  gonio::save_stack(folder / "stack" / "colour.exr", stack);
  for (auto& diagram : stack.diagrams.diagrams) diagram = stack.diagrams.diagrams.front();
  stack.interpolation = gonio::Interpolation::blend;
  stack.storage = gonio::Storage::packed16;
  stack.diagrams = gonio::PackedStack(stack.diagrams).grid();
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
  write(folder / "light" / "type_b.ies",
        "TILT=NONE\n1 -1 1 3 2 2 2 0 0 0\n1 1 10\n-90 0 90\n0 90\n1 2 3\n2 3 4\n");
  std::string stored = "a\n1\n3\n3\n90\n2\n90\n\n\n\n\n\n";
  for (int k = 0; k < 13; ++k) stored += "1,5\n";
  stored += "1\n1\nl\n1000,5\n\n\n10\n";
  for (int k = 0; k < 10; ++k) stored += "0\n";
  write(folder / "light" / "stored.ldt", stored + "-90\n0\n90\n0\n90\n3\n1\n3\n2\n3\n1\n");
  return 0;
}
