#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/gtest.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio::proof {
namespace {

// One run of the harness per entry of the Gallery, method and incident angle: the significance is
// shared out over about as many.
constexpr int runs = 1000;

// Of each run; the tests labelled slow do 10^6, at more angles.
const std::uint64_t draws = std::getenv("GONIO_DRAWS") ? std::strtoull(std::getenv("GONIO_DRAWS"), nullptr, 10) : 50000;

const bool slow = std::getenv("GONIO_DRAWS") != nullptr;

// On a diagram, between two, half way, next to one, and at both ends.
std::vector<double> angles() {
  if (!slow) return {0, 0.225, 0.45, 0.45 + 1e-6, 1.3, pi<double> / 2};
  return {0, 1e-6, 0.2, 0.225, 0.45 - 1e-6, 0.45, 0.45 + 1e-6, 0.7, 0.95, 1.3, 89.9 * pi<double> / 180, pi<double> / 2};
}

struct Method {
  Chart chart;
  Interpolation interpolation;
  bool packed = false;
};
constexpr Method methods[] = {
    {Chart::outgoing, Interpolation::nearest},      {Chart::outgoing, Interpolation::mixture},
    {Chart::outgoing, Interpolation::displacement}, {Chart::outgoing, Interpolation::blend},
    {Chart::half, Interpolation::nearest},          {Chart::half, Interpolation::mixture},
    {Chart::half, Interpolation::displacement},     {Chart::half, Interpolation::blend},
    {Chart::outgoing, Interpolation::blend, true},  {Chart::half, Interpolation::blend, true}};

std::string name_of(const Method& m) {
  return std::string(m.packed ? "packed " : "") + to_string(m.interpolation) + "/" + to_string(m.chart);
}

InvariantOptions options_for(const Method& method) {
  InvariantOptions options;
  options.runs = runs;
  options.draws = draws;
  options.points = 1000;
  if (method.chart == Chart::half) options.direction_bound = 1e-3;  // see Stack::invert()
  if (method.interpolation == Interpolation::mixture)
    options.direction_bound = method.chart == Chart::half ? 5e-2 : 1e-2;
  options.one_to_one = method.interpolation != Interpolation::mixture;
  options.continuous =
      method.interpolation == Interpolation::displacement || method.interpolation == Interpolation::blend;
  return options;
}

// What is known to fail, where, and why; docs/guide/proof.md lists the same. All of it is where nearly no draw falls.
struct Known {
  enum Where { anywhere, half_chart, grazing_half_chart };  // grazing: theta_i > 1.5
  Where where;
  std::string entry;  // of the Gallery; empty: any
  std::set<std::string> checks;
  std::string witness;  // an entry for which all of the checks do fail
};
const Known known[] = {
    {Known::anywhere, "decades", {"edge_pdf"}, "decades"},
    {Known::half_chart, "zero-half", {"edge_weight"}, "zero-half"},
    {Known::half_chart, "spike", {"edge_weight"}, "spike"},
    {Known::grazing_half_chart, "", {"edge_weight"}, "specular"},
    {Known::grazing_half_chart, "zero-table", {"mass", "jumps"}, "zero-table"},
};

/// Runs the checks of one entry of the Gallery by all methods, and remembers what failed that is known to.
class GalleryRun {
 public:
  explicit GalleryRun(std::string entry) : entry_(std::move(entry)) {}

  void check_all(const Subject& subject, const Method& method, double theta_i, const InvariantOptions& options) {
    for (const Check& check : check_invariants(subject, theta_i, options))
      EXPECT_TRUE(check.passed || is_known(method, theta_i, check.name))
          << entry_ << ", " << name_of(method) << ", at " << theta_i << ": " << check.message;
  }

  /// What is exempt and fails no more is exempt no more.
  void expect_no_stale_exemption() const {
    for (std::size_t k = 0; k < std::size(known); ++k) {
      if (known[k].witness != entry_) continue;
      EXPECT_EQ(failed_[k], known[k].checks) << "exempt, but it did not fail";
    }
  }

 private:
  bool is_known(const Method& method, double theta_i, const std::string& check) {
    bool found = false;
    for (std::size_t k = 0; k < std::size(known); ++k) {
      const Known& e = known[k];
      const bool here = e.where == Known::anywhere ||
                        (method.chart == Chart::half && (e.where == Known::half_chart || theta_i > 1.5));
      if (!here || !(e.entry.empty() || e.entry == entry_) || !e.checks.count(check)) continue;
      failed_[k].insert(check);
      found = true;
    }
    return found;
  }

