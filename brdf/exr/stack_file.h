#pragma once

#include <filesystem>
#include <string>

#include <gonio/brdf/bsdf/compact_bsdf.h>

namespace gonio {

/// A stack of diagrams as an OpenEXR file, readable by any viewer of multi-part images. The layout
/// is described in docs/stack-file.md.
struct StackFile {
  StackGrid diagrams;   ///< with their chart; densities normalised
  Colour colour;        ///< empty if the file has none; such a file needs its table for f_r
  std::string name;     ///< of the material
  std::string source;   ///< file the stack was made of, without its folder; empty if unknown
  /// What the diagrams were built for; nearest and mixture can always be used instead.
  Interpolation interpolation = Interpolation::displacement;
  Storage storage = Storage::float32;  ///< what the densities are to be held in
};

/// Version of the layout that save_stack() writes; load_stack() reads this one only.
inline constexpr int stack_file_version = 2;

/// Writes `file`, replacing the target as a whole or leaving it as it was. Values are stored as 32-bit
/// floats: what comes from a Stack<float>, a PackedStack or was loaded from a stack file survives bit by bit.
/// @throws Error if the path cannot be written.
void save_stack(const std::filesystem::path& path, const StackFile& file);

/// @throws Error naming the part and the field if the file is not a stack file, is damaged, or has
///   another version.
StackFile load_stack(const std::filesystem::path& path);

/// True if the file begins like an OpenEXR file. @throws Error if it cannot be read.
bool is_exr(const std::filesystem::path& path);

/// What a renderer calls. @throws Error as load_stack(), and for a file without colour.
CompactBsdf load_compact(const std::filesystem::path& path);

}  // namespace gonio
