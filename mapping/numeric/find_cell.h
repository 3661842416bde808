#pragma once

namespace gonio {

/// The largest i in [0, n - 2] with x(i) < t (0 if there is none), x ascending: the cell that ends at or after t
/// and, when x is cumulative and t > 0, has mass.
template <class Value, class T>
inline int find_cell_of(const Value& x, int n, T t) noexcept {
  // The last steps of the bisection, each of which waits for the one before, as one pass of vectors.
  constexpr int pass = 32;
  int first = 0, length = n - 1;
  while (length > pass) {
    const int half = length / 2;
    first = x(first + half) < t ? first + half : first;
    length -= half;
  }
  int before = 0;
  for (int k = 1; k < length; ++k) before += x(first + k) < t;
  return first + before;
}
template <class T>
inline int find_cell(const T* x, int n, T t) noexcept {
  return find_cell_of([x](int i) { return x[i]; }, n, t);
}

}  // namespace gonio
