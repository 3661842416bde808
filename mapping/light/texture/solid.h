#pragma once

#include <array>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gonio/mapping/light/texture/light_texture.h>

namespace gonio {

/// Any way to tell the intensity [cd] in a direction of space (a unit vector).
using Reconstruction = std::function<double(const Vec3<double>&)>;

Reconstruction bilinear_reconstruction(LightDiagram diagram);
Reconstruction texture_reconstruction(LightTexture texture);
Reconstruction two_plane_reconstruction(LightDiagram diagram);

/// A closed triangle mesh, triangles counter-clockwise seen from outside.
struct Mesh {
  std::vector<Vec3<float>> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// The photometric solid: the surface at distance intensity * scale from the origin in every
/// direction, tabulated on `rows` steps of gamma and `columns` steps of C, in the library's frame.
/// Where the luminaire is dark the surface closes in the origin.
/// @throws Error for fewer than 2 rows or 3 columns.
Mesh photometric_solid(const Reconstruction& intensity, int rows, int columns, double scale);

void write_obj(std::ostream& stream, const Mesh& mesh, const std::string& name);
/// Binary, little-endian.
void write_ply(std::ostream& stream, const Mesh& mesh);

/// How far two reconstructions are from each other, everything relative to the largest intensity of
/// `reference`.
struct LightDifference {
  double rms;        ///< over the sphere
  double largest;    ///< of |difference| in a direction
  double hausdorff;  ///< distance of the two solids: largest distance of a point of one to the other
  double flux;       ///< flux of the other over that of the reference, minus 1
};

/// Compared on 2 x 2 degrees, or finer: rows steps of gamma, 2 rows of C. The Hausdorff distance is
/// that of the two triangle meshes, measured from the vertices of each to the triangles of the
/// other.
LightDifference compare(const Reconstruction& reference, const Reconstruction& other, int rows = 180);

/// Every second parallel and, where there are enough, every second meridian of an even diagram:
/// what is left when half of the measured angles are left out. The poles and the horizon of a
/// hemisphere stay. @throws Error if there are fewer than 3 parallels or they are not even in
/// number minus one.
LightDiagram every_second(const LightDiagram& diagram);

/// The errors at the angles that every_second() leaves out, relative to I_max.
struct Prediction {
  double rms, largest;
  std::size_t angles;  ///< left out
};
Prediction predict_left_out(const LightDiagram& diagram, const Reconstruction& from_the_rest);

}  // namespace gonio
