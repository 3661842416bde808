#include "tools/render/material/sampling_methods.h"

#include <algorithm>
#include <utility>

#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/measure/table_fits.h"

namespace gonio {

const char* to_string(SamplingMethod method) noexcept {
  static constexpr const char* names[] = {"default", "cosine",  "lobes1",       "lobes2", "lobes3",
                                          "nearest", "mixture", "displacement", "half",   "rgl"};
  return names[static_cast<std::size_t>(method)];
}

std::optional<SamplingMethod> parse_sampling_method(const std::string& name) noexcept {
  for (const SamplingMethod method : sampling_methods)
    if (name == to_string(method)) return method;
  return std::nullopt;
}

std::vector<std::string> sampling_method_names() {
  std::vector<std::string> names;
  for (const SamplingMethod method : sampling_methods) names.push_back(to_string(method));
  return names;
}

MethodBuilder::MethodBuilder(std::shared_ptr<const BrdfTable> table, std::optional<LobeModel> model,
                             const BsdfOptions& options)
    : table_(std::move(table)), options_(options), given_(model.has_value()) {
  if (model) fits_.push_back(std::move(*model));
}

bool MethodBuilder::available(SamplingMethod method) const noexcept {
  if (method == SamplingMethod::rgl) return std::holds_alternative<RglTable>(table_->data());
  return !given_ || (method != SamplingMethod::lobes2 && method != SamplingMethod::lobes3);
}

const LobeModel& MethodBuilder::lobes(std::size_t count) {
  if (fits_.empty())
    for (StageFit& stage : fit_table(*table_, parse_model(default_fit_form)).stages)
      fits_.push_back(std::move(stage.fit.model));
  return fits_.at(count - 1);
}

const StackGrid& MethodBuilder::outgoing(const Progress& progress) {
  if (!outgoing_) {
    BsdfOptions options = options_;
    options.interpolation = Interpolation::displacement;
    outgoing_ = build_stack(*table_, options, progress);
  }
  return *outgoing_;
}

std::shared_ptr<const Scatter> MethodBuilder::build(SamplingMethod method, const Progress& progress) {
  if (!available(method))
    throw Error(table_->info().source + ": sampling: found " + to_string(method) + ", expected a method for a " +
                table_->info().format + " file");
  switch (method) {
    case SamplingMethod::automatic:
      return make_scatter(make_bsdf(table_, {}, progress));
    case SamplingMethod::cosine:
      return make_scatter(CosineSampler(table_));
    case SamplingMethod::lobes1:
      return make_scatter(LobeSampler(table_, lobes(1)));
    case SamplingMethod::lobes2:
      return make_scatter(LobeSampler(table_, lobes(2)));
    case SamplingMethod::lobes3:
      return make_scatter(LobeSampler(table_, lobes(3)));
    case SamplingMethod::nearest:
      return make_scatter(Bsdf({outgoing(progress), Interpolation::nearest, {}}, table_));
    case SamplingMethod::mixture:
      return make_scatter(StackBsdf({outgoing(progress), Interpolation::mixture, {}}, table_));
    case SamplingMethod::displacement:
      return make_scatter(Bsdf({outgoing(progress), Interpolation::displacement, {}}, table_));
    case SamplingMethod::half: {
      BsdfOptions options = options_;
      options.chart = Chart::half;
      options.interpolation = Interpolation::blend;
      return make_scatter(Bsdf({build_stack(*table_, options, progress), Interpolation::blend, {}}, table_));
    }
    case SamplingMethod::rgl:
      return make_scatter(RglSampler(table_));
  }
  throw Error("sampling: found none, expected " + one_of(sampling_method_names(), ""));
}

}  // namespace gonio
