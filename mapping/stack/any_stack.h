#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include <gonio/mapping/stack/packed_stack.h>

namespace gonio {

/// How the densities of a stack are held.
enum class Storage {
  packed16,  ///< PackedStack: 16 bits a crossing; `blend` alone
  float32    ///< Stack<float>
};

inline constexpr Storage storages[] = {Storage::packed16, Storage::float32};
const char* to_string(Storage storage) noexcept;

/// A stack in either storage: what samplers hold.
///
/// Thread safety: immutable; concurrent use is safe. No member but the constructor and unpacked() allocates.
class AnyStack {
 public:
  /// @throws Error as Stack and PackedStack do, and for packed16 with another interpolation than blend.
  AnyStack(const StackGrid& diagrams, Interpolation interpolation, Storage storage);

  /// These three are those of the stack held.
  DirectionSample<float> sample(float theta_i, float u, float v) const noexcept;
  float pdf(float theta_i, const Vec3<float>& wo) const noexcept;
  std::optional<SquareInverse<float>> invert(float theta_i, const Vec3<float>& wo) const noexcept;

  Storage storage() const noexcept { return packed() ? Storage::packed16 : Storage::float32; }
  Interpolation interpolation() const noexcept { return packed() ? Interpolation::blend : floats().interpolation(); }
  Chart chart() const noexcept { return packed() ? packed()->chart() : floats().chart(); }
  const std::vector<float>& theta_i() const noexcept { return packed() ? packed()->theta_i() : floats().theta_i(); }
  std::size_t bytes() const noexcept;  ///< all memory held, this object included

  /// The same diagrams in floats.
  Stack<float> unpacked() const;

 private:
  const PackedStack* packed() const noexcept { return std::get_if<PackedStack>(&stack_); }
  const Stack<float>& floats() const noexcept { return *std::get_if<Stack<float>>(&stack_); }

  std::variant<PackedStack, Stack<float>> stack_;
};

}  // namespace gonio
