#pragma once

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// A point of the disk with the density per 2 r dr dphi there.
template <class T>
struct PolarSample {
  Polar<T> at;
  T pdf;
};

/// Two uniform numbers of a diagram with the density of their image.
template <class T>
struct PolarInverse {
  T u, v, pdf;
};

}  // namespace gonio
