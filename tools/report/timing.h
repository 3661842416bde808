#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <gonio/tools/report/report_data.h>

#include <gonio/brdf/proof/random.h>

namespace gonio {

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

/// Times a sampler with incident angles spread over 0 to 85 degrees, any azimuth, and outgoing
/// directions drawn by the sampler itself, as a path tracer would meet them.
template <class S>
CallTimes time_sampler(const S& sampler) {
  constexpr std::size_t calls = 1 << 15;
  proof::Random random(7);
  std::vector<glm::vec3> wi, wo;
  std::vector<glm::vec2> u;
  for (std::size_t k = 0; k < calls; ++k) {
    const float theta = 85 * pi<float> / 180 * random(), phi = 2 * pi<float> * random();
    wi.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    u.push_back(random.pair());
    const auto s = sampler.sample(wi[k], u[k]);
    wo.push_back(s ? s->wo : glm::vec3(0, 0, 1));
  }
  return {time_calls(calls,
                     [&](std::size_t k) {
                       const auto s = sampler.sample(wi[k], u[k]);
                       return s ? s->wo.x + s->pdf + s->weight.y : 0.0f;
                     }),
          time_calls(calls, [&](std::size_t k) { return sampler.pdf(wi[k], wo[k]); }),
          time_calls(calls, [&](std::size_t k) { return sampler.eval(wi[k], wo[k]).y; })};
}

}  // namespace gonio
