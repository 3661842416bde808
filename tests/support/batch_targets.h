#pragma once

#include <cstdint>
#include <string>

// clang-format off
#include <gonio/brdf/batch/kernels/targets.h>  // before Highway
// clang-format on

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <gonio/brdf/batch/batch_stack.h>

namespace gonio {

/// Tests of batches that run once for every instruction set that this machine has.
class OnTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    hwy::SetSupportedTargetsForTest(GetParam());
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ASSERT_STREQ(batch_target(), hwy::TargetName(GetParam()));
  }
  void TearDown() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

inline std::string target_name(const testing::TestParamInfo<std::int64_t>& info) { return hwy::TargetName(info.param); }

}  // namespace gonio

/// Instantiates the tests of a class derived from OnTarget.
#define GONIO_ON_ALL_TARGETS(name) \
  INSTANTIATE_TEST_SUITE_P(Target, name, testing::ValuesIn(hwy::SupportedAndGeneratedTargets()), target_name)
