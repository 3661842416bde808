#pragma once

#include <gonio/mapping/diagram/diagram_fit.h>

namespace gonio::detail {

/// Raises a fitted diagram next to the horizon, so that hardly any weight density / diagram is above 1.1 times its mean
/// there. The fit cannot see to that: there is next to no mass, but every side of the unit square, and any light
/// that shines from there. It adds some 1e-4 of the mass. @param density that the diagram was fitted to, in its scale.
void raise_tail(const DiskDensity& density, DiagramGrid& grid);

}  // namespace gonio::detail
