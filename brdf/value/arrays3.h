#pragma once

namespace gonio {

/// Three arrays: directions by component, or colours by channel.
struct ConstArrays3 {
  const float *x, *y, *z;
};
struct Arrays3 {
  float *x, *y, *z;
  operator ConstArrays3() const noexcept { return {x, y, z}; }
};

}  // namespace gonio
