#pragma once

#include <gtest/gtest.h>

#include <gonio/brdf/proof/invariants.h>

namespace gonio::proof {

/// The result of check_invariants() as GoogleTest wants it: a line for every check that failed.
inline testing::AssertionResult sampler_invariants_hold(const Subject& subject, double theta_i,
                                                        const InvariantOptions& options = {}) {
  const Checks checks = check_invariants(subject, theta_i, options);
  if (all_passed(checks)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "at theta_i = " << theta_i << " rad:\n" << failures(checks);
}

}  // namespace gonio::proof

/// Expects every invariant of gonio::proof::check_invariants(): a Subject, the incident angle [rad] and,
/// optionally, InvariantOptions.
#define EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(...) EXPECT_TRUE(::gonio::proof::sampler_invariants_hold(__VA_ARGS__))
