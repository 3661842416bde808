#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace gonio {

/// Values from 0 to a peak in 16 bits: IEEE half floats, the peak being 2^15. Processors, GPUs and OpenEXR read them.
///
/// Codes are in the order of their values, and code 0 is exactly 0. Rounding errs by at most 2^-11 of the value,
/// relative, in the upper 29 powers of two, and below by 2^-40 of the peak (2^-39 next to 0).

/// The code of the peak: decode16(peak_code16) is exactly 1.
inline constexpr std::uint16_t peak_code16 = 30 << 10;
/// What a half float is multiplied by to give the value in units of the peak.
inline constexpr float half_unit = 0x1p-15f;

/// The value of a code, in units of the peak. @pre the code is not above `peak_code16`.
inline float decode16(std::uint16_t code) noexcept {
  const std::uint32_t bits = (std::uint32_t{code} << 13) + (std::uint32_t{127 - 15} << 23);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  const float below_normal = static_cast<float>(code) * 0x1p-24f;
  return (code < 1024 ? below_normal : value) * half_unit;
}

/// The code whose value is nearest; a positive value never becomes 0, so that nothing vanishes altogether.
/// decode16() then encode16() gives any code again. @pre `value_over_peak` is in [0, 1].
inline std::uint16_t encode16(double value_over_peak) noexcept {
  const double value = value_over_peak * 0x1p15;
  if (value < 0x1p-14) {
    const auto code = static_cast<std::uint16_t>(std::lround(value * 0x1p24));
    return code == 0 && value_over_peak > 0 ? std::uint16_t{1} : code;
  }
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  constexpr std::uint64_t half = std::uint64_t{1} << 41, first = std::uint64_t{1023 - 15} << 10;
  return static_cast<std::uint16_t>(((bits + half) >> 42) - first);
}

}  // namespace gonio
