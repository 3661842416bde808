#include <string>

#include <gtest/gtest.h>

#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

const BrdfTable& specular_table() {
  static const BrdfTable table = [] {
    for (const auto& entry : proof::gallery_tables())
      if (entry.name == "specular") return proof::to_table(entry);
    throw std::logic_error("the Gallery has no specular table");
  }();
  return table;
}

BsdfOptions displacement() {
  BsdfOptions options;
  options.interpolation = Interpolation::displacement;
  return options;
}

TEST(BuildStack, LimitsHold) {
  for (const Interpolation interpolation : {Interpolation::displacement, Interpolation::blend}) {
    BsdfOptions options = displacement();
    options.interpolation = interpolation;
    options.incident = 9, options.meridians = 8, options.parallels = 7;
    const StackGrid small = build_stack(specular_table(), options);
    EXPECT_LE(small.theta_i.size(), 9u);
    for (const auto& d : small.diagrams) EXPECT_TRUE(d.phi.size() <= 8 && d.r.size() <= 7);
  }
  BsdfOptions options = displacement();
  options.budget = 30000;
  EXPECT_LE(Stack<float>(build_stack(specular_table(), options), Interpolation::displacement).bytes(), 30000u + 1024);
}

TEST(BuildStack, RefusesBadOptions) {
  BsdfOptions options = displacement();
  options.incident = 1;
  EXPECT_THROW(build_stack(specular_table(), options), Error);
  options = displacement();
  options.max_variance = 0;
  EXPECT_THROW(build_stack(specular_table(), options), Error);
}

TEST(BuildStack, DoesNotDependOnScheduling) {
  const StackGrid a = build_stack(specular_table(), displacement()), b = build_stack(specular_table(), displacement());
  EXPECT_EQ(a.theta_i, b.theta_i);
  EXPECT_EQ(a.diagrams.back().density, b.diagrams.back().density);
}

}  // namespace
}  // namespace gonio
