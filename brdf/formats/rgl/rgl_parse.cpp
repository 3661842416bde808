#include <algorithm>
#include <cmath>
#include <limits>

#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/brdf/formats/rgl/spectrum.h>
#include <gonio/brdf/formats/rgl/tensor_file.h>
#include <gonio/mapping/base/bytes.h>

namespace gonio {
namespace {

constexpr double half_pi = 1.57079632679489661923;
constexpr const char* anisotropic = "at most 2 with the same data: only isotropic materials are supported";

// Reads the fields one by one and collects everything that is wrong with them.
class Parser {
 public:
  Parser(const TensorFile& file, Problems& problems) : file_(file), problems_(problems) {}

  RglFile parse() {
    RglFile result;
    result.description = text("description");
    read_angles(result);
    result.ndf = read_table("ndf");
    result.sigma = read_table("sigma");
    result.vndf = read_density("vndf");
    result.luminance = read_density("luminance");
    read_colour(result);
    if (const TensorFile::Field* field = require("jacobian", TensorFile::Type::u8, {1})) {
      const int value = file_.octets(*field)[0];
      result.jacobian = value != 0;
      if (value > 1) report("jacobian", std::to_string(value), "0 or 1");
    }
    return result;
  }

 private:
  static constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
  // A side of a grid: at least two nodes, and a bound that keeps indices within int.
  static constexpr std::uint64_t side = any - 1;
  static constexpr std::uint64_t max_side = 1u << 14;

  void report(const std::string& field, const std::string& found, const std::string& expected, bool fatal = true) {
    problems_.push_back({field, found, expected, fatal});
  }

  // The field if it has this type and shape, else null and a problem.
  const TensorFile::Field* require(const std::string& name, TensorFile::Type type,
                                   const std::vector<std::uint64_t>& shape) {
    const TensorFile::Field* field = file_.find(name);
    TensorFile::Field wanted{};
    wanted.type = type;
    bool fits = field != nullptr && field->type == type && field->shape.size() == shape.size();
    std::string expected = to_string(wanted).substr(0, to_string(wanted).find(' ')) + " [";
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const std::string text = shape[i] == any    ? "at least 1"
                               : shape[i] == side ? "2 to " + std::to_string(max_side)
                                                  : std::to_string(shape[i]);
      expected += (i > 0 ? ", " : "") + text;
      if (!fits) continue;
      const std::uint64_t n = field->shape[i];
      fits = shape[i] == any ? n >= 1 && n <= max_side : shape[i] == side ? n >= 2 && n <= max_side : n == shape[i];
    }
    if (fits) return field;
    report(name, field == nullptr ? "no such field" : to_string(*field), expected + "]");
    return nullptr;
  }

  std::string text(const std::string& name) {
    const TensorFile::Field* field = file_.find(name);
    if (field == nullptr || field->type != TensorFile::Type::u8 || field->shape.size() != 1) {
      report(name, field == nullptr ? "no such field" : to_string(*field), "text: u8 [length]", false);
      return "";
    }
    const std::vector<std::uint8_t> octets = file_.octets(*field);
    return std::string(octets.begin(), octets.end());
  }

  void read_angles(RglFile& result) {
    if (const TensorFile::Field* field = require("phi_i", TensorFile::Type::f32, {any})) {
      n_phi_ = field->count;
      if (n_phi_ > 2) report("phi_i", std::to_string(n_phi_) + " entries", anisotropic);
    }
    const TensorFile::Field* field = require("theta_i", TensorFile::Type::f32, {any});
    if (field == nullptr) return;
    result.theta_i = file_.floats(*field);
    n_theta_ = field->count;
    for (std::size_t i = 0; i < n_theta_; ++i) {
      const float theta = result.theta_i[i];
      const std::string name = "theta_i[" + std::to_string(i) + "]";
      if (!(theta >= 0.0f && theta <= half_pi + 1e-3)) {
        report(name, std::to_string(theta), "0 to pi/2");
      } else if (i > 0 && !(theta > result.theta_i[i - 1])) {
        report(name, std::to_string(theta), "more than its predecessor " + std::to_string(result.theta_i[i - 1]));
      }
    }
  }

  // Values that RglTable repairs, as long as one of them is valid.
  void check_density(const std::string& name, const std::vector<float>& values) {
    std::size_t negative = 0, nonfinite = 0;
    for (const float value : values) {
      if (!std::isfinite(value)) {
        ++nonfinite;
      } else if (value < 0.0f) {
        ++negative;
      }
    }
    if (negative + nonfinite == values.size()) {
      report(name, "no valid value of " + std::to_string(values.size()), "at least one");
      return;
    }
    const auto warn = [&](std::size_t count, const char* kind) {
      if (count == 0) return;
      report(name, std::to_string(count) + " " + kind + " of " + std::to_string(values.size()), "none", false);
    };
    warn(negative, "negative");
    warn(nonfinite, "not finite");
  }

