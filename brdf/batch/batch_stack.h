#pragma once

#include <cstddef>
#include <memory>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// A Stack<float> laid out for many look-ups at once: the arithmetic of Stack on as many lanes as the
/// machine has (Google Highway picks SSE4, AVX2, AVX-512 or NEON at run time).
///
/// All arrays hold `count` floats, in any alignment; an output may be an input but must not overlap it otherwise.
/// Every element has its own incident angle. Directions are in the frame of Stack: x along the azimuth of wi.
///
/// Results are those of Stack but for rounding: directions of sample_n() within 2e-5 of Stack::sample() wherever
/// the map is no steeper than that lets the floats u and v; the pdf is that of the direction returned, as
/// exact as Stack's: pdf_n() gives it again within 2e-3, relative, besides 1e-4 of the largest density.
///
/// Memory: a copy of the stack with every diagram padded to the largest number of lines, a quarter to a half more than
/// Stack. Thread safety: immutable; concurrent use is safe. No member but the constructor allocates.
class BatchStack {
 public:
  /// The stack is copied. @throws Error for Interpolation::mixture, which has no batch form, and for stacks of
  ///   2^29 values or more.
  explicit BatchStack(const Stack<float>& stack);

  /// Stack::sample() of every (theta_i, u, v).
  void sample_n(std::size_t count, const float* theta_i, const float* u, const float* v, float* wo_x, float* wo_y,
                float* wo_z, float* pdf) const noexcept;

  /// Stack::pdf() of every (theta_i, wo).
  void pdf_n(std::size_t count, const float* theta_i, const float* wo_x, const float* wo_y, const float* wo_z,
             float* pdf) const noexcept;

  /// Stack::invert() of every (theta_i, wo). Where that is empty, pdf is 0 and u, v are 0.
  void invert_n(std::size_t count, const float* theta_i, const float* wo_x, const float* wo_y, const float* wo_z,
                float* u, float* v, float* pdf) const noexcept;

  std::size_t bytes() const noexcept { return sizeof(*this) + layout_.bytes(); }

 private:
  BatchLayout layout_;
};

/// The name of the instruction set that this machine's batches run with: "AVX3", "AVX2", "SSE4", "NEON", ...
const char* batch_target() noexcept;

}  // namespace gonio