  const std::string entry_;
  std::set<std::string> failed_[std::size(known)];
};

class StackGallery : public testing::TestWithParam<GalleryStack> {};

TEST_P(StackGallery, InvariantsHold) {
  const GalleryStack& entry = GetParam();
  GalleryRun run(entry.name);
  for (const Method& method : methods) {
    StackGrid grid = entry.grid;
    grid.chart = method.chart;
    if (method.interpolation == Interpolation::blend && !shared_lines(grid)) continue;
    const Stack<float> stack(method.packed ? rounded16(grid) : grid, method.interpolation);
    InvariantOptions options = options_for(method);
    options.symmetric = grid.diagrams.front().azimuth == Azimuth::half;
    options.continuous = options.continuous && !entry.zero_regions;
    for (const double theta_i : angles()) {
      // Smooth densities of half vectors are peaks at the horizon there that no quadrature finds.
      if (method.chart == Chart::half && theta_i > 1.4) continue;
      run.check_all(subject_of(stack), method, theta_i, options);
    }
  }
  // Tables have these names, too, and theirs are the exemptions.
  if (entry.name != "specular" && entry.name != "spike") run.expect_no_stale_exemption();
}

class TableGallery : public testing::TestWithParam<GalleryTable> {};

std::vector<double> table_angles() {
  if (!slow) return {0, 0.8, pi<double> / 2};
  return {0, 0.3, 0.8, 89.9 * pi<double> / 180, pi<double> / 2};
}

TEST_P(TableGallery, InvariantsHold) {
  const auto table = std::make_shared<const BrdfTable>(to_table(GetParam()));
  GalleryRun run(GetParam().name);
  for (const Method& method : methods) {
    BsdfOptions small;
    small.incident = 12;
    small.meridians = small.parallels = 16;
    small.chart = method.chart;
    // The other two interpolations take what is built for displacement.
    small.interpolation =
        method.interpolation == Interpolation::blend ? Interpolation::blend : Interpolation::displacement;
    const StackGrid grid = build_stack(*table, small);
    const StackBsdf bsdf({grid, method.interpolation, {}}, table);
    InvariantOptions options = options_for(method);
    options.continuous = options.continuous && !GetParam().zero_regions;
    for (const double theta_i : table_angles()) run.check_all(subject_of(bsdf), method, theta_i, options);
  }
  run.expect_no_stale_exemption();
  InvariantOptions options;
  options.runs = runs;
  options.draws = draws;
  options.turns = false;
  for (const double theta_i : {0.3, pi<double> / 2}) {
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(subject_of(UniformSampler(table)), theta_i, options) << "uniform";
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(subject_of(CosineSampler(table)), theta_i, options) << "cosine";
  }
}

template <class Entry>
std::string name_of(const testing::TestParamInfo<Entry>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Gallery, StackGallery, testing::ValuesIn(gallery_stacks()), name_of<GalleryStack>);
INSTANTIATE_TEST_SUITE_P(Gallery, TableGallery, testing::ValuesIn(gallery_tables()), name_of<GalleryTable>);

// Negative controls: samplers that are wrong on purpose. Each must fail, by the check that is there for it.
class Wrong : public testing::Test {
 protected:
  static std::shared_ptr<const BrdfTable> table() {
    for (const GalleryTable& entry : gallery_tables())
      if (entry.name == "asymmetric") return std::make_shared<const BrdfTable>(to_table(entry));
    throw std::logic_error("the Gallery has no asymmetric table");
  }
  static const BsdfData& data() {
    static const BsdfData d = fit_compact(*table()).best().data;
    return d;
  }
  /// The one with an inverse: more can fail.
  static const StackBsdf& sampler() {
    static const StackBsdf s(data(), table());
    return s;
  }

