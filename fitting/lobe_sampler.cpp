#include <gonio/brdf/parallel.h>
#include <gonio/fitting/lobe_sampler.h>
#include <gonio/fitting/proposal.h>
#include <gonio/mapping/error.h>

#include <algorithm>
#include <cmath>

namespace gonio {
namespace {
constexpr double last_angle = 89 * pi<double> / 180;
}

LobeSampler::LobeSampler(std::shared_ptr<const BrdfTable> table, const LobeModel& model,
                         const LobeSamplerOptions& options)
    : table_(std::move(table)) {
  if (model.specular_count() > max_lobes) {
    throw Error("lobe sampler: the model has " + std::to_string(model.specular_count()) +
                " specular lobes; expected at most " + std::to_string(max_lobes));
  }
  if (options.angles < 2) {
    throw Error("lobe sampler: angles is " + std::to_string(options.angles) +
                "; expected 2 or more");
  }
  if (!(options.cosine_share > 0 && options.cosine_share <= 1)) {
    throw Error("lobe sampler: cosine_share is " + std::to_string(options.cosine_share) +
                "; expected a value in (0, 1]");
  }
  std::vector<LobeKind> kinds;
  for (const Lobe& lobe : model.lobes) {
    if (lobe.specular()) kinds.push_back(lobe.kind);
  }
  lobes_ = static_cast<int>(kinds.size());
  std::copy(kinds.begin(), kinds.end(), kinds_.begin());
  nodes_per_radian_ = static_cast<float>((options.angles - 1) / last_angle);
  nodes_.resize(options.angles);

  const BrdfFunction f = [this](const glm::vec3& wi, const glm::vec3& wo) {
    return table_->eval(wi, wo);
  };
  parallel_for(nodes_.size(), [&](size_t i) {
    const double theta_i = last_angle * static_cast<double>(i) / (options.angles - 1);
    detail::Proposal proposal = detail::albedo_proposal(model, theta_i, options.cosine_share);
    if (options.adaption != Adaption::albedo) {
      const std::vector<detail::QuadraturePoint> points = detail::quadrature(f, theta_i);
      if (!points.empty()) {
        proposal = detail::refine_proposal(
            points, kinds, proposal, options.adaption == Adaption::shapes, options.cosine_share);
      }
    }
    Node& node = nodes_[i];
    for (int k = 0; k <= lobes_; ++k) node.weight[k] = static_cast<float>(proposal.weight[k]);
    for (int k = 0; k < lobes_; ++k) {
      for (int s = 0; s < max_shape; ++s)
        node.shape[k][s] = static_cast<float>(proposal.shape[k][s]);
    }
  });
}

LobeSampler::Node LobeSampler::at(const glm::vec3& wi) const noexcept {
  const float theta = std::atan2(std::sqrt(wi.x * wi.x + wi.y * wi.y), wi.z);
  const float position = std::min(theta * nodes_per_radian_, static_cast<float>(nodes_.size() - 1));
  const size_t low = std::min(static_cast<size_t>(position), nodes_.size() - 2);
  const float t = position - static_cast<float>(low);
  Node node = nodes_[low];
  const Node& high = nodes_[low + 1];
  for (int k = 0; k <= lobes_; ++k) node.weight[k] += t * (high.weight[k] - node.weight[k]);
  for (int k = 0; k < lobes_; ++k) {
    for (int s = 0; s < max_shape; ++s)
      node.shape[k][s] += t * (high.shape[k][s] - node.shape[k][s]);
  }
  return node;
}

float LobeSampler::density(const Node& node, const Angles<float>& angles) const noexcept {
  float sum = node.weight[0] * cosine_pdf(angles.cos_o);
  for (int k = 0; k < lobes_; ++k) {
    sum += node.weight[k + 1] * visit_lobe(kinds_[k], node.shape[k].data(),
                                           [&](const auto& lobe) { return lobe.pdf(angles); });
  }
  return sum;
}

std::optional<BsdfSample> LobeSampler::sample(const glm::vec3& wi,
                                              const glm::vec2& u) const noexcept {
  if (!(wi.z > 0)) return std::nullopt;
  const Node node = at(wi);
  int part = 0;
  float below = 0;
  while (part < lobes_ && u.x >= below + node.weight[part]) below += node.weight[part++];
  constexpr float below_one = 1 - 0x1p-24f;
  const float rest = std::min(std::max((u.x - below) / node.weight[part], 0.0f), below_one);
  std::optional<glm::vec3> wo;
  if (part == 0) {
    wo = cosine_sample(rest, u.y);
  } else {
    wo = visit_lobe(kinds_[part - 1], node.shape[part - 1].data(),
                    [&](const auto& lobe) { return lobe.sample(wi, rest, u.y); });
  }
  if (!wo || !(wo->z > 0)) return std::nullopt;
  *wo = glm::normalize(*wo);
  const float density_here = density(node, Angles<float>(wi, *wo));
  if (!(density_here > 0)) return std::nullopt;
  return BsdfSample{*wo, density_here, table_->eval(wi, *wo) * (wo->z / density_here)};
}

float LobeSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  return density(at(wi), Angles<float>(wi, wo));
}

glm::vec3 LobeSampler::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return table_->eval(wi, wo);
}

}  // namespace gonio
