#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

namespace gonio::proof {

/// A density per solid angle over the upper hemisphere or the sphere, [1/sr].
using Density = std::function<double(const glm::vec3&)>;

/// What directions fill: of BRDFs the upper hemisphere, of luminaires the sphere.
enum class Domain { hemisphere, sphere };

/// A partition of the domain into cells between meridians and parallels.
class Bins {
 public:
  /// @param phi edges over [-pi, pi], ascending; @param r edges over [0, 1] with r = sqrt(1 - cos
  ///   theta), ascending; of the sphere over [0, 2], where below the horizon r = 2 - sqrt(1 + cos
  ///   theta). @throws Error otherwise.
  Bins(std::vector<double> phi, std::vector<double> r, Domain domain = Domain::hemisphere);

  /// Cells adapted to a density: a third of the edges each is spread over its mass, its variation and
  /// the hemisphere, so that a narrow peak is cut into many cells and the rest is not forgotten. Odd
  /// numbers of cells keep the edges off the lines of the tables and diagrams under test.
  static Bins adapted(const Density& density, int n_phi = 61, int n_r = 41, Domain domain = Domain::hemisphere);

  std::size_t size() const noexcept { return (phi_.size() - 1) * (r_.size() - 1); }
  /// The cell of a unit vector; on a hemisphere vectors with z < 0 have none: size() is returned.
  std::size_t index(const glm::vec3& w) const noexcept;

  /// The integral of a density over every cell, by adaptive Gauss-Lobatto quadrature. The error of the
  /// sum is below 1e-3 for densities that integrate to about 1 and have no feature narrower than a
  /// hundredth of a cell.
  /// @param draws of a pdf, how many draws are compared with it: cells in which few of them are
  ///   expected are then integrated as finely as their scatter asks for.
  std::vector<double> integrate(const Density& density, std::uint64_t draws = 0) const;
  /// The same for an RGB function, summed over the domain.
  glm::dvec3 integrate_rgb(const std::function<glm::vec3(const glm::vec3&)>& function) const;

  const std::vector<double>& phi() const noexcept { return phi_; }
  const std::vector<double>& r() const noexcept { return r_; }

 private:
  std::vector<double> phi_, r_;
  Domain domain_;
};

}  // namespace gonio::proof
