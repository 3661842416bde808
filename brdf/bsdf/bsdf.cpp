#include <utility>
#include <variant>

#include <gonio/brdf/batch/batch_bsdf.h>
#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/bsdf/material_hints.h>
#include <gonio/brdf/table/table.h>

namespace gonio {

struct Bsdf::State {
  State(const BsdfData& data, std::shared_ptr<const BrdfTable> from)
      : layout(sampled_stack(data)), colour(sampled_colour(data, from != nullptr), layout), table(std::move(from)) {}

  const BatchColour* own_colour() const noexcept { return table ? nullptr : &colour; }
  glm::vec3 table_value(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
    return std::visit([&](const auto& of) { return eval_one(of, wi, wo); }, table->data());
  }
  bool draw(const glm::vec3& wi, const glm::vec2& u, BsdfSample& out) const noexcept {
    if (!draw_one(layout, own_colour(), wi, u, out)) return false;
    if (table) out.weight = table_value(wi, out.wo) * (out.wo.z / out.pdf);
    return true;
  }

  void draw_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
              Arrays3 weight) const noexcept {
    if (!table) {
      draw_many(layout, colour, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf, weight.x, weight.y, weight.z});
      return;
    }
    draw_many(layout, count, {wi.x, wi.y, wi.z, u, v}, {wo.x, wo.y, wo.z, pdf});
    table->eval_n(count, wi, wo, weight);
    for (std::size_t k = 0; k < count; ++k) {
      const float scale = pdf[k] > 0 ? wo.z[k] / pdf[k] : 0.0f;
      weight.x[k] *= scale, weight.y[k] *= scale, weight.z[k] *= scale;
    }
  }

  BatchLayout layout;
  BatchColour colour;                      // empty: f_r is the table's
  std::shared_ptr<const BrdfTable> table;  // null: f_r is the colour's
  MaterialHints hints{[this](std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                             Arrays3 weight) { draw_n(count, wi, u, v, wo, pdf, weight); }};
};

Bsdf::Bsdf(const BsdfData& data, std::shared_ptr<const BrdfTable> table)
    : state_(std::make_shared<const State>(data, std::move(table))) {}

std::optional<BsdfSample> Bsdf::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  BsdfSample s;
  if (!state_->draw(wi, u, s)) return std::nullopt;
  return s;
}

float Bsdf::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return pdf_one(state_->layout, wi, wo); }

glm::vec3 Bsdf::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return state_->table ? state_->table_value(wi, wo) : eval_one(state_->layout, state_->colour, wi, wo);
}

void Bsdf::sample_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                    Arrays3 weight) const noexcept {
  state_->draw_n(count, wi, u, v, wo, pdf, weight);
}

void Bsdf::pdf_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, float* pdf) const noexcept {
  pdf_many(state_->layout, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {pdf});
}

void Bsdf::eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept {
  if (!state_->table) {
    eval_many(state_->layout, state_->colour, count, {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}, {f_r.x, f_r.y, f_r.z});
    return;
  }
  state_->table->eval_n(count, wi, wo, f_r);
}

glm::vec3 Bsdf::albedo(float theta_i) const noexcept { return state_->hints.albedo(theta_i); }
float Bsdf::roughness() const noexcept { return state_->hints.roughness(); }
Chart Bsdf::chart() const noexcept { return state_->layout.half_chart ? Chart::half : Chart::outgoing; }
Interpolation Bsdf::interpolation() const noexcept { return state_->layout.interpolation; }
std::size_t Bsdf::incident_angles() const noexcept { return static_cast<std::size_t>(state_->layout.angles.count); }
bool Bsdf::self_contained() const noexcept { return !state_->table; }
std::size_t Bsdf::bytes() const noexcept {
  return sizeof(*this) + sizeof(State) + state_->layout.bytes() + state_->colour.bytes();
}

}  // namespace gonio
