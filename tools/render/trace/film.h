#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "tools/render/image/exr_image.h"
#include "tools/render/trace/path_tracer.h"

namespace gonio {

struct RenderOptions {
  Strategy strategy = Strategy::mis;
  int max_bounces = 12;
  std::uint32_t seed = 1;
  int threads = 0;  ///< at most one per core; 0: one per core
};

/// An image that gets better with every sample. The result depends on scene, options and number of
/// samples, to the bit; not on the number of threads or on how the samples were divided into calls.
class Film {
 public:
  /// Keeps a reference to the scene. @param world as for PathTracer @throws Error if Embree fails.
  Film(const Scene& scene, const RenderOptions& options, std::shared_ptr<const World> world = nullptr);

  /// That many more samples in every pixel, tile by tile on all threads.
  /// @param progress called with the share that is done, from one thread at a time
  void add_samples(int count, const Progress& progress = {});

  int samples() const noexcept { return samples_; }
  RgbImage radiance() const;
  RgbImage albedo() const;  ///< directional albedo of the first surface; 0 for the environment
  RgbImage normal() const;  ///< mean normal of the first surface, in the world
  /// Estimated variance of each pixel of radiance(), by channel, as if samples were independent: an
  /// upper bound for the stratified ones that are used. 0 for less than two samples.
  RgbImage variance() const;

 private:
  struct Pixel {
    glm::dvec3 sum{0}, sum_of_squares{0};
    glm::vec3 albedo{0}, normal{0};
  };
  template <class Value>
  RgbImage image(const Value& value) const;

  int width_, height_;
  PathTracer tracer_;
  RenderOptions options_;
  int samples_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace gonio
