#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/batch/batch_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/stack/rounded16.h>

#include "tests/support/batch_targets.h"

namespace gonio {
namespace {

using Floats = std::vector<float>;

class BatchStackOn : public OnTarget {};
GONIO_ON_ALL_TARGETS(BatchStackOn);

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
    const bool edges = theta_i < 0;
    d.u.push_back(!edges ? random() : k % 61 == 0 ? 0 : k % 67 == 0 ? 1 - 0x1p-24f : random());
    d.v.push_back(edges && k % 71 == 0 ? 0.5f : random());
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
        StackGrid grid = rounded16(entry.grid);  // as batches hold it
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

/// How far the direction moves when u and v do by a few float steps: what a draw can be held to.
double spread(const Stack<double>& stack, double theta_i, double u, double v) {
  constexpr double step = 0x1p-21;
  const auto centre = stack.sample(theta_i, u, v).wo;
  double far = 0;
  for (const double du : {-step, 0.0, step})
    for (const double dv : {-step, 0.0, step}) {
      const auto wo = stack.sample(theta_i, std::clamp(u + du, 0.0, 1.0), std::clamp(v + dv, 0.0, 1.0)).wo;
      far = std::max(far, std::hypot(wo.x - centre.x, wo.y - centre.y, wo.z - centre.z));
    }
  return far;
}

TEST_P(BatchStackOn, SamplesAsStackDoes) {
  for_stacks([](const Stack<float>& stack, const Stack<double>& wide, const proof::GalleryStack&) {
    const Drawn d = draw(BatchStack(stack), 4001, 1);
    for (std::size_t k = 0; k < d.x.size(); ++k) {
      ASSERT_NEAR(std::hypot(d.x[k], d.y[k], d.z[k]), 1, 2e-6);
      ASSERT_GT(d.z[k], 0);
      ASSERT_GE(d.pdf[k], 0);
      const auto s = stack.sample(d.theta_i[k], d.u[k], d.v[k]);
      const double distance = std::hypot(s.wo.x - d.x[k], s.wo.y - d.y[k], s.wo.z - d.z[k]);
      if (distance <= 2e-5) continue;
      ASSERT_LT(distance, 2e-5 + spread(wide, d.theta_i[k], d.u[k], d.v[k]));
    }
  });
}

TEST_P(BatchStackOn, PdfIsThatOfTheDraws) {
  for_stacks([](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    const BatchStack batch(stack);
    const Drawn d = draw(batch, 4001, 2);
    const Floats pdf = pdf_of(batch, d);
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < pdf.size(); ++k) {
      const double bound = 2e-3 * d.pdf[k] + 1e-4 * largest;
      ASSERT_NEAR(pdf[k], d.pdf[k], bound) << k;
      if (entry.zero_regions) continue;  // there the searches may end on either side of a gap
      ASSERT_NEAR(pdf[k], stack.pdf(d.theta_i[k], {d.x[k], d.y[k], d.z[k]}), bound) << k;
    }
  });
}

TEST_P(BatchStackOn, InvertComesBack) {
  for_stacks([](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack&) {
    const BatchStack batch(stack);
    const Drawn d = draw(batch, 4001, 2);
    Floats u(d.x.size()), v(d.x.size()), pdf(d.x.size());
    batch.invert_n(d.x.size(), d.theta_i.data(), d.x.data(), d.y.data(), d.z.data(), u.data(), v.data(), pdf.data());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < pdf.size(); ++k) {
      if (!(d.pdf[k] > 1e-6f * largest)) continue;
      ASSERT_NEAR(u[k], d.u[k], 3e-4) << k;
      ASSERT_NEAR(v[k], d.v[k], 3e-4) << k;
      ASSERT_NEAR(pdf[k], d.pdf[k], 2e-3 * d.pdf[k] + 1e-4 * largest) << k;
    }
  });
}

TEST_P(BatchStackOn,
       EveryLength) {  // what does not fill a vector is computed all the same, and nothing behind it is touched
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

TEST_P(BatchStackOn, ZeroBelowTheHorizon) {
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
TEST_P(BatchStackOn, DrawsFollowThePdf) {
  constexpr std::size_t draws = 100000;
  int seen = 0;
  const double significance = proof::sidak(0.01, 100);
  for_stacks([&](const Stack<float>& stack, const Stack<double>&, const proof::GalleryStack& entry) {
    if (entry.zero_regions || ++seen % 23 != 0) return;
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
    Drawn turned = draw(batch, draws, 5, theta_i);  // the control: by 0.03 rad towards +x
    for (std::size_t k = 0; k < draws; ++k)
      turned.x[k] += 0.03f * turned.z[k], turned.z[k] -= std::min(0.03f * turned.x[k], 0.9f * turned.z[k]);
    EXPECT_FALSE(against(turned).passed(significance));
  });
}

}  // namespace
}  // namespace gonio
