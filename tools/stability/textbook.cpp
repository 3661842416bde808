#include "tools/stability/textbook.h"

namespace gonio::textbook {

Arrays::Arrays(const DiagramGrid& grid)
    : phi(grid.phi.begin(), grid.phi.end()),
      r(grid.r.begin(), grid.r.end()),
      density(grid.density.begin(), grid.density.end()) {
  const std::size_t m = phi.size(), n = r.size();
  double sum = 0, previous = 0;
  for (std::size_t i = 0; i < m; ++i) {
    double along = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j > 0) along += RadialCell<double>{r[j - 1], double(r[j]) - r[j - 1], at(i, j - 1), at(i, j)}.mass(1);
      cumulative.push_back(static_cast<float>(along));
    }
    if (i > 0) sum += (double(phi[i]) - phi[i - 1]) * (previous + along) / 2;
    cumulative_phi.push_back(static_cast<float>(sum));
    previous = along;
  }
}

template <class T>
ConstantCells<T>::ConstantCells(const Arrays& arrays)
    : phi(arrays.phi.begin(), arrays.phi.end()), r(arrays.r.begin(), arrays.r.end()) {
  const std::size_t m = phi.size(), n = r.size();
  sums.assign(m * n, T(0));
  for (std::size_t i = 1; i < m; ++i)
    for (std::size_t j = 1; j < n; ++j) {
      const T mean = (T(arrays.at(i - 1, j - 1)) + arrays.at(i, j - 1) + arrays.at(i - 1, j) + arrays.at(i, j)) / 4;
      const T mass = mean * (phi[i] - phi[i - 1]) * (r[j] - r[j - 1]) * (r[j] + r[j - 1]);
      sums[i * n + j] = sums[(i - 1) * n + j] + sums[i * n + j - 1] - sums[(i - 1) * n + j - 1] + mass;
    }
}

template <class T>
Polar<float> ConstantCells<T>::map(T u, T v) const {
  const std::size_t m = phi.size(), n = r.size();
  const auto marginal = [&](std::size_t i) { return sums[i * n + n - 1]; };
  const T target = u * marginal(m - 1);
  std::size_t i = 0;
  while (i + 2 < m && marginal(i + 1) < target) ++i;
  const T a = std::clamp((target - marginal(i)) / (marginal(i + 1) - marginal(i)), T(0), T(1));
  const auto conditional = [&](std::size_t j) { return sums[(i + 1) * n + j] - sums[i * n + j]; };
  const T mass = v * conditional(n - 1);
  std::size_t j = 0;
  while (j + 2 < n && conditional(j + 1) < mass) ++j;
  const T s = std::clamp((mass - conditional(j)) / (conditional(j + 1) - conditional(j)), T(0), T(1));
  const T r2 = r[j] * r[j] + s * (r[j + 1] - r[j]) * (r[j + 1] + r[j]);
  return {static_cast<float>(std::sqrt(r2)), static_cast<float>(phi[i] + a * (phi[i + 1] - phi[i]))};
}

template <class T>
T ConstantCells<T>::pdf(Polar<float> at) const {
  const std::size_t n = r.size();
  const std::size_t i = static_cast<std::size_t>(find_cell(phi.data(), static_cast<int>(phi.size()), T(at.phi)));
  const std::size_t j = static_cast<std::size_t>(find_cell(r.data(), static_cast<int>(n), T(at.r)));
  const T mass = sums[(i + 1) * n + j + 1] - sums[i * n + j + 1] - sums[(i + 1) * n + j] + sums[i * n + j];
  const T area = (phi[i + 1] - phi[i]) * (r[j + 1] - r[j]) * (r[j + 1] + r[j]);
  const T whole = phi.back() < 4 ? T(0.5) : T(1);  // the other half is the mirror image
  return whole * mass / (sums.back() * area);
}

template struct ConstantCells<float>;
template struct ConstantCells<double>;

}  // namespace gonio::textbook
