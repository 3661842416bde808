#include <gonio/brdf/compact_bsdf.h>

#include <gonio/brdf/frame.h>
#include <gonio/mapping/error.h>

namespace gonio {
namespace {

std::variant<PackedStack, Stack<float>> make_stack(const StackGrid& diagrams, Interpolation interpolation, Storage storage) {
  if (storage == Storage::float32) return Stack<float>(diagrams, interpolation);
  if (interpolation != Interpolation::blend)
    throw Error(std::string("compact BSDF: interpolation: found ") + to_string(interpolation) +
                ", expected blend, the only one of packed16");
  return PackedStack(diagrams);
}

}  // namespace

const char* to_string(Storage storage) noexcept { return storage == Storage::packed16 ? "packed16" : "float32"; }

CompactBsdf::CompactBsdf(const StackGrid& diagrams, Interpolation interpolation, Storage storage, Colour colour)
    : stack_(make_stack(diagrams, interpolation, storage)), colour_(std::move(colour)) {
  if (colour_.empty()) throw Error("compact BSDF: colour: found none, expected one");
}

std::optional<BsdfSample> CompactBsdf::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(wi.z > 0)) return std::nullopt;
  const IncidentFrame frame(wi);
  const auto drawn = std::visit([&](const auto& stack) { return stack.sample(frame.theta_i, u.x, u.y); }, stack_);
  if (!(drawn.pdf > 0 && drawn.wo.z > 0)) return std::nullopt;
  return BsdfSample{frame.to_surface(drawn.wo), drawn.pdf, colour_.eval(frame.theta_i, {u.x, u.y})};
}

float CompactBsdf::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  const IncidentFrame frame(wi);
  return std::visit([&](const auto& stack) { return stack.pdf(frame.theta_i, frame.to_diagram(wo)); }, stack_);
}

glm::vec3 CompactBsdf::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return glm::vec3(0);
  const IncidentFrame frame(wi);
  const auto inverse = std::visit([&](const auto& stack) { return stack.invert(frame.theta_i, frame.to_diagram(wo)); }, stack_);
  if (!inverse) return glm::vec3(0);
  return colour_.eval(frame.theta_i, inverse->at) * (inverse->pdf / wo.z);
}

std::size_t CompactBsdf::bytes() const noexcept {
  return sizeof(*this) - sizeof(colour_) + colour_.bytes() +
         std::visit([](const auto& stack) { return stack.bytes() - sizeof(stack); }, stack_);
}

}  // namespace gonio
