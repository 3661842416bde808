#include <cmath>
#include <limits>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/folded_disk.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

const char* to_string(Interpolation interpolation) noexcept {
  switch (interpolation) {
    case Interpolation::nearest:
      return "nearest";
    case Interpolation::mixture:
      return "mixture";
    case Interpolation::blend:
      return "blend";
    default:
      return "displacement";
  }
}

template <class T>
Stack<T>::Stack(const StackGrid& grid, Interpolation interpolation)
    : interpolation_(interpolation), chart_(grid.chart) {
  if (grid.theta_i.empty() || grid.theta_i.size() != grid.diagrams.size())
    throw Error("stack: found " + std::to_string(grid.theta_i.size()) + " incident angles and " +
                std::to_string(grid.diagrams.size()) + " diagrams, expected as many, at least one");
  for (std::size_t k = 0; k < grid.theta_i.size(); ++k) {
    const double theta = grid.theta_i[k];
    const bool ascending = k == 0 || static_cast<T>(theta) > theta_i_.back();
    if (!(theta >= 0 && theta <= pi<double> / 2 + 1e-6) || !ascending)
      throw Error("stack: theta_i[" + std::to_string(k) + "]: found " + std::to_string(theta) +
                  ", expected ascending angles in 0 to pi/2");
    if (grid.diagrams[k].azimuth != grid.diagrams.front().azimuth)
      throw Error("stack: diagram " + std::to_string(k) +
                  ": found another azimuth range than that of diagram 0, expected the same");
    theta_i_.push_back(static_cast<T>(theta));
    diagrams_.emplace_back(grid.diagrams[k]);
    if (interpolation == Interpolation::blend && !diagrams_[k].same_lines(diagrams_.front()))
      throw Error("stack: diagram " + std::to_string(k) +
                  ": found other lines than those of diagram 0, expected the same: blend needs shared lines");
  }
  theta_i_.shrink_to_fit();
  diagrams_.shrink_to_fit();
}

template <class T>
typename Stack<T>::Pair Stack<T>::pair(T theta_i) const noexcept {
  const auto [k, alpha] = bracket(theta_i_, theta_i);
  const Diagram<T>& first = diagrams_[k];
  if (alpha == 0) return {first, first, 0};
  const Diagram<T>& second = diagrams_[k + 1];
  if (alpha == 1) return {second, second, 0};
  if (interpolation_ == Interpolation::nearest) return alpha < T(0.5) ? Pair{first, first, 0} : Pair{second, second, 0};
  return {first, second, alpha};
}

template <class T>
DirectionSample<T> Stack<T>::sample(T theta_i, T u, T v) const noexcept {
  const DiskPoint<T> disk = square_to_disk(u, v);
  const Folded<T> folded = fold(disk.turn, half());
  const Pair at = pair(theta_i);
  PolarSample<T> s;
  if (at.alpha == 0) {
    s = at.first.sample(folded.u, disk.r2, disk.rest);
  } else if (interpolation_ == Interpolation::mixture) {
    const T w0 = 1 - at.alpha;
    const bool first = disk.r2 < w0;
    s = first ? at.first.sample(folded.u, disk.r2 / w0, (w0 - disk.r2) / w0)
              : at.second.sample(folded.u, (disk.r2 - w0) / at.alpha, disk.rest / at.alpha);
    const Diagram<T>& other = first ? at.second : at.first;
    s.pdf = (first ? w0 : at.alpha) * s.pdf + (first ? at.alpha : w0) * other.pdf(s.at);
  } else if (interpolation_ == Interpolation::blend) {
    s = Blend<T>(at.first, at.second, at.alpha).sample(folded.u, disk.r2, disk.rest);
  } else {
    s = Displacement<T>(at.first, at.second, at.alpha).sample(folded.u, disk.r2, disk.rest);
  }
  return from_disk(chart_, theta_i, s, folded.mirrored);
}

template <class T>
T Stack<T>::pdf(T theta_i, const Vec3<T>& wo) const noexcept {
  if (!(wo.z >= 0)) return 0;
  const OnDisk<T> d = to_disk(chart_, half(), theta_i, wo);
  const Pair p = pair(theta_i);
  if (p.alpha == 0) return p.first.pdf(d.at) / d.jacobian;
  if (interpolation_ == Interpolation::mixture)
    return ((1 - p.alpha) * p.first.pdf(d.at) + p.alpha * p.second.pdf(d.at)) / d.jacobian;
  if (interpolation_ == Interpolation::blend) return Blend<T>(p.first, p.second, p.alpha).pdf(d.at) / d.jacobian;
  return Displacement<T>(p.first, p.second, p.alpha).invert(d.at).pdf / d.jacobian;
}

template <class T>
std::optional<SquareInverse<T>> Stack<T>::invert(T theta_i, const Vec3<T>& wo) const noexcept {
  if (!(wo.z >= 0)) return std::nullopt;
  const auto [at, mirrored, jacobian] = to_disk(chart_, half(), theta_i, wo);
  const Pair p = pair(theta_i);
  PolarInverse<T> inverse;
  if (p.alpha == 0) {
    inverse = p.first.invert(at);
  } else if (interpolation_ == Interpolation::mixture) {
    const T w0 = 1 - p.alpha;
    const PolarInverse<T> a = p.first.invert(at), b = p.second.invert(at);
    // (u, v) hold r_B^2 to about r_B epsilon. Of the two pre-images the one whose direction that moves
    // less is taken, kept on its side of the border between them.
    const T v0 = w0 * a.v, v1 = w0 + p.alpha * b.v;
    const bool first = a.pdf > 0 && std::sqrt(v0) * (p.alpha * b.pdf) <= std::sqrt(v1) * (w0 * a.pdf);
    const T margin = 16 * std::numeric_limits<T>::epsilon() * std::sqrt(w0);
    inverse = first ? a : b;
    inverse.v = first ? std::max(std::min(v0, w0 - margin), T(0)) : std::max(v1, w0 + margin);
    inverse.pdf = w0 * a.pdf + p.alpha * b.pdf;
  } else if (interpolation_ == Interpolation::blend) {
    inverse = Blend<T>(p.first, p.second, p.alpha).invert(at);
  } else {
    inverse = Displacement<T>(p.first, p.second, p.alpha).invert(at);
  }
  if (!(inverse.pdf > 0)) return std::nullopt;
  const DiskPoint<T> disk{unfold(inverse.u, mirrored, half()), std::min(inverse.v, T(1))};
  return SquareInverse<T>{disk_to_square(disk), inverse.pdf / jacobian};
}

template <class T>
std::size_t Stack<T>::bytes() const noexcept {
  std::size_t sum = sizeof(*this) + theta_i_.capacity() * sizeof(T);
  for (const Diagram<T>& d : diagrams_) sum += d.bytes();
  return sum;
}

template <class T>
StackGrid Stack<T>::grid() const {
  StackGrid grid;
  grid.chart = chart_;
  grid.theta_i.assign(theta_i_.begin(), theta_i_.end());
  for (const Diagram<T>& d : diagrams_) grid.diagrams.push_back(d.grid());
  return grid;
}

template class Stack<float>;
template class Stack<double>;
template class Stack<long double>;

}  // namespace gonio