  static bool fails(const Subject& subject, const std::string& name) {
    InvariantOptions options;
    options.points = 1000;
    options.draws = 300000;
    for (const Check& check : check_invariants(subject, 0.5, options))
      if (check.name == name) return !check.passed;
    return false;
  }
};

TEST_F(Wrong, TheSamplerItselfIsRight) {
  EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(subject_of(sampler()), 0.5);
  EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(subject_of(Bsdf(data(), table())), 0.5);
}

TEST_F(Wrong, PdfOffByOnePerCent) {
  Subject subject = subject_of(sampler());
  subject.pdf = [](const glm::vec3& wi, const glm::vec3& wo) { return 1.01 * sampler().pdf(wi, wo); };
  EXPECT_TRUE(fails(subject, "mass"));
  EXPECT_TRUE(fails(subject, "pdf"));
  EXPECT_FALSE(fails(subject, "chi_square"));  // which judges the shape
}

TEST_F(Wrong, ReturnedPdfOffByOnePerCent) {
  Subject subject = subject_of(sampler());
  subject.sample = [](const glm::vec3& wi, const glm::vec2& u) {
    auto s = sampler().sample(wi, u);
    if (s) s->pdf *= 1.01f;
    return s;
  };
  EXPECT_TRUE(fails(subject, "pdf"));
  EXPECT_TRUE(fails(subject, "weight"));
}

TEST_F(Wrong, WeightOffByOnePerCent) {
  Subject subject = subject_of(sampler());
  subject.sample = [](const glm::vec3& wi, const glm::vec2& u) {
    auto s = sampler().sample(wi, u);
    if (s) s->weight *= 1.01f;
    return s;
  };
  EXPECT_TRUE(fails(subject, "weight"));
  EXPECT_TRUE(fails(subject, "albedo"));
}

// The draws are half a texel of a 90-cell table (half a degree) beside their density.
TEST_F(Wrong, HalfATexelAside) {
  Subject subject = subject_of(sampler());
  subject.sample = [](const glm::vec3& wi, const glm::vec2& u) {
    auto s = sampler().sample(wi, u);
    if (!s) return s;
    const Polar<float> at = direction_to_polar(s->wo);
    const float theta = std::min(radius_to_theta(at.r) + 0.5f * pi<float> / 180, 1.5707f);
    s->wo = polar_to_direction(Polar<float>{theta_to_radius(theta), at.phi});
    return s;
  };
  EXPECT_TRUE(fails(subject, "chi_square"));
  EXPECT_TRUE(fails(subject, "moments"));
  EXPECT_TRUE(fails(subject, "round_trip_square"));
}

TEST_F(Wrong, SwappedDirections) {
  Subject subject = subject_of(sampler());
  subject.f_r = [](const glm::vec3& wi, const glm::vec3& wo) { return sampler().eval(wo, wi); };
  EXPECT_TRUE(fails(subject, "weight"));
  EXPECT_TRUE(fails(subject, "albedo"));
  subject = subject_of(sampler());
  subject.pdf = [](const glm::vec3& wi, const glm::vec3& wo) { return static_cast<double>(sampler().pdf(wo, wi)); };
  EXPECT_TRUE(fails(subject, "chi_square"));
  EXPECT_TRUE(fails(subject, "mass"));
  EXPECT_TRUE(fails(subject, "pdf"));
}

// The two halves of the square change places: the same draws, the same pdf, but torn in the middle.
TEST_F(Wrong, Torn) {
  Subject subject = subject_of(sampler());
  subject.sample = [](const glm::vec3& wi, const glm::vec2& u) {
    return sampler().sample(wi, {u.x < 0.5f ? u.x + 0.5f : u.x - 0.5f, u.y});
  };
  EXPECT_TRUE(fails(subject, "tears"));
  EXPECT_TRUE(fails(subject, "round_trip_square"));
  EXPECT_FALSE(fails(subject, "chi_square"));
}

TEST_F(Wrong, NearestTakenForContinuous) {
  for (const GalleryStack& entry : gallery_stacks()) {
    if (entry.name != "specular") continue;
    const Stack<float> stack(entry.grid, Interpolation::nearest);
    InvariantOptions options;
    options.draws = 1000;
    const Checks checks = check_invariants(subject_of(stack), 0.225, options);
    EXPECT_NE(failures(checks).find("jumps:"), std::string::npos);
    EXPECT_NE(failures(checks).find("jumps_of_map:"), std::string::npos);
  }
}

TEST_F(Wrong, NoSupport) {
  Subject subject = subject_of(sampler());
  subject.pdf = [](const glm::vec3& wi, const glm::vec3& wo) { return wo.x > 0.5f ? 0.0 : sampler().pdf(wi, wo); };
  EXPECT_TRUE(fails(subject, "support"));
}

TEST_F(Wrong, NotTurningWithTheSurface) {  // wi's azimuth is forgotten
  Subject subject = subject_of(sampler());
  subject.pdf = [](const glm::vec3& wi, const glm::vec3& wo) {
    return static_cast<double>(sampler().pdf({std::sqrt(1 - wi.z * wi.z), 0, wi.z}, wo));
  };
  EXPECT_TRUE(fails(subject, "rotation"));
}

TEST(Invariants, PlotOfAFailure) {
  Subject uniform;
  uniform.sample = [](const glm::vec3&, const glm::vec2& u) -> std::optional<BsdfSample> {
    const Polar<float> at{std::sqrt(u.x), 2 * pi<float> * u.y};
    return BsdfSample{polar_to_direction(at), 1 / (2 * pi<float>), glm::vec3(1)};
  };
  uniform.pdf = [](const glm::vec3&, const glm::vec3& wo) { return wo.z / pi<double>; };
  InvariantOptions options;
  options.draws = 50000;
  options.plot = (std::filesystem::temp_directory_path() / "gonio_invariants_test.svg").string();
  EXPECT_FALSE(all_passed(check_invariants(uniform, 0.3, options)));
  EXPECT_GT(std::filesystem::file_size(options.plot), 1000u);
  std::filesystem::remove(options.plot);
}

}  // namespace

void PrintTo(const GalleryStack& entry, std::ostream* out) { *out << entry.name << ": " << entry.reason; }
void PrintTo(const GalleryTable& entry, std::ostream* out) { *out << entry.name << ": " << entry.reason; }

}  // namespace gonio::proof
