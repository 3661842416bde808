#pragma once

namespace gonio {

template <class T>
inline constexpr T pi = static_cast<T>(3.141592653589793238462643383279502884L);

}  // namespace gonio
