// The harness of gonio::proof on every lobe's own sample and pdf, and on LobeSampler.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gonio/brdf/proof/gtest.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/fitting/sampling/lobe_sampler.h>

namespace gonio::proof {
namespace {

struct LobeCase {
  LobeKind kind;
  double shape[max_shape];
};

const std::vector<LobeCase>& cases() {
  static const std::vector<LobeCase> all = {
      {LobeKind::lambert, {0, 0}},
      {LobeKind::oren_nayar, {0.6, 0}},
      {LobeKind::burley, {0.8, 0}},
      {LobeKind::ggx, {0.05, 0}},
      {LobeKind::ggx, {0.4, 0}},
      {LobeKind::beckmann, {0.05, 0}},
      {LobeKind::beckmann, {0.4, 0}},
      {LobeKind::student_t, {0.3, 1.7}},
      {LobeKind::blinn_phong, {30, 0}},
      {LobeKind::ward, {0.2, 0}},
      {LobeKind::ashikhmin_shirley, {80, 0}},
      {LobeKind::lafortune, {40, 0.9}},
  };
  return all;
}

const double angles[] = {0, 0.5, 1.2};
constexpr int runs = 48;

// In double, as the lobes are meant for: the harness gives and takes floats.
Subject subject_of(const LobeCase& c, double pdf_scale = 1) {
  const auto pdf = [c, pdf_scale](const glm::vec3& wi, const glm::vec3& wo) {
    if (!(wi.z > 0 && wo.z > 0)) return 0.0;
    const Angles<double> a{glm::dvec3(wi), glm::dvec3(wo)};
    return pdf_scale * visit_lobe(c.kind, c.shape, [&](const auto& lobe) { return lobe.pdf(a); });
  };
  const auto f_r = [c](const glm::vec3& wi, const glm::vec3& wo) {
    if (!(wi.z > 0 && wo.z > 0)) return glm::vec3(0);
    const Angles<double> a{glm::dvec3(wi), glm::dvec3(wo)};
    return glm::vec3(static_cast<float>(visit_lobe(c.kind, c.shape, [&](const auto& lobe) { return lobe.eval(a); })));
  };
  const auto sample = [=](const glm::vec3& wi, const glm::vec2& u) -> std::optional<BsdfSample> {
    const auto drawn = visit_lobe(c.kind, c.shape, [&](const auto& lobe) {
      return lobe.sample(glm::dvec3(wi), static_cast<double>(u.x), static_cast<double>(u.y));
    });
    if (!drawn) return std::nullopt;
    const glm::vec3 wo(*drawn);
    if (!(wo.z > 0)) return std::nullopt;
    const double p = pdf(wi, wo) / pdf_scale;
    return BsdfSample{wo, static_cast<float>(p), f_r(wi, wo) * static_cast<float>(wo.z / p)};
  };
  return {sample, pdf, f_r};
}

InvariantOptions lobe_options() {
  InvariantOptions options;
  options.runs = runs;
  options.draws = 200000;
  options.points = 1000;
  options.turns = false;       // half vectors are drawn about the normal, wherever wi is
  options.continuous = false;  // draws below the horizon are cut out of the square
  return options;
}

TEST(LobeInvariants, HoldForEveryLobe) {
  for (const LobeKind kind : lobe_kinds()) {
    EXPECT_TRUE(std::any_of(cases().begin(), cases().end(), [&](const LobeCase& c) { return c.kind == kind; }))
        << lobe_info(kind).id << " is not among the cases";
  }
  for (const LobeCase& c : cases()) {
    for (const double theta_i : angles) {
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(subject_of(c), theta_i, lobe_options())
          << lobe_info(c.kind).id << " " << c.shape[0];
    }
  }
}

TEST(LobeInvariants, HoldForLobeSampler) {
  const LobeModel model = parse_model("lambert:albedo=0.3/0.2/0.1+ggx:alpha=0.4,F0=0.05+ggx:alpha=0.12,F0=0.1");
  const auto table = std::make_shared<const BrdfTable>(MbsdfTable(synthesize_mbsdf(model)), BrdfTable::Info{});
  for (const Adaption adaption : {Adaption::albedo, Adaption::weights, Adaption::shapes}) {
    LobeSamplerOptions with;
    with.adaption = adaption;
    const LobeSampler sampler(table, model, with);
    InvariantOptions options = lobe_options();
    options.turns = true;
    for (const double theta_i : angles) {
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(sampler), theta_i, options)
          << "adaption " << static_cast<int>(adaption);
    }
  }
}

// A density one per cent too large, and draws of another width.
TEST(LobeInvariants, NegativeControls) {
  const auto fails = [](const Subject& subject, const std::string& name) {
    for (const Check& check : check_invariants(subject, 0.5, lobe_options()))
      if (check.name == name) return !check.passed;
    return false;
  };
  for (const LobeCase& c : cases()) EXPECT_TRUE(fails(subject_of(c, 1.01), "mass")) << lobe_info(c.kind).id;
  Subject other = subject_of(LobeCase{LobeKind::ggx, {0.4, 0}});
  other.sample = subject_of(LobeCase{LobeKind::ggx, {0.42, 0}}).sample;
  EXPECT_TRUE(fails(other, "chi_square"));
  EXPECT_TRUE(fails(other, "pdf"));
}

}  // namespace
}  // namespace gonio::proof
