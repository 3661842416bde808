#include "tools/render/trace/film.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include <glm/common.hpp>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace gonio {
namespace {

constexpr int tile = 16;

/// Maps a uniform number to a tent of width 2 about 0: neighbouring pixels share samples' weight.
float tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

}  // namespace

Film::Film(const Scene& scene, const RenderOptions& options, std::shared_ptr<const World> world)
    : width_(scene.camera.width),
      height_(scene.camera.height),
      tracer_(scene, options.strategy, options.max_bounces, std::move(world)),
      options_(options),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void Film::add_samples(int count, const Progress& progress) {
  const int columns = (width_ + tile - 1) / tile, rows = (height_ + tile - 1) / tile;
  std::mutex mutex;
  int done = 0;
  const auto render_tile = [&](int k) {
    const int x0 = k % columns * tile, y0 = k / columns * tile;
    for (int y = y0; y < std::min(y0 + tile, height_); ++y)
      for (int x = x0; x < std::min(x0 + tile, width_); ++x) {
        const std::size_t index =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        Pixel& pixel = pixels_[index];
        for (int s = samples_; s < samples_ + count; ++s) {
          PathSequence random(options_.seed, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(s));
          const glm::vec2 u = random.next();
          const PathResult path =
              tracer_.trace(static_cast<float>(x) + 0.5f + tent(u.x), static_cast<float>(y) + 0.5f + tent(u.y), random);
          const glm::dvec3 radiance(path.radiance);
          pixel.sum += radiance;
          pixel.sum_of_squares += radiance * radiance;
          pixel.albedo += path.albedo;
          pixel.normal += path.normal;
        }
      }
    if (progress) {
      const std::lock_guard<std::mutex> lock(mutex);
      progress(static_cast<double>(++done) / (columns * rows));
    }
  };
  // TBB, which Embree limits to one thread a core, complains on stderr when it is asked for more.
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(options_.threads > 0 ? std::min(options_.threads, cores) : cores);
  arena.execute([&] { tbb::parallel_for(0, columns * rows, render_tile, tbb::simple_partitioner()); });
  samples_ += count;
}

template <class Value>
RgbImage Film::image(const Value& value) const {
  RgbImage result{width_, height_, {}};
  result.pixels.reserve(pixels_.size());
  for (const Pixel& p : pixels_) result.pixels.push_back(value(p));
  return result;
}

RgbImage Film::radiance() const {
  return image([n = std::max(samples_, 1)](const Pixel& p) { return glm::vec3(p.sum / static_cast<double>(n)); });
}

RgbImage Film::albedo() const {
  return image([n = std::max(samples_, 1)](const Pixel& p) { return p.albedo / static_cast<float>(n); });
}

RgbImage Film::normal() const {
  return image([n = std::max(samples_, 1)](const Pixel& p) { return p.normal / static_cast<float>(n); });
}

RgbImage Film::variance() const {
  return image([n = static_cast<double>(samples_)](const Pixel& p) {
    if (n < 2) return glm::vec3(0);
    const glm::dvec3 mean = p.sum / n;
    return glm::vec3(glm::max(p.sum_of_squares / n - mean * mean, 0.0) / (n - 1));
  });
}

}  // namespace gonio
