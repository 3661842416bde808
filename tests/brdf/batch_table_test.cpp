#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/batch/tables/batch_table.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/table/table.h>
#include <gonio/fitting/model/synth.h>

#include "tests/support/batch_targets.h"
#include "tests/support/files.h"
#include "tests/support/table_files.h"

namespace gonio {
namespace {

class BatchTableOn : public OnTarget {};
GONIO_ON_ALL_TARGETS(BatchTableOn);

struct Case {
  std::string name;
  BrdfTable table, brightest;  // the second with the largest value of each channel in all cells
};

glm::vec3 largest_of(const std::vector<glm::vec3>& cells) {
  glm::vec3 largest(0);
  for (const glm::vec3& cell : cells) largest = glm::max(largest, glm::abs(cell));
  return largest;
}

Case of_grid(const std::string& name, const BrdfTable& table, const std::vector<glm::vec3>& cells) {
  const glm::vec3 largest = largest_of(cells);
  MbsdfFile brightest;
  brightest.n_theta_in = brightest.n_theta_out = brightest.n_phi = 1, brightest.channels = 3;
  brightest.values = {largest.x, largest.y, largest.z};
  return {name, table, BrdfTable(MbsdfTable(brightest), {})};
}
template <class Table>
Case of_grid(const std::string& name, const Table& table) {
  return of_grid(name, BrdfTable(table, {}), table.values());
}

Case of_rgl(const std::string& name, RglFile file) {
  BrdfTable table(RglTable(file, {}), {});
  file.colour.assign(file.colour.size(), largest_of(file.colour));
  return {name, std::move(table), BrdfTable(RglTable(std::move(file), {}), {})};
}

MbsdfTable grid_of(int n_theta, int n_phi, int channels, std::uint32_t seed) {
  MbsdfFile file;
  file.n_theta_in = file.n_theta_out = n_theta, file.n_phi = n_phi, file.channels = channels;
  proof::Random random(seed);
  for (int i = 0; i < n_theta * n_theta * n_phi * channels; ++i) file.values.push_back(random());
  return MbsdfTable(file);
}

MerlTable merl_of(int n_phi_d, std::uint32_t seed) {
  proof::Random random(seed);
  return MerlTable(test::make_merl([&](int, int, int) { return random() < 0.01f ? 5.0 : random(); }, n_phi_d), {});
}

/// Rough densities with zeros, and colours some of which are negative.
RglFile rgl_file(int slices, bool jacobian, std::uint32_t seed) {
  proof::Random random(seed);
  const auto grid = [&](int n, int height, int width) {
    RglFile::Grid made{n, height, width, {}};
    for (int i = 0; i < n * height * width; ++i) made.values.push_back(random() < 0.2f ? 0 : random());
    return made;
  };
  RglFile file;
  for (int i = 0; i < slices; ++i) file.theta_i.push_back(1.5f * static_cast<float>(i) / static_cast<float>(slices));
  file.ndf = grid(1, 3, 9), file.sigma = grid(1, 2, 5);
  for (float& value : file.sigma.values) value += 0.5f;
  file.vndf = grid(slices, 11, 7), file.luminance = grid(slices, 4, 5);
  file.colour_height = 6, file.colour_width = 8;
  for (int i = 0; i < slices * 48; ++i) file.colour.push_back(glm::vec3(random(), random(), random()) - 0.1f);
  file.jacobian = jacobian;
  return file;
}

const std::vector<Case>& made_cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> list;
    for (const auto& entry : proof::gallery_tables()) list.push_back(of_grid(entry.name, MbsdfTable(entry.file)));
    list.push_back(of_grid("one cell", grid_of(1, 1, 3, 1)));
    list.push_back(of_grid("one azimuth", grid_of(7, 1, 1, 2)));
    list.push_back(of_grid("one angle", grid_of(1, 5, 3, 3)));
    list.push_back(of_grid("two by three", grid_of(2, 3, 3, 4)));
    list.push_back(of_grid("MERL", merl_of(180, 5)));
    list.push_back(of_grid("MERL, not reciprocal", merl_of(360, 6)));
    list.push_back(of_grid(
        "MERL of a model",
        MerlTable(synthesize_merl(parse_model("ggx:alpha=0.05,F0=0.9/0.5/0.2+lambert:albedo=0.1/0.2/0.3")), {})));
    for (const int slices : {1, 2, 8}) {
      const std::string name = "RGL of " + std::to_string(slices) + " angles";
      list.push_back(of_rgl(name, rgl_file(slices, true, 7)));
      list.push_back(of_rgl(name + ", values alone", rgl_file(slices, false, 8)));
    }
    return list;
  }();
  return all;
}

