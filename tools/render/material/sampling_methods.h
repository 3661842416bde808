#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/fitting/model/model.h>

#include "tools/render/material/scatter.h"

namespace gonio {

/// How a measured table is importance-sampled. The value is the table's in all of them.
enum class SamplingMethod {
  automatic,  ///< "default": what make_bsdf() makes of the table alone
  cosine,
  lobes1,
  lobes2,
  lobes3,  ///< LobeSampler with one to three fitted GGX lobes
  nearest,
  mixture,
  displacement,  ///< one stack in the outgoing chart, its three interpolations
  half,          ///< blend in the half-vector chart
  rgl            ///< the warps of an RGL file
};

inline constexpr SamplingMethod sampling_methods[] = {
    SamplingMethod::automatic, SamplingMethod::cosine,  SamplingMethod::lobes1,  SamplingMethod::lobes2,
    SamplingMethod::lobes3,    SamplingMethod::nearest, SamplingMethod::mixture, SamplingMethod::displacement,
    SamplingMethod::half,      SamplingMethod::rgl};

/// The name in scenes and on the command line.
const char* to_string(SamplingMethod method) noexcept;
std::optional<SamplingMethod> parse_sampling_method(const std::string& name) noexcept;
/// All names.
std::vector<std::string> sampling_method_names();

/// Makes the samplers of one table; stacks and fits that several of them need are made once.
class MethodBuilder {
 public:
  /// @param model the lobes if they are known already, as for a fit.json; else they are fitted
  /// @param options of the stacks, but for the default's, which are the library's own
  explicit MethodBuilder(std::shared_ptr<const BrdfTable> table, std::optional<LobeModel> model = {},
                         const BsdfOptions& options = {});

  /// False for `rgl` and a table that is not RGL, and for numbers of lobes other than the first where the
  /// lobes are known already.
  bool available(SamplingMethod method) const noexcept;

  /// @throws Error if it is not available, or the table is black and lobes are asked for.
  std::shared_ptr<const Scatter> build(SamplingMethod method, const Progress& progress = {});

 private:
  const LobeModel& lobes(std::size_t count);
  const StackGrid& outgoing(const Progress& progress);

  std::shared_ptr<const BrdfTable> table_;
  BsdfOptions options_;
  std::vector<LobeModel> fits_;  // one lobe, two, three; or the one that was given
  bool given_ = false;
  std::optional<StackGrid> outgoing_;
};

}  // namespace gonio
