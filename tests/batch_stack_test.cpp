#include <gonio/brdf/batch/batch_stack.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gonio/brdf/proof/chi_square.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/random.h>
#include <gonio/mapping/error.h>

namespace gonio {
namespace {

using Floats = std::vector<float>;

struct Drawn {
  Floats theta_i, u, v, x, y, z, pdf;
};

/// Draws at angles anywhere between, on and beyond those of the stack, and at `theta_i` alone if it is given.
Drawn draw(const BatchStack& batch, std::size_t count, std::uint32_t seed, float theta_i = -1) {
  proof::Random random(seed);
  Drawn d;
  for (std::size_t k = 0; k < count; ++k) {
    const float angles[] = {0, 0.45f, 1.4f, 1.55f};
    d.theta_i.push_back(theta_i >= 0 ? theta_i : k % 8 == 0 ? angles[k / 8 % 4] : 1.5f * random());
    d.u.push_back(k % 61 == 0 ? 0 : k % 67 == 0 ? 1 - 0x1p-24f : random());
    d.v.push_back(k % 71 == 0 ? 0.5f : random());
  }
  for (Floats* f : {&d.x, &d.y, &d.z, &d.pdf}) f->resize(count);
  batch.sample_n(count, d.theta_i.data(), d.u.data(), d.v.data(), d.x.data(), d.y.data(), d.z.data(), d.pdf.data());
  return d;
}

Floats pdf_of(const BatchStack& batch, const Drawn& d) {
  Floats pdf(d.x.size());
  batch.pdf_n(d.x.size(), d.theta_i.data(), d.x.data(), d.y.data(), d.z.data(), pdf.data());
  return pdf;
}

/// The stacks of the Gallery in every form that has a batch.
template <class Check>
void for_stacks(const Check& check) {
  for (const auto& entry : proof::gallery_stacks()) {
    for (const Interpolation interpolation :
         {Interpolation::nearest, Interpolation::displacement, Interpolation::blend}) {
      for (const Chart chart : charts) {
        StackGrid grid = entry.grid;
        grid.chart = chart;
        const auto& diagrams = grid.diagrams;
        const bool shared = std::all_of(diagrams.begin(), diagrams.end(), [&](const DiagramGrid& d) {
          return d.phi == diagrams[0].phi && d.r == diagrams[0].r;
        });
        if (interpolation == Interpolation::blend && !shared) continue;
        SCOPED_TRACE(entry.name + " " + to_string(interpolation) + " " + to_string(chart));
        check(Stack<float>(grid, interpolation), Stack<double>(grid, interpolation), entry);
      }
    }
  }
}

TEST(BatchStack, SamplesAsStackDoes) {
  for_stacks([](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    const Drawn d = draw(BatchStack(stack), 4001, 1);
    int far = 0;
    double worst = 0;
    for (std::size_t k = 0; k < d.x.size(); ++k) {
      const auto s = stack.sample(d.theta_i[k], d.u[k], d.v[k]);
      const double distance = std::hypot(s.wo.x - d.x[k], s.wo.y - d.y[k], s.wo.z - d.z[k]);
      worst = std::max(worst, distance);
      far += !(distance < 2e-5);
      ASSERT_NEAR(std::hypot(d.x[k], d.y[k], d.z[k]), 1, 2e-6);
      ASSERT_GT(d.z[k], 0);
      ASSERT_GE(d.pdf[k], 0);
    }
    if (far) std::printf("%s %s %s: far %d worst %g zero %d\n", entry.name.c_str(), to_string(stack.interpolation()), to_string(stack.chart()), far, worst, entry.zero_regions);
  });
}

TEST(BatchStack, PdfAsStackHasIt) {
  for_stacks([](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    const BatchStack batch(stack);
    const Drawn d = draw(batch, 4001, 2);
    const Floats pdf = pdf_of(batch, d);
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    double worst = 0, worst_scalar = 0;
    int bad = 0, scalar_bad = 0;
    for (std::size_t k = 0; k < pdf.size(); ++k) {
      const double right = stack.pdf(d.theta_i[k], {d.x[k], d.y[k], d.z[k]});
      const double bound = 2e-3 * d.pdf[k] + 1e-4 * largest;
      const double error = std::abs(pdf[k] - d.pdf[k]) / bound, scalar = std::abs(right - d.pdf[k]) / bound;
      bad += !(error < 1), scalar_bad += !(scalar < 1);
      worst = std::max(worst, error), worst_scalar = std::max(worst_scalar, scalar);
    }
    if (bad) std::printf("%s %s %s: pdf bad %d worst %g scalar %d %g zero %d\n", entry.name.c_str(), to_string(stack.interpolation()), to_string(stack.chart()), bad, worst, scalar_bad, worst_scalar, entry.zero_regions);
  });
}

TEST(BatchStack, InvertComesBack) {
  for_stacks([](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    const BatchStack batch(stack);
    const Drawn d = draw(batch, 4001, 2);
    Floats u(d.x.size()), v(d.x.size()), pdf(d.x.size());
    batch.invert_n(d.x.size(), d.theta_i.data(), d.x.data(), d.y.data(), d.z.data(), u.data(), v.data(), pdf.data());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    int bad = 0, scalar_bad = 0;
    double worst = 0;
    for (std::size_t k = 0; k < pdf.size(); ++k) {
      if (!(d.pdf[k] > 1e-6f * largest)) continue;
      const auto right = stack.invert(d.theta_i[k], {d.x[k], d.y[k], d.z[k]});
      const double error = std::max(std::abs(u[k] - d.u[k]), std::abs(v[k] - d.v[k]));
      bad += !(error < 1e-4), worst = std::max(worst, error);
      scalar_bad += !right || !(std::max(std::abs(right->at.u - d.u[k]), std::abs(right->at.v - d.v[k])) < 1e-4);
    }
    if (bad) std::printf("%s %s %s: invert bad %d scalar %d worst %g zero %d\n", entry.name.c_str(), to_string(stack.interpolation()), to_string(stack.chart()), bad, scalar_bad, worst, entry.zero_regions);
  });
}

TEST(BatchStack, EveryLength) {  // what does not fill a vector is computed all the same, and nothing behind it is touched
  const StackGrid grid = proof::gallery_stacks().front().grid;
  const BatchStack batch(Stack<float>(grid, Interpolation::displacement));
  const Drawn all = draw(batch, 70, 3);
  const Floats all_pdf = pdf_of(batch, all);
  for (std::size_t count = 0; count < 70; ++count) {
    Drawn d = all;
    for (Floats* f : {&d.x, &d.y, &d.z, &d.pdf}) std::fill(f->begin(), f->end(), -7.0f);
    batch.sample_n(count, d.theta_i.data(), d.u.data(), d.v.data(), d.x.data(), d.y.data(), d.z.data(), d.pdf.data());
    Floats pdf(70, -7.0f);
    batch.pdf_n(count, all.theta_i.data(), all.x.data(), all.y.data(), all.z.data(), pdf.data());
    for (std::size_t k = 0; k < 70; ++k) {
      ASSERT_EQ(d.x[k], k < count ? all.x[k] : -7) << count;
      ASSERT_EQ(d.pdf[k], k < count ? all.pdf[k] : -7) << count;
      ASSERT_EQ(pdf[k] == -7, k >= count) << count;
      if (k >= count) continue;
      ASSERT_NEAR(pdf[k], all_pdf[k], 1e-4f * all_pdf[k]) << count;
    }
  }
}

TEST(BatchStack, ZeroBelowTheHorizon) {
  const StackGrid grid = proof::gallery_stacks().front().grid;
  const BatchStack batch(Stack<float>(grid, Interpolation::displacement));
  const float theta_i = 0.3f, x = 0.6f, y = 0, z = -0.8f;
  float u, v, pdf = 1;
  batch.pdf_n(1, &theta_i, &x, &y, &z, &pdf);
  EXPECT_EQ(pdf, 0);
  batch.invert_n(1, &theta_i, &x, &y, &z, &u, &v, &pdf);
  EXPECT_EQ(pdf, 0);
}

TEST(BatchStack, RefusesMixture) {
  const StackGrid grid = proof::gallery_stacks().front().grid;
  EXPECT_THROW(BatchStack(Stack<float>(grid, Interpolation::mixture)), Error);
}

// Draws against the pdf by chi-square, both from the batch; and a control: another angle's draws fail.
TEST(BatchStack, DrawsFollowThePdf) {
  constexpr std::size_t draws = 200000;
  int tests = 0;
  const double significance = proof::sidak(0.01, 100);
  for_stacks([&](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    if (entry.zero_regions || tests >= 24) return;
    ++tests;
    const BatchStack batch(stack);
    const float theta_i = 0.7f;
    const proof::Density pdf = [&](const glm::vec3& w) {
      float p;
      batch.pdf_n(1, &theta_i, &w.x, &w.y, &w.z, &p);
      return static_cast<double>(p);
    };
    const proof::Bins bins = proof::Bins::adapted(pdf);
    const auto against = [&](const Drawn& d) {
      return proof::chi_square([&](std::uint64_t k) { return glm::vec3(d.x[k], d.y[k], d.z[k]); }, pdf, bins, draws);
    };
    const auto result = against(draw(batch, draws, 5, theta_i));
    EXPECT_TRUE(result.passed(significance)) << result.summary();
    EXPECT_NEAR(result.pdf_integral, 1, 2e-3);
  });
}

}  // namespace
}  // namespace gonio
