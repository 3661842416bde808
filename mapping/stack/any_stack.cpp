#include <gonio/mapping/stack/any_stack.h>

#include <string>

#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

std::variant<PackedStack, Stack<float>> make_stack(const StackGrid& diagrams, Interpolation interpolation, Storage storage) {
  if (storage == Storage::float32) return Stack<float>(diagrams, interpolation);
  if (interpolation != Interpolation::blend)
    throw Error(std::string("stack: interpolation: found ") + to_string(interpolation) +
                ", expected blend, the only one of packed16");
  return PackedStack(diagrams);
}

}  // namespace

const char* to_string(Storage storage) noexcept { return storage == Storage::packed16 ? "packed16" : "float32"; }

AnyStack::AnyStack(const StackGrid& diagrams, Interpolation interpolation, Storage storage)
    : stack_(make_stack(diagrams, interpolation, storage)) {}

DirectionSample<float> AnyStack::sample(float theta_i, float u, float v) const noexcept {
  return packed() ? packed()->sample(theta_i, u, v) : floats().sample(theta_i, u, v);
}

float AnyStack::pdf(float theta_i, const Vec3<float>& wo) const noexcept {
  return packed() ? packed()->pdf(theta_i, wo) : floats().pdf(theta_i, wo);
}

std::optional<SquareInverse<float>> AnyStack::invert(float theta_i, const Vec3<float>& wo) const noexcept {
  return packed() ? packed()->invert(theta_i, wo) : floats().invert(theta_i, wo);
}

std::size_t AnyStack::bytes() const noexcept {
  return sizeof(*this) + (packed() ? packed()->bytes() - sizeof(PackedStack) : floats().bytes() - sizeof(Stack<float>));
}

Stack<float> AnyStack::unpacked() const {
  return packed() ? Stack<float>(packed()->grid(), Interpolation::blend) : floats();
}

}  // namespace gonio
