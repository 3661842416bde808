#pragma once

#include <string>
#include <vector>

#include <gonio/brdf/table/table.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio::proof {

/// The Gallery: generated inputs, each there for one way in which sampling code goes wrong. The same
/// on every machine; made in memory, some thousand values each.

/// A stack of densities, given directly at the crossings: what Stack is built from.
struct GalleryStack {
  std::string name;
  std::string reason;         ///< what it is there for, one line
  StackGrid grid;             ///< diagrams at gallery_angles (one of them where the name says so)
  bool zero_regions = false;  ///< an area without density (or of less probability than a float can
                              ///< tell from 0): no continuous map of the square exists there
};

/// The incident angles of the stacks [rad]: the first is normal incidence, the last leaves 9.8 degrees
/// to the horizon.
inline constexpr double gallery_angles[] = {0.0, 0.45, 0.95, 1.4};

std::vector<GalleryStack> gallery_stacks();

/// Whether all diagrams of a stack have the lines of the first, as Interpolation::blend needs.
bool shared_lines(const StackGrid& grid);

/// A measured table, as a file would hold it: what BrdfTable and Bsdf are made of.
struct GalleryTable {
  std::string name;
  std::string reason;
  MbsdfFile file;
  bool zero_regions = false;  ///< as in GalleryStack
};

std::vector<GalleryTable> gallery_tables();

/// The table of a Gallery entry, repaired by the default policies.
BrdfTable to_table(const GalleryTable& entry);

}  // namespace gonio::proof