/// Of quotients that no float holds, and lines without mass.
Case damaged_case() {
  RglFile damaged = rgl_file(3, true, 9);
  damaged.ndf.values.assign(27, 1e30f);
  damaged.sigma.values = {0, 0, 0, 0, 1e-30f, 0, 0, 0, 0, 1e-30f};
  std::fill_n(damaged.vndf.values.begin() + 28, 21, 0.0f);
  return of_rgl("RGL, damaged", std::move(damaged));
}

struct Pairs {
  std::vector<float> wi[3], wo[3];

  void add(const glm::vec3& i, const glm::vec3& o) {
    for (int c = 0; c < 3; ++c) wi[c].push_back(i[c]), wo[c].push_back(o[c]);
  }
  std::size_t size() const { return wi[0].size(); }
  glm::vec3 wi_at(std::size_t k) const { return {wi[0][k], wi[1][k], wi[2][k]}; }
  glm::vec3 wo_at(std::size_t k) const { return {wo[0][k], wo[1][k], wo[2][k]}; }
};

std::vector<glm::vec3> eval_n(const BrdfTable& table, const Pairs& pairs) {
  std::vector<float> rgb[3];
  for (auto& channel : rgb) channel.assign(pairs.size(), -7);
  table.eval_n(pairs.size(), {pairs.wi[0].data(), pairs.wi[1].data(), pairs.wi[2].data()},
               {pairs.wo[0].data(), pairs.wo[1].data(), pairs.wo[2].data()},
               {rgb[0].data(), rgb[1].data(), rgb[2].data()});
  std::vector<glm::vec3> result;
  for (std::size_t k = 0; k < pairs.size(); ++k) result.push_back({rgb[0][k], rgb[1][k], rgb[2][k]});
  return result;
}

glm::vec3 eval_one(const BrdfTable& table, const glm::vec3& wi, const glm::vec3& wo) {
  return std::visit([&](const auto& data) { return gonio::eval_one(data, wi, wo); }, table.data());
}

glm::vec3 polar(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Everywhere, around the mirror direction, and where angles meet their ends or the borders of cells.
Pairs all_pairs(std::size_t random_ones) {
  Pairs pairs;
  proof::Random random(11);
  constexpr float half_pi = 0.5f * pi<float>;
  for (std::size_t k = 0; k < random_ones; ++k) {
    const float theta_i = half_pi * random(), phi_i = 2 * pi<float> * random(), spread = k % 2 == 0 ? 0.05f : 1.0f;
    const auto off = [&] { return spread * (random() - 0.5f); };
    const bool mirror = k % 4 < 2;
    const float theta_o = mirror ? std::clamp(theta_i + off(), 0.0f, half_pi) : half_pi * random();
    pairs.add(polar(theta_i, phi_i), polar(theta_o, mirror ? phi_i + pi<float> + off() : 2 * pi<float> * random()));
  }
  std::vector<glm::vec3> special = {{0, 0, 1}, {1e-20f, 0, 1}, {0, -1e-8f, 1}};
  for (const float degrees : {0.0f, 0.5f, 1.0f, 30.0f, 44.5f, 45.0f, 60.0f, 89.5f, 89.9f, 90.0f})
    for (const float phi : {0.0f, 0.5f, 90.0f, 179.5f, 180.0f, 270.0f, 359.99f})
      special.push_back(polar(degrees * pi<float> / 180, phi * pi<float> / 180));
  for (const float z : {1e-3f, 1e-7f, 1e-30f}) special.push_back({-1, 0, z});
  for (const glm::vec3& wi : special)
    for (const glm::vec3& wo : special) pairs.add(wi, wo);  // wi itself and its mirror image, too
  return pairs;
}

/// What BrdfTable::eval_n() promises, a part of each: of the value; of what it would be if all cells were as bright as
/// the brightest; and what eval() changes by as a direction moves so far, wi in its plane of incidence.
constexpr float few_roundings = 1e-5f;
glm::vec3 bound_at(const Case& c, const glm::vec3& wi, const glm::vec3& wo) {
  const glm::vec3 centre = c.table.eval(wi, wo);
  glm::vec3 nearby(0);
  const auto look = [&](const glm::vec3& i, const glm::vec3& o) {
    nearby = glm::max(nearby, glm::abs(c.table.eval(i, o) - centre));
  };
  const float sine = std::hypot(wi.x, wi.y), cos_phi = sine > 0 ? wi.x / sine : 1, sin_phi = sine > 0 ? wi.y / sine : 0;
  for (const float step : {-few_roundings, few_roundings}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 moved = wo;
      moved[axis] += step;
      if (moved.z > 0) look(wi, moved);
    }
    const float theta = std::max(std::atan2(sine, wi.z) + step, 0.0f);
    const glm::vec3 tilted(std::sin(theta) * cos_phi, std::sin(theta) * sin_phi, std::cos(theta));
    if (tilted.z > 0) look(tilted, wo);
  }
  return nearby + few_roundings * (centre + c.brightest.eval(wi, wo));
}

