#pragma once

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// Solid angle [sr] of the part of the upper hemisphere that projects orthographically, along z, into
/// the rectangle [x0, x1] x [y0, y1] of the plane z = 0: the integral of 1 / sqrt(1 - x^2 - y^2) over
/// the rectangle within the unit disk. Parts outside the disk add nothing; the rectangle may lie
/// anywhere and be cut by the circle.
///
/// Relative error at most 1e-13 in double, 6e-8 (one rounding) in float, however small the rectangle
/// and however close to the circle: it is the error for exactly the coordinates given. An empty
/// rectangle (x1 <= x0 or y1 <= y0) has 0, NaN gives NaN. Thread-safe; instantiated for float and
/// double.
///
/// Patapom 2017, "Solid angle of an orthographically projected pixel", corrected. The primitive of
/// the page's eq. 2 lacks a factor y before its first arctangent; corrected it collapses to
///
///   A(x, y) = x atan2(y, s) + y atan2(x, s) - atan2(x y, s),  s = sqrt(max(1 - x^2 - y^2, 0)),
///
/// which with this s holds outside the circle as well. docs/guide/ndf.md derives that, and the bound by
/// which small rectangles, where the difference of A at four corners cancels, are integrated
/// numerically instead.
template <class T>
T orthographic_solid_angle(T x0, T x1, T y0, T y1) noexcept;

/// The integral of the unit normal h = (x, y, sqrt(1 - x^2 - y^2)) over the same solid angle. Its z
/// component is the area of the rectangle within the disk, as cos(theta) d omega = dx dy. k dot this
/// is the projected area of the rectangle as seen from k, where nothing of it turns away.
/// Absolute error at most 2e-15 per component; empty rectangles as above.
Vec3<double> orthographic_normal_integral(double x0, double x1, double y0, double y1) noexcept;

}  // namespace gonio
