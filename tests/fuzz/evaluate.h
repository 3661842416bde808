#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/mapping/base/problem.h>

namespace gonio::fuzz {

inline bool usable(const Problems& problems) {
  return std::none_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; });
}

inline glm::vec3 direction(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// What a table promises whatever it was made of, in plain code and on vectors: never negative, never NaN.
template <class Table>
void evaluate(const Table& table) {
  for (const float theta_i : {0.0f, 0.7f, 1.57f})
    for (const float theta_o : {0.0f, 0.3f, 1.57f})
      for (const float phi : {0.0f, 1.0f, 3.14159f, -2.0f}) {
        const glm::vec3 wi = direction(theta_i, 0.4f), wo = direction(theta_o, phi);
        for (const glm::vec3& f : {table.eval(wi, wo), eval_one(table, wi, wo)})
          for (int c = 0; c < 3; ++c)
            if (!(f[c] >= 0)) std::abort();
      }
}

}  // namespace gonio::fuzz