/// The first pair where `values` are not the table's.
std::size_t first_wrong(const Case& c, const Pairs& pairs, const std::vector<glm::vec3>& values) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const glm::vec3 wi = pairs.wi_at(k), wo = pairs.wo_at(k), expected = c.table.eval(wi, wo);
    const glm::vec3 difference = glm::abs(values[k] - expected);
    const auto within = [&](const glm::vec3& bound) { return glm::all(glm::lessThanEqual(difference, bound)); };
    if (!within(few_roundings * expected) && !within(bound_at(c, wi, wo))) return k;
  }
  return pairs.size();
}

std::string described(const Case& c, const Pairs& pairs, const std::vector<glm::vec3>& values, std::size_t k) {
  if (k == pairs.size()) return "";
  const glm::vec3 wi = pairs.wi_at(k), wo = pairs.wo_at(k);
  const auto text = [](const glm::vec3& v) {
    char line[100];
    std::snprintf(line, sizeof line, "(%.9g, %.9g, %.9g)", v.x, v.y, v.z);
    return std::string(line);
  };
  return "wi " + text(wi) + ", wo " + text(wo) + ": found " + text(values[k]) + ", expected " +
         text(c.table.eval(wi, wo)) + " within " + text(bound_at(c, wi, wo));
}

void expect_as_plain(const Case& c, const Pairs& pairs) {
  SCOPED_TRACE(c.name);
  const std::vector<glm::vec3> values = eval_n(c.table, pairs);
  const std::size_t wrong = first_wrong(c, pairs, values);
  EXPECT_EQ(wrong, pairs.size()) << described(c, pairs, values, wrong);
  std::vector<glm::vec3> one_by_one;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    one_by_one.push_back(eval_one(c.table, pairs.wi_at(k), pairs.wo_at(k)));
  const std::size_t wrong_one = first_wrong(c, pairs, one_by_one);
  EXPECT_EQ(wrong_one, pairs.size()) << "one at a time: " << described(c, pairs, one_by_one, wrong_one);
}

TEST_P(BatchTableOn, AsPlainCode) {
  const Pairs pairs = all_pairs(20011);
  for (const Case& c : made_cases()) expect_as_plain(c, pairs);
}

TEST_P(BatchTableOn, AsPlainCodeOnMeasuredFiles) {
  const std::filesystem::path data = test::test_data();
  if (data.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const Pairs pairs = all_pairs(100003);
  for (const char* file : {"paper_white", "cg_sunflower", "satin_rosaline"})
    expect_as_plain(of_rgl(file, read_rgl(data / "rgl" / (std::string(file) + "_rgb.bsdf"))), pairs);
  for (const char* file : {"carpaint_blue.mbsdf", "carpaint_red.mbsdf"})
    expect_as_plain(of_grid(file, MbsdfTable(read_mbsdf(data / "mbsdf" / file))), pairs);
}

// The bound is tight enough to see values off by a thousandth, and directions by a hundredth of a degree.
TEST_P(BatchTableOn, WhatIsWrongIsFound) {
  const Pairs pairs = all_pairs(5000);
  for (const Case& c : made_cases()) {
    if (c.name != "asymmetric" && c.name != "MERL" && c.name != "RGL of 8 angles") continue;
    SCOPED_TRACE(c.name);
    std::vector<glm::vec3> values = eval_n(c.table, pairs);
    for (glm::vec3& value : values) value *= 1.001f;
    EXPECT_LT(first_wrong(c, pairs, values), pairs.size());
    Pairs moved = pairs;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const glm::vec3 wo = glm::normalize(pairs.wo_at(k) + glm::vec3(2e-4f, 0, 0));
      for (int i = 0; i < 3; ++i) moved.wo[i][k] = wo[i];
    }
    EXPECT_LT(first_wrong(c, pairs, eval_n(c.table, moved)), pairs.size());
  }
}

