#pragma once

#include <gonio/mapping/diagram/diagram.h>

namespace gonio {

/// The map of the linear blend (1 - alpha) d0 + alpha d1 of two diagrams on the same lines. The blend is
/// itself a bilinear density on these lines and its cumulative arrays are the blends of theirs, so that
/// it is sampled and inverted as one diagram is (see Diagram): in closed form, without iteration and
/// without a third random number, and continuous in (u, v) and alpha. A lobe that moves between the
/// diagrams is blended into two; the half-vector chart keeps it in place.
///
/// A view: both diagrams must outlive it, and have the same azimuth and lines. u goes over that azimuth.
/// Errors: those of Diagram, with 1 epsilon more. Thread safety: immutable; concurrent use is safe.
template <class T>
class Blend {
 public:
  /// @param alpha in [0, 1]; 0 is `first`, 1 is `second`.
  Blend(const Diagram<T>& first, const Diagram<T>& second, T alpha) noexcept
      : d0_(first), d1_(second), w0_(1 - alpha), w1_(alpha) {}

  /// As Diagram's.
  PolarSample<T> sample(T u, T v, T rest) const noexcept { return sample_lines(*this, u, v, rest); }
  T pdf(Polar<T> at) const noexcept { return pdf_of_lines(*this, at); }
  PolarInverse<T> invert(Polar<T> at) const noexcept { return invert_lines(*this, at); }

  int meridians() const noexcept { return d0_.meridians(); }
  const T* phi() const noexcept { return d0_.phi(); }
  T before(int i) const noexcept { return w0_ * d0_.before(i) + w1_ * d1_.before(i); }
  T along(int i) const noexcept { return w0_ * d0_.along(i) + w1_ * d1_.along(i); }

  /// The rows of both diagrams on either side of a position, and their weights. The cumulative rows lie `stride` behind
  /// the densities.
  struct Sums {
    const T *a0, *a1, *b0, *b1;
    T wa0, wa1, wb0, wb1;
    int stride;

    T density(int j) const noexcept { return wa0 * a0[j] + wa1 * a1[j] + wb0 * b0[j] + wb1 * b1[j]; }
    T before(int j) const noexcept { return density(stride + j); }
  };
  RowOfSums<T, Sums> row(int i, T a) const noexcept {
    return {{d0_.density(i), d0_.density(i + 1), d1_.density(i), d1_.density(i + 1), w0_ * (1 - a), w0_ * a,
             w1_ * (1 - a), w1_ * a, d0_.meridians() * d0_.parallels()},
            d0_.r(),
            d0_.parallels()};
  }

 private:
  const Diagram<T>&d0_, &d1_;
  T w0_, w1_;
};

}  // namespace gonio
