#pragma once

#include <vector>

#include <gonio/brdf/ndf/image/disk_image.h>

namespace gonio {

/// Monodirectional shadowing G1(k) = cos(theta_k) / sigma(k) of a microsurface with a given normal
/// distribution, sigma(k) the integral of max(k . h, 0) D(h) d omega_h: its projected area as seen
/// from k, per area of the surface (Dupuy et al. 2015, eq. 3; Smith's assumption).
///
/// Every pixel is one facet: D times the integral of h over the pixel's solid angle (see
/// orthographic_normal_integral()), horizon included. docs/guide/ndf.md has the method and its errors: at
/// 512 x 512 within 1e-3 of the closed forms of GGX and Beckmann up to 85 degrees, for alpha from 0.02
/// (five pixels).
///
/// Immutable after construction: every const member may be called from several threads.
class Shadowing {
 public:
  /// @param ndf as normalise() leaves it. Takes O(size^2) per azimuth, on all cores.
  explicit Shadowing(const DiskImage& ndf);

  /// sigma for k of unit length with k.z >= 0, by the sum over all facets: O(size^2).
  double sigma_direct(const Vec3<double>& k) const noexcept;

  /// The same from the prefix sums, in O(1); differs from the direct sum by at most 1e-4.
  double sigma(const Vec3<double>& k) const noexcept;

  /// cos(theta_k) / sigma(k); 0 where that is 0 / 0. Above 1 only where the distribution is not
  /// centred, which no surface has.
  double g1(const Vec3<double>& k) const noexcept;

 private:
  struct Sums {
    double u = 0, z = 0;
  };

  double sigma_at(int azimuth, double sine, double cosine) const noexcept;

  std::vector<Vec3<double>> facets_;
  std::vector<Sums> sums_;  // [azimuth][line between bins]
};

/// G1 at the centres of all pixels, as an image of size x size pixels; 0 where a centre is not within
/// the disk.
DiskImage g1_image(const Shadowing& shadowing, int size);

}  // namespace gonio
