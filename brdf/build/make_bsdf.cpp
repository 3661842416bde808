#include <utility>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/brdf/build/stack/build_stack.h>

namespace gonio {
namespace {

constexpr int colour_side = 16;  // of stacks that no fit chooses one for

BsdfData stack_data(const BrdfTable& table, const BsdfOptions& options, const Progress& progress) {
  BsdfData data{build_stack(table, options, progress), options.interpolation, {}};
  const Stack<float> stack = sampled_stack(data);
  if (options.f_r == BsdfValue::colour)
    data.colour = colour_of_table(table, direction_map(stack), stack.theta_i(), colour_side);
  return data;
}

BsdfData data_of(const BrdfTable& table, const BsdfOptions& options, const Progress& progress) {
  if (options.interpolation != Interpolation::blend) return stack_data(table, options, progress);
  if (options.f_r == BsdfValue::table) return fit_diagrams(table, options, progress);
  return fit_compact(table, options, progress).best().data;
}

}  // namespace

Bsdf make_bsdf(std::shared_ptr<const BrdfTable> table, const BsdfOptions& options, const Progress& progress) {
  table = required_table(std::move(table), "BSDF");
  const BsdfData data = data_of(*table, options, progress);
  return options.f_r == BsdfValue::table ? Bsdf(data, std::move(table)) : Bsdf(data);
}

}  // namespace gonio