// Whatever the directions, indices stay within the table, which the sanitizers see, and there are no NaN.
TEST_P(BatchTableOn, NothingBelowTheHorizonOrOfBrokenDirections) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const glm::vec3 up(0.6f, 0, 0.8f);
  const std::vector<glm::vec3> broken = {{0.6f, 0, -0.8f}, {1, 0, 0},      {1, 0, -0.0f},    {nan, nan, nan},
                                         {nan, 0, 0.8f},   {0.6f, nan, 1}, {0.6f, 0, nan},   {inf, 0, 0.8f},
                                         {0, -inf, 0.8f},  {0.6f, 0, inf}, {-inf, inf, 0.5f}};
  Pairs pairs;
  for (const glm::vec3& w : broken) {
    pairs.add(w, up), pairs.add(up, w), pairs.add(w, {0, 0, 1}), pairs.add({0, 0, 1}, w), pairs.add(w, w);
  }
  Pairs huge;  // not of unit length: no promise but that
  for (const float a : {1e-38f, 1e-20f, 1e15f, 1e19f, 1e38f})
    for (const glm::vec3& w : {up * a, glm::vec3(a, a, 1), glm::vec3(0, 0, a), glm::vec3(a, -a, a)})
      for (const glm::vec3& v : {up, w, glm::vec3(0, 0, 1)}) huge.add(w, v), huge.add(v, w);
  std::vector<Case> cases = made_cases();
  cases.push_back(damaged_case());
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const std::vector<glm::vec3> values = eval_n(c.table, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      ASSERT_EQ(values[k], glm::vec3(0)) << k;
      ASSERT_EQ(eval_one(c.table, pairs.wi_at(k), pairs.wo_at(k)), glm::vec3(0)) << k;
    }
    const std::vector<glm::vec3> any = eval_n(c.table, huge);
    for (std::size_t k = 0; k < huge.size(); ++k) {
      for (int i = 0; i < 3; ++i) ASSERT_GE(any[k][i], 0) << k;
      const glm::vec3 one = eval_one(c.table, huge.wi_at(k), huge.wo_at(k));
      for (int i = 0; i < 3; ++i) ASSERT_GE(one[i], 0) << k;
    }
  }
}

// Every length in any alignment; nothing is written behind the end.
TEST_P(BatchTableOn, EveryLength) {
  const Pairs pairs = all_pairs(310);
  for (const Case& c : made_cases()) {
    if (c.name != "asymmetric" && c.name != "MERL" && c.name != "RGL of 8 angles") continue;
    SCOPED_TRACE(c.name);
    const std::vector<glm::vec3> all = eval_n(c.table, pairs);
    for (const std::size_t count : {0, 1, 2, 3, 5, 15, 16, 17, 33, 127, 128, 129, 300})
      for (const std::size_t from : {0, 1, 3}) {
        std::vector<float> rgb[3];
        for (auto& channel : rgb) channel.assign(310, -7);
        const auto at = [&](const std::vector<float>& a) { return a.data() + from; };
        c.table.eval_n(count, {at(pairs.wi[0]), at(pairs.wi[1]), at(pairs.wi[2])},
                       {at(pairs.wo[0]), at(pairs.wo[1]), at(pairs.wo[2])},
                       {rgb[0].data() + from, rgb[1].data() + from, rgb[2].data() + from});
        for (std::size_t k = 0; k < 310; ++k)
          for (int i = 0; i < 3; ++i)
            ASSERT_EQ(rgb[i][k], k >= from && k < from + count ? all[k][i] : -7) << count << " from " << from;
      }
  }
}

}  // namespace
}  // namespace gonio
