#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gonio/mapping/light/diagram/light_diagram.h>
#include <gonio/mapping/sphere/sphere.h>

namespace gonio {

/// Importance sampling of a luminaire's emission by the goniometric mapping.
///
/// Directions are drawn by the diagram that is linear in r between its parallels; the weight
/// carries the correction factor of Havran et al. (2003, section 6.1), so that the emitted energy
/// is exactly that of the light diagram, which is linear in gamma. weight * pdf = intensity in
/// every direction.
///
/// Thread safety: immutable; concurrent use is safe. No allocation, lock or virtual call in the
/// maps.
template <class T>
class EmissionSampler {
 public:
  /// A dark hemisphere is left out: a luminaire that lights one hemisphere costs half.
  /// @throws Error as check(), and if the diagram is dark everywhere.
  explicit EmissionSampler(const LightDiagram& diagram);

  struct Sample {
    Vec3<T> direction;  ///< unit vector, in space
    T pdf;              ///< [1/sr]
    T weight;           ///< intensity / pdf [lm]: the flux that this one draw stands for
  };

  /// @param u,v in [0, 1].
  Sample sample(T u, T v) const noexcept;
  /// The pdf [1/sr] of sample() in a direction of space (a unit vector); 0 where the luminaire is
  /// dark.
  T pdf(const Vec3<T>& direction) const noexcept;
  /// The intensity [cd] of the light diagram: what weight * pdf is.
  T intensity(const Vec3<T>& direction) const noexcept;
  /// The (u, v) that sample() maps to `direction`.
  SquarePoint<T> invert(const Vec3<T>& direction) const noexcept;

  /// The flux [lm] of the light diagram, linear in gamma.
  double flux() const noexcept { return flux_; }
  /// The mean weight if gamma were read r-linearly [lm]: flux of the r-linear diagram.
  double mapped_flux() const noexcept { return mapped_flux_; }
  const SphereDiagram<T>& map() const noexcept { return map_; }

 private:
  Vec3<T> to_local(const Vec3<T>& w) const noexcept { return {dot(w, x_), dot(w, y_), dot(w, z_)}; }
  static T dot(const Vec3<T>& a, const Vec3<T>& b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
  bool covered(const Vec3<T>& local) const noexcept { return local.z >= 0 || !map_.hemisphere(); }

  SphereDiagram<T> map_;
  Vec3<T> x_, y_, z_;  // the axes of the map in space; z is the pole that it starts from
  double flux_, mapped_flux_;
};

template <class T>
typename EmissionSampler<T>::Sample EmissionSampler<T>::sample(T u, T v) const noexcept {
  const auto position = map_.at(u, v);
  const Vec3<T> w = map_.direction(position);
  const T pdf = map_.pdf(position);
  const T correction = pdf > 0 ? map_.theta_linear(position) / pdf : T(0);
  return {w.x * x_ + w.y * y_ + w.z * z_, pdf, static_cast<T>(mapped_flux_) * correction};
}

template <class T>
T EmissionSampler<T>::pdf(const Vec3<T>& direction) const noexcept {
  const Vec3<T> local = to_local(direction);
  return covered(local) ? map_.pdf(map_.position_of(local)) : T(0);
}

template <class T>
T EmissionSampler<T>::intensity(const Vec3<T>& direction) const noexcept {
  const Vec3<T> local = to_local(direction);
  return covered(local) ? static_cast<T>(mapped_flux_) * map_.theta_linear(map_.position_of(local)) : T(0);
}

template <class T>
SquarePoint<T> EmissionSampler<T>::invert(const Vec3<T>& direction) const noexcept {
  return map_.square_of(map_.position_of(to_local(direction)));
}

extern template class EmissionSampler<float>;
extern template class EmissionSampler<double>;

/// How well and how fast emission is sampled by one method.
struct EmissionQuality {
  std::string id;               ///< "uniform", "texels", "r_linear", "gamma_linear"
  std::string method;           ///< the same in words
  double flux;                  ///< mean weight [lm]
  double relvar;                ///< Var[w] / E[w]^2, w the weight of a draw
  double nanoseconds_per_draw;  ///< direction, pdf and weight, on this machine
};

/// Relative variance of emission on a jittered grid of draws x draws points (fixed seed), for:
/// directions uniform over the sphere (or the lit hemisphere), a cumulative table of texels of 1 x
/// 1 degree with the intensity at their centre (as renderers do with an image), the goniometric
/// mapping with weights linear in r, and with the correction to weights linear in gamma.
/// @throws Error as EmissionSampler. @param draws >= 2.
std::vector<EmissionQuality> emission_quality(const LightDiagram& diagram, int draws = 256);

}  // namespace gonio
