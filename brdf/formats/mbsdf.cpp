#include <cmath>
#include <cstdint>

#include <gonio/brdf/formats/interpolate.h>
#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/repair.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/fast_math.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {
namespace {

const std::string magic = "NVIDIA ARC MBSDF V1\n";

struct Block {
  int n_theta = 0, n_phi = 0, channels = 0;
  std::vector<float> values;
};

// Reads the binary part that follows a data line. False: a fatal problem was added.
bool parse_block(ByteReader& reader, const std::string& name, Block& block, Problems& problems) {
  std::uint32_t n[3];  // type, n_theta, n_phi
  if (!reader.read(n, 3)) {
    problems.push_back(
        {name + " header", std::to_string(reader.remaining()) + " bytes", "12 bytes (type, n_theta, n_phi)", true});
    return false;
  }
  const std::size_t before = problems.size();
  if (n[0] > 1) {
    problems.push_back({name + " type", std::to_string(n[0]), "0 (scalar) or 1 (RGB)", true});
  }
  const auto check = [&](const char* field, std::uint32_t value) {
    if (value < 1 || value > static_cast<std::uint32_t>(max_grid_side)) {
      problems.push_back({name + " " + field, std::to_string(value), "1 to " + std::to_string(max_grid_side), true});
    }
  };
  check("n_theta", n[1]);
  check("n_phi", n[2]);
  if (problems.size() > before) return false;
  const std::size_t channels = n[0] == 1 ? 3 : 1;
  const std::size_t count = static_cast<std::size_t>(n[1]) * n[1] * n[2] * channels;
  if (count > reader.remaining() / sizeof(float)) {
    problems.push_back({name + " values", std::to_string(reader.remaining()) + " bytes",
                        std::to_string(count * sizeof(float)) + " bytes for n_theta " + std::to_string(n[1]) +
                            ", n_phi " + std::to_string(n[2]) + ", " + std::to_string(channels) + " channel(s)",
                        true});
    return false;
  }
  block.n_theta = static_cast<int>(n[1]);
  block.n_phi = static_cast<int>(n[2]);
  block.channels = static_cast<int>(channels);
  block.values.resize(count);
  reader.read(block.values.data(), count);
  return true;
}

// Takes a line of text without its end. False if there is none, or if it is not text.
bool parse_line(ByteReader& reader, std::string& line) {
  line.clear();
  char c;
  while (reader.read(c)) {
    if (c == '\n') return true;
    if (static_cast<unsigned char>(c) < 0x20 && c != '\r' && c != '\t') return false;
    line += c;
  }
  return !line.empty();
}

}  // namespace

MbsdfFile parse_mbsdf(const std::string& bytes, Problems& problems) {
  MbsdfFile file;
  if (bytes.compare(0, magic.size(), magic) != 0) {
    problems.push_back({"magic", "something else", "\"NVIDIA ARC MBSDF V1\" and a line end", true});
    return file;
  }
  ByteReader reader(bytes);
  reader.skip(magic.size());
  Block reflection;
  std::string line;
  while (reader.remaining() > 0) {
    const std::size_t start = reader.position();
    if (!parse_line(reader, line)) {
      problems.push_back(
          {"header", "binary data at byte " + std::to_string(start), "lines of text, or the end of the file", true});
      return file;
    }
    const bool transmission = line == "MBSDF_DATA_TRANSMISSION=";
    if (transmission || line == "MBSDF_DATA_REFLECTION=" || line == "MBSDF_DATA=") {
      const std::string name = transmission ? "transmission" : "reflection";
      Block block;
      if (!parse_block(reader, name, block, problems)) return file;
      if (transmission) {
        file.has_transmission = true;
      } else if (!reflection.values.empty()) {
        problems.push_back({"reflection", "a second part", "one part", true});
        return file;
      } else {
        reflection = std::move(block);
      }
    } else if (!line.empty()) {
      file.description += (file.description.empty() ? "" : "\n") + line;
    }
  }
  if (reflection.values.empty()) {
    problems.push_back({"reflection", file.has_transmission ? "none (the file holds transmission alone)" : "none",
                        "a part MBSDF_DATA_REFLECTION= or MBSDF_DATA=", true});
    return file;
  }
  if (file.has_transmission) {
    problems.push_back(
        {"transmission", "a part MBSDF_DATA_TRANSMISSION=", "reflection alone: transmission is ignored", false});
  }
  file.n_theta_in = file.n_theta_out = reflection.n_theta;
  file.n_phi = reflection.n_phi;
  file.channels = reflection.channels;
  file.values = std::move(reflection.values);
  return file;
}

MbsdfFile read_mbsdf(const std::filesystem::path& path) {
  Problems problems;
  MbsdfFile file = parse_mbsdf(read_bytes(path), problems);
  throw_if_fatal(path.string(), problems);
  return file;
}

