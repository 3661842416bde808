#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>
#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/brdf/value/arrays3.h>
#include <gonio/brdf/value/luminance.h>

namespace gonio {

/// A measured isotropic BRDF, whatever file it came from.
///
/// Frame: local, the surface normal is +z; `wi` and `wo` are unit vectors that point away from the
/// surface. `wi` is the known direction, the one that the file is indexed by. Only directions on the
/// upper side reflect: eval() is 0 when either z is <= 0.
///
/// Thread safety: immutable after construction; every const member may be called concurrently.
class BrdfTable {
 public:
  using Data = std::variant<MerlTable, RglTable, MbsdfTable>;

  struct Info {
    std::string name;            ///< file name without folder and extension
    std::string source;          ///< path as it was given
    std::string format;          ///< "merl", "rgl" or "mbsdf"
    std::string description;     ///< free text of the file, empty where the format has none
    std::uint64_t source_bytes;  ///< size of the file
    CellCounts cells;            ///< cells seen and repaired while loading
  };

  BrdfTable(Data data, Info info) : data_(std::move(data)), info_(std::move(info)) {}

  /// f_r(wi, wo) in 1/sr per RGB channel (linear Rec. 709), without the cosine, never negative, never
  /// NaN; 0 for directions at or below the horizon. No allocation.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// eval() of `count` pairs, on the vectors of the best instruction set that the machine has: ten times as fast.
  /// Arrays hold `count` floats, in any alignment; an output must not overlap an input. No allocation.
  ///
  /// Values are those of eval() but for rounding, most within 2e-7, relative. All are within the sum of 1e-5, relative;
  /// 1e-5 of what they would be if all cells were as bright as the brightest; and what eval() changes by as the
  /// directions move by 1e-5. Only next to a line without density, which an RGL file may have, is it more.
  void eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept;

  /// The share of that value which comes from cells that were measured, in [0, 1]: 1 unless some were
  /// made up while loading, because the file has no value there, or `wi` is outside the angles of
  /// the file. 0 for directions at or below the horizon. No allocation.
  float measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const Data& data() const noexcept { return data_; }
  const Info& info() const noexcept { return info_; }

 private:
  Data data_;
  Info info_;
};

/// Reads a MERL `.binary`, an isotropic RGL `.bsdf` or an NVIDIA `.mbsdf` file. The format is
/// recognised by content, never by name.
/// @throws Error if the file cannot be read, is none of the formats, is damaged, or holds a material
///   that is not isotropic or has no reflection; the message says which field is at fault.
BrdfTable load_table(const std::filesystem::path& path, const CellPolicies& policies = {});

/// `table` itself. @throws Error if it is null; `user` says what needs it.
std::shared_ptr<const BrdfTable> required_table(std::shared_ptr<const BrdfTable> table, const std::string& user);

}  // namespace gonio
