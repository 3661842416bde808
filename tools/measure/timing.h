#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio {

/// Nanoseconds a call, one thread: medians over repeats with mixed directions.
struct CallTimes {
  double sample, pdf, eval;
};

/// The median over repeats of the nanoseconds that call(k) takes, k = 0 ... calls - 1.
template <class Call>
double time_calls(std::size_t calls, const Call& call) {
  constexpr int repeats = 5;
  std::vector<double> ns;
  volatile float sink = 0;  // keeps the results alive
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    float sum = 0;
    for (std::size_t k = 0; k < calls; ++k) sum += call(k);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    sink = sum;
    ns.push_back(taken.count() / static_cast<double>(calls));
  }
  static_cast<void>(sink);
  std::nth_element(ns.begin(), ns.begin() + repeats / 2, ns.end());
  return ns[repeats / 2];
}

/// Of the directions that are timed.
inline constexpr std::uint32_t timing_seed = 7;

/// The queries that samplers are timed with: incident angles spread over 0 to 85 degrees, any azimuth, and outgoing
/// directions drawn by the sampler itself, as a path tracer would meet them.
struct TimedQueries {
  static constexpr std::size_t count = 1 << 15;
  std::vector<glm::vec3> wi, wo;
  std::vector<glm::vec2> u;

  template <class S>
  explicit TimedQueries(const S& sampler) {
    proof::Random random(timing_seed);
    for (std::size_t k = 0; k < count; ++k) {
      const float theta = 85 * pi<float> / 180 * random(), phi = 2 * pi<float> * random();
      wi.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      u.push_back(random.pair());
      const auto s = sampler.sample(wi[k], u[k]);
      wo.push_back(s ? s->wo : glm::vec3(0, 0, 1));
    }
  }
};

/// Times a sampler's calls one at a time.
template <class S>
CallTimes time_sampler(const S& sampler, const TimedQueries& q) {
  return {time_calls(q.count,
                     [&](std::size_t k) {
                       const auto s = sampler.sample(q.wi[k], q.u[k]);
                       return s ? s->wo.x + s->pdf + s->weight.y : 0.0f;
                     }),
          time_calls(q.count, [&](std::size_t k) { return sampler.pdf(q.wi[k], q.wo[k]); }),
          time_calls(q.count, [&](std::size_t k) { return sampler.eval(q.wi[k], q.wo[k]).y; })};
}

/// Times the same calls in batches of 4096: nanoseconds per element.
inline CallTimes time_batch(const Bsdf& bsdf, const TimedQueries& q) {
  constexpr std::size_t size = 4096;
  std::vector<float> arrays[12];
  for (auto& a : arrays) a.resize(q.count);
  for (std::size_t k = 0; k < q.count; ++k) {
    for (int c = 0; c < 3; ++c) arrays[c][k] = q.wi[k][c], arrays[3 + c][k] = q.wo[k][c];
    arrays[6][k] = q.u[k].x, arrays[7][k] = q.u[k].y;
  }
  const auto at = [&](int first, std::size_t k) {
    return Arrays3{arrays[first].data() + k, arrays[first + 1].data() + k, arrays[first + 2].data() + k};
  };
  std::vector<float> x(size), y(size), z(size);
  const Arrays3 colour{x.data(), y.data(), z.data()};
  const auto timed = [&](const auto& call) {
    const double ns = time_calls(q.count / size, [&](std::size_t part) {
      call(part * size);
      return x[0] + arrays[11][part * size];
    });
    return ns / size;
  };
  CallTimes ns{};
  ns.sample = timed([&](std::size_t k) {
    bsdf.sample_n(size, at(0, k), arrays[6].data() + k, arrays[7].data() + k, at(8, k), arrays[11].data() + k, colour);
  });
  ns.pdf = timed([&](std::size_t k) { bsdf.pdf_n(size, at(0, k), at(3, k), arrays[11].data() + k); });
  ns.eval = timed([&](std::size_t k) { bsdf.eval_n(size, at(0, k), at(3, k), colour); });
  return ns;
}

}  // namespace gonio