namespace {

void check_shape(const MbsdfFile& file) {
  const auto side = [](int n) { return n >= 1 && n <= max_grid_side; };
  if (!side(file.n_theta_in) || !side(file.n_theta_out) || !side(file.n_phi) ||
      (file.channels != 1 && file.channels != 3)) {
    throw Error("dimensions: found " + std::to_string(file.n_theta_in) + " x " + std::to_string(file.n_theta_out) +
                " x " + std::to_string(file.n_phi) + " x " + std::to_string(file.channels) +
                ", expected sizes of 1 to 16384 and 1 or 3 channels");
  }
  const std::size_t count = static_cast<std::size_t>(file.n_theta_in) * file.n_theta_out * file.n_phi * file.channels;
  if (file.values.size() != count) {
    throw Error("values: found " + std::to_string(file.values.size()) + ", expected " + std::to_string(count));
  }
}

}  // namespace

void write_mbsdf(const std::filesystem::path& path, const MbsdfFile& file) {
  check_shape(file);
  if (file.n_theta_in != file.n_theta_out) {
    throw Error(path.string() + ": n_theta: found " + std::to_string(file.n_theta_in) + " in and " +
                std::to_string(file.n_theta_out) + " out, expected the same number");
  }
  write_stream_atomically(path, [&](std::ostream& stream) {
    const std::uint32_t header[3] = {file.channels == 3 ? 1u : 0u, static_cast<std::uint32_t>(file.n_theta_in),
                                     static_cast<std::uint32_t>(file.n_phi)};
    stream << magic << "MBSDF_DATA_REFLECTION=\n";
    stream.write(reinterpret_cast<const char*>(header), sizeof(header));
    stream.write(reinterpret_cast<const char*>(file.values.data()),
                 static_cast<std::streamsize>(file.values.size() * sizeof(float)));
  });
}

MbsdfTable::MbsdfTable(const MbsdfFile& file, const CellPolicies& policies)
    : n_theta_in_(file.n_theta_in),
      n_theta_out_(file.n_theta_out),
      n_phi_(file.n_phi),
      has_transmission_(file.has_transmission) {
  check_shape(file);
  const auto channels = static_cast<std::size_t>(file.channels);
  const std::size_t count = file.values.size() / channels;
  values_.reserve(count + 1);
  values_.resize(count);
  std::vector<CellKind> kinds(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* value = &file.values[i * channels];
    values_[i] = channels == 3 ? glm::vec3(value[0], value[1], value[2]) : glm::vec3(value[0]);
    kinds[i] = kind_of(values_[i]);
  }
  const auto n_in = static_cast<std::size_t>(n_theta_in_);
  const auto n_out = static_cast<std::size_t>(n_theta_out_);
  const auto n_phi = static_cast<std::size_t>(n_phi_);
  counts_ =
      repair_cells(values_, kinds, policies,
                   {{n_in * n_out, n_phi, 1, false}, {n_in, n_out, n_phi, false}, {1, n_in, n_out * n_phi, false}});
  values_.emplace_back(0.0f);
  measured_ = MeasuredCells(cell_origins(kinds, policies), n_theta_out_, n_phi_);
}

struct MbsdfTable::Neighbours {
  Lerp i, o, p;
};

MbsdfTable::Neighbours MbsdfTable::neighbours_of(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const auto position = [](float angle, float range, int n) {
    return lerp_clamped(angle * (static_cast<float>(n) / range) - 0.5f, n);
  };
  const auto theta = [](const glm::vec3& w) { return fast_atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); };
  // At the pole, where wi has no azimuth, phi is relative to +x.
  const bool pole = wi.x == 0.0f && wi.y == 0.0f;
  const float ix = pole ? 1.0f : wi.x, iy = pole ? 0.0f : wi.y;
  const float phi = std::abs(fast_atan2(ix * wo.y - iy * wo.x, ix * wo.x + iy * wo.y));
  return {position(theta(wi), pi<float> / 2, n_theta_in_), position(theta(wo), pi<float> / 2, n_theta_out_),
          position(phi, pi<float>, n_phi_)};
}

float MbsdfTable::measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const Neighbours between = neighbours_of(wi, wo);
  return measured_.share(between.i, between.o, between.p);
}

glm::vec3 MbsdfTable::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const Neighbours between = neighbours_of(wi, wo);
  const Lerp &i = between.i, &o = between.o, &p = between.p;
  const auto row = [&](int in, int out) {
    const glm::vec3* cells = values_.data() + (static_cast<std::ptrdiff_t>(in) * n_theta_out_ + out) * n_phi_;
    return lerp(cells[p.lo], cells[p.hi], p.t);
  };
  return lerp(lerp(row(i.lo, o.lo), row(i.lo, o.hi), o.t), lerp(row(i.hi, o.lo), row(i.hi, o.hi), o.t), i.t);
}

}  // namespace gonio