  RglFile::Grid read_table(const std::string& name) {
    // These two may be given for a single azimuth row as well.
    const TensorFile::Field* field = require(name, TensorFile::Type::f32, {any, side});
    if (field == nullptr) return {};
    RglFile::Grid grid{1, static_cast<int>(field->shape[0]), static_cast<int>(field->shape[1]), file_.floats(*field)};
    check_density(name, grid.values);
    return grid;
  }

  // Drops the second of two phi_i slices, which must agree with the first.
  void drop_second_phi(const std::string& name, std::vector<float>& values) {
    if (n_phi_ != 2) return;
    const std::size_t half = values.size() / 2;
    float largest = 0.0f, difference = 0.0f;
    for (std::size_t i = 0; i < half; ++i) {
      if (!std::isfinite(values[i]) || !std::isfinite(values[half + i])) continue;
      largest = std::max({largest, std::abs(values[i]), std::abs(values[half + i])});
      difference = std::max(difference, std::abs(values[i] - values[half + i]));
    }
    if (difference > 1e-3f * largest) report(name, "different data for the 2 phi_i", anisotropic);
    values.resize(half);
  }

  RglFile::Grid read_density(const std::string& name) {
    const TensorFile::Field* field = require(name, TensorFile::Type::f32, {n_phi_, n_theta_, side, side});
    if (field == nullptr) return {};
    RglFile::Grid grid{static_cast<int>(n_theta_), static_cast<int>(field->shape[2]), static_cast<int>(field->shape[3]),
                       file_.floats(*field)};
    drop_second_phi(name, grid.values);
    check_density(name, grid.values);
    const std::size_t size = grid.values.size() / n_theta_;
    for (std::size_t s = 0; s < n_theta_; ++s) {
      const auto begin = grid.values.begin() + static_cast<std::ptrdiff_t>(s * size);
      if (std::all_of(begin, begin + static_cast<std::ptrdiff_t>(size), [](float value) { return value <= 0.0f; })) {
        report(name + "[" + std::to_string(s) + "]", "nothing above 0", "a density (taken as uniform)", false);
      }
    }
    return grid;
  }

  void read_colour(RglFile& result) {
    const bool spectral = file_.find("rgb") == nullptr && file_.find("spectra") != nullptr;
    const std::string name = spectral ? "spectra" : "rgb";
    std::vector<glm::vec3> weights = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (spectral) {
      weights = read_wavelengths();
      if (weights.empty()) return;
      result.n_wavelengths = static_cast<int>(weights.size());
    }
    const TensorFile::Field* field =
        require(name, TensorFile::Type::f32, {n_phi_, n_theta_, weights.size(), side, side});
    if (field == nullptr) return;
    std::vector<float> values = file_.floats(*field);
    drop_second_phi(name, values);
    result.colour_height = static_cast<int>(field->shape[3]);
    result.colour_width = static_cast<int>(field->shape[4]);
    const std::size_t size = field->shape[3] * field->shape[4];
    result.colour.assign(n_theta_ * size, glm::vec3(0.0f));
    for (std::size_t s = 0; s < n_theta_; ++s) {
      for (std::size_t k = 0; k < weights.size(); ++k) {
        if (weights[k] == glm::vec3(0.0f)) continue;  // a NaN in the infrared does not matter
        const float* plane = &values[(s * weights.size() + k) * size];
        for (std::size_t i = 0; i < size; ++i) {
          glm::vec3& cell = result.colour[s * size + i];
          if (spectral) {
            cell += weights[k] * plane[i];
          } else {
            cell[static_cast<int>(k)] = plane[i];
          }
        }
      }
    }
  }

  std::vector<glm::vec3> read_wavelengths() {
    const TensorFile::Field* field = require("wavelengths", TensorFile::Type::f32, {side});
    if (field == nullptr) return {};
    const std::vector<float> wavelengths = file_.floats(*field);
    for (std::size_t i = 0; i < wavelengths.size(); ++i) {
      if (!std::isfinite(wavelengths[i]) || (i > 0 && !(wavelengths[i] > wavelengths[i - 1]))) {
        report("wavelengths[" + std::to_string(i) + "]", std::to_string(wavelengths[i]),
               "a number above its predecessor");
        return {};
      }
    }
    if (wavelengths.front() > 430.0f || wavelengths.back() < 650.0f) {
      report("wavelengths", std::to_string(wavelengths.front()) + " to " + std::to_string(wavelengths.back()) + " nm",
             "at least 430 to 650 nm, to find a colour");
      return {};
    }
    return rec709_weights(wavelengths);
  }

  const TensorFile& file_;
  Problems& problems_;
  std::uint64_t n_phi_ = 1, n_theta_ = 1;
};

}  // namespace

RglFile parse_rgl(std::string bytes, Problems& problems) {
  const std::size_t before = problems.size();
  const TensorFile file(std::move(bytes), problems);
  const bool container_read =
      problems.size() == before || file.find("theta_i") != nullptr || file.find("vndf") != nullptr;
  return container_read ? Parser(file, problems).parse() : RglFile{};
}

RglFile read_rgl(const std::filesystem::path& path) {
  Problems problems;
  RglFile file = parse_rgl(read_bytes(path), problems);
  throw_if_fatal(path.string(), problems);
  return file;
}

}  // namespace gonio
