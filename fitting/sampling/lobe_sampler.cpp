#include <algorithm>
#include <cmath>

#include <gonio/brdf/value/frame.h>
#include <gonio/fitting/lobes/diffuse.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/fitting/sampling/proposal.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {
constexpr double last_angle = 89 * pi<double> / 180;
}

LobeSampler::LobeSampler(std::shared_ptr<const BrdfTable> table, const LobeModel& model,
                         const LobeSamplerOptions& options)
    : table_(required_table(std::move(table), "lobe sampler")) {
  if (model.specular_count() > max_lobes) {
    throw Error("lobe sampler: the model has " + std::to_string(model.specular_count()) +
                " specular lobes; expected at most " + std::to_string(max_lobes));
  }
  if (options.angles < 2) {
    throw Error("lobe sampler: angles is " + std::to_string(options.angles) + "; expected 2 or more");
  }
  if (!(options.cosine_share > 0 && options.cosine_share <= 1)) {
    throw Error("lobe sampler: cosine_share is " + std::to_string(options.cosine_share) +
                "; expected a value in (0, 1]");
  }
  lobes_ = model.specular_count();
  nodes_per_radian_ = static_cast<float>((options.angles - 1) / last_angle);
  nodes_.resize(options.angles);

  const BrdfFunction f = [this](const glm::vec3& wi, const glm::vec3& wo) { return table_->eval(wi, wo); };
  const bool adapt = options.adaption != Adaption::albedo;
  std::vector<detail::Proposal> proposals(nodes_.size());
  std::vector<detail::Quadrature> quadratures(nodes_.size());
  parallel_for(nodes_.size(), [&](size_t i) {
    const double theta_i = last_angle * static_cast<double>(i) / (options.angles - 1);
    proposals[i] = detail::albedo_proposal(model, theta_i, options.cosine_share);
    if (adapt) quadratures[i] = detail::quadrature(f, theta_i);
  });
  if (adapt) {
    proposals = detail::refine_all(quadratures, std::move(proposals), options.adaption == Adaption::shapes,
                                   options.cosine_share);
  }
  for (size_t i = 0; i < nodes_.size(); ++i) {
    for (int k = 0; k <= lobes_; ++k) nodes_[i].weight[k] = static_cast<float>(proposals[i].weight[k]);
    for (int k = 0; k < lobes_; ++k) {
      const ShearedGgx<double>& s = proposals[i].shape[k];
      nodes_[i].shape[k] = {static_cast<float>(s.alpha_x), static_cast<float>(s.alpha_y), static_cast<float>(s.shear)};
    }
  }
}

LobeSampler::Node LobeSampler::at(float theta_i) const noexcept {
  const float position = std::min(theta_i * nodes_per_radian_, static_cast<float>(nodes_.size() - 1));
  const size_t low = std::min(static_cast<size_t>(position), nodes_.size() - 2);
  const float t = position - static_cast<float>(low);
  Node node = nodes_[low];
  const Node& high = nodes_[low + 1];
  for (int k = 0; k <= lobes_; ++k) node.weight[k] += t * (high.weight[k] - node.weight[k]);
  for (int k = 0; k < lobes_; ++k) {
    ShearedGgx<float>& shape = node.shape[k];
    shape.alpha_x += t * (high.shape[k].alpha_x - shape.alpha_x);
    shape.alpha_y += t * (high.shape[k].alpha_y - shape.alpha_y);
    shape.shear += t * (high.shape[k].shear - shape.shear);
  }
  return node;
}

float LobeSampler::density(const Node& node, const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  float sum = node.weight[0] * cosine_pdf(wo.z);
  for (int k = 0; k < lobes_; ++k) sum += node.weight[k + 1] * node.shape[k].pdf(wi, wo);
  return sum;
}

std::optional<BsdfSample> LobeSampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const IncidentFrame frame(wi);
  const glm::vec3 wi_diagram = frame.to_diagram(wi);
  const Node node = at(frame.theta_i);
  int part = 0;
  float below = 0;
  while (part < lobes_ && u.x >= below + node.weight[part]) below += node.weight[part++];
  constexpr float below_one = 1 - 0x1p-24f;
  const float rest = std::min(std::max((u.x - below) / node.weight[part], 0.0f), below_one);
  const glm::vec3 wo = part == 0 ? cosine_sample(rest, u.y) : node.shape[part - 1].sample(wi_diagram, rest, u.y);
  if (!(wo.z > 0)) return std::nullopt;
  const glm::vec3 wo_surface = frame.to_surface(wo);
  const float density_here = density(node, wi_diagram, wo);
  if (!(density_here > 0)) return std::nullopt;
  return BsdfSample{wo_surface, density_here, table_->eval(wi, wo_surface) * (wo_surface.z / density_here)};
}

float LobeSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return 0;
  const IncidentFrame frame(wi);
  return density(at(frame.theta_i), frame.to_diagram(wi), frame.to_diagram(wo));
}

glm::vec3 LobeSampler::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return table_->eval(wi, wo); }

}  // namespace gonio
