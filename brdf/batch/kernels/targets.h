#pragma once

// Before Highway's headers: instruction sets that bring the kernels nothing over the next lower one.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
