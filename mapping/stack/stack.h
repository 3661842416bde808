#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gonio/mapping/charts/chart.h>
#include <gonio/mapping/charts/half_vector.h>
#include <gonio/mapping/diagram/blend.h>
#include <gonio/mapping/diagram/displacement.h>

namespace gonio {

/// How a stack samples between two of its diagrams.
enum class Interpolation {
  nearest,       ///< the diagram whose theta_i is closer; the pdf jumps half way between
  mixture,       ///< one of the two at random, by the weights; two half-height lobes, not coherent
  displacement,  ///< the images of (u, v) interpolated: one lobe that moves; see Displacement
  blend          ///< the densities interpolated, on lines that all diagrams share; see Blend
};

inline constexpr Interpolation interpolations[] = {Interpolation::nearest, Interpolation::mixture,
                                                   Interpolation::displacement, Interpolation::blend};
const char* to_string(Interpolation interpolation) noexcept;

/// A stack of diagrams as data, in double: what a Stack is built from and a stack file holds.
struct StackGrid {
  std::vector<double> theta_i;        ///< K >= 1 incident angles [rad], ascending, in [0, pi/2]
  std::vector<DiagramGrid> diagrams;  ///< one per angle, each with its own lines; all half or all full
  Chart chart = Chart::outgoing;
};

/// Diagrams indexed by the incident angle, and the map between unit square and hemisphere for any
/// angle: M_B of the concentric square, then M_C, M_D of the diagrams, interpolated, then M_E or, in the
/// half-vector chart, HalfVectorChart. Densities of diagrams are per 2 r dr dphi of the disk, which is the
/// solid angle of wo in the outgoing chart alone; those that come out are per solid angle in either.
///
/// Angles outside the stack use its first or last diagram. Directions are in the frame of the
/// diagram: x points along the azimuth of wi, so that the mirror direction is at phi = pi.
///
/// Thread safety: immutable; concurrent use is safe. No member but the constructor allocates.
template <class T>
class Stack {
 public:
  /// @throws Error if angles are not ascending in [0, pi/2], their number is not that of the
  ///   diagrams, a diagram is bad (see Diagram), or, for `blend`, two have different lines.
  Stack(const StackGrid& grid, Interpolation interpolation);

  /// The direction of (u, v) in [0, 1]^2 and its pdf.
  DirectionSample<T> sample(T theta_i, T u, T v) const noexcept;

  /// The pdf of `wo` [1/sr]; integrates to 1 over the hemisphere; 0 for wo.z < 0. In float, of a draw,
  /// within 2e-3 of the returned pdf, relative, besides 1e-4 of the largest density. For `displacement`
  /// between diagrams this inverts the map (at most 2 max_root_steps evaluations, typically 8).
  /// For `blend` it is one bilinear look-up of both diagrams.
  T pdf(T theta_i, const Vec3<T>& wo) const noexcept;

  /// The (u, v) that sample() maps to `wo`, with the pdf; empty for wo.z < 0 and where the density vanishes. A
  /// mixture has two pre-images: the one that floats hold better is returned.
  ///
  /// In float, where the density is at least 1e-6 of its largest value: sample() then invert() comes
  /// back to (u, v) within 1e-4 (not for mixtures); invert() then sample() to `wo` within 5e-4 in each
  /// component (half-vector chart: 1e-3; mixtures: 1e-2, in the half-vector chart 5e-2 as measured), or as near as the
  /// floats u and v let it come where the map is steep. In the half-vector chart these bounds hold for `blend` up to
  /// theta_i = 0.9, the last with 2e-3; beyond, a float wo holds its half vector to 1 / cos theta_i ulp, and beside the
  /// horizon displacement may find no way back.
  std::optional<SquareInverse<T>> invert(T theta_i, const Vec3<T>& wo) const noexcept;

  Interpolation interpolation() const noexcept { return interpolation_; }
  Chart chart() const noexcept { return chart_; }
  const std::vector<T>& theta_i() const noexcept { return theta_i_; }
  const std::vector<Diagram<T>>& diagrams() const noexcept { return diagrams_; }
  std::size_t bytes() const noexcept;  ///< all memory held, this object included
  StackGrid grid() const;              ///< as stored; a stack built from it equals this one bit by bit

 private:
  /// The diagrams that serve an angle: `alpha` of the way from `first` to `second`; alpha is 0 when
  /// one diagram is enough.
  struct Pair {
    const Diagram<T>&first, &second;
    T alpha;
  };
  Pair pair(T theta_i) const noexcept;
  bool half() const noexcept { return diagrams_.front().azimuth() == Azimuth::half; }

  Interpolation interpolation_;
  Chart chart_;
  std::vector<T> theta_i_;
  std::vector<Diagram<T>> diagrams_;
};

extern template class Stack<float>;
extern template class Stack<double>;
extern template class Stack<long double>;

}  // namespace gonio
