#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <gonio/brdf/bsdf/bsdf.h>

namespace gonio {

/// A stack of diagrams as an OpenEXR file, readable by any viewer of multi-part images. The layout
/// is described in docs/formats/stack-file.md.
struct StackFile {
  BsdfData bsdf;              ///< without colours f_r is that of the table
  std::string name;           ///< of the material
  std::string source;         ///< file the stack was made of, without its folder; empty if unknown
  std::string comments = {};  ///< how it was made, who measured it, its licence: lines for people; may be empty
};

/// Version of the layout that save_stack() writes, and the oldest one that load_stack() reads.
inline constexpr int stack_file_version = 3, oldest_stack_file_version = 2;

/// Writes `file`, replacing the target as a whole or leaving it as it was. Densities are rounded16(): what a Bsdf
/// samples, and what was loaded from a file, survives bit by bit.
/// @throws Error if the path cannot be written, and as rounded16() does.
void save_stack(const std::filesystem::path& path, const StackFile& file);

/// @throws Error naming the part and the field if the file is not a stack file, is damaged, or has
///   another version.
StackFile load_stack(const std::filesystem::path& path);

/// True if the file begins like an OpenEXR file. @throws Error if it cannot be read.
bool is_exr(const std::filesystem::path& path);

/// What a renderer calls: milliseconds. With a table f_r is the table's, otherwise that of the file's colours.
/// @throws Error as load_stack() and Bsdf do, and for a file without colours where there is no table.
Bsdf load_bsdf(const std::filesystem::path& path, std::shared_ptr<const BrdfTable> table = nullptr);

/// The same for a file that load_stack() has read from `path`, which messages name.
Bsdf to_bsdf(const StackFile& file, const std::filesystem::path& path,
             std::shared_ptr<const BrdfTable> table = nullptr);

}  // namespace gonio
