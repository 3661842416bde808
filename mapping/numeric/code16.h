#pragma once

#include <cstdint>
#include <cstring>

namespace gonio {

/// Values from 0 to a peak in 16 bits: a floating-point number without sign, of 5 exponent bits and 11 mantissa
/// bits, in units of the peak. Read by a shift, an addition and a subtraction, without a branch or a table.
///
/// A code is bits of the float of value + 2^-31, so that code 0 is exactly 0 and codes are in the order of their
/// values. Rounding errs by at most 2^-12 (value + 2^-31): by 2^-12 of the value, relative, in the upper 20 powers
/// of two, by 2^-11 of it at 2^-31 of the peak, and below by 2^-43 of the peak (2^-42 next to 0).

/// The code of the peak: decode16(peak_code16) is exactly 1.
inline constexpr std::uint16_t peak_code16 = 31 << 11;

/// The value of a code, in units of the peak. Every code is valid; those above `peak_code16` are values up to 2.
inline float decode16(std::uint16_t code) noexcept {
  const std::uint32_t bits = (std::uint32_t{code} << 12) + (std::uint32_t{127 - 31} << 23);
  float shifted;
  std::memcpy(&shifted, &bits, sizeof shifted);
  return shifted - 0x1p-31f;
}

/// The code whose value is nearest; a positive value never becomes 0, so that nothing vanishes altogether.
/// decode16() then encode16() gives any code again. @pre `value_over_peak` is in [0, 1].
inline std::uint16_t encode16(double value_over_peak) noexcept {
  const double shifted = value_over_peak + 0x1p-31;
  std::uint64_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  constexpr std::uint64_t half = std::uint64_t{1} << 40, first = std::uint64_t{1023 - 31} << 11;
  const std::uint64_t code = ((bits + half) >> 41) - first;
  return static_cast<std::uint16_t>(code == 0 && value_over_peak > 0 ? 1 : code);
}

}  // namespace gonio
