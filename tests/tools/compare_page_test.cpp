// The page of `gonio compare` in a headless browser; skipped without one.

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/chromium.h"
#include "tests/support/table_files.h"
#include "tools/page/write_page.h"

namespace gonio {
namespace {

using nlohmann::json;

/// The smallest PNG: one pixel.
constexpr const char* pixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

json run(const std::string& method, const std::string& strategy, double error) {
  json curve = json::array();
  for (int n = 1; n <= 64; n *= 2)
    curve.push_back(
        {{"samples", n}, {"seconds", 0.01 * n}, {"relmse", error / n}, {"standard_error", 0.1 * error / n}});
  return {{"method", method},
          {"strategy", strategy},
          {"samples", 64},
          {"seconds", 0.64},
          {"microseconds_per_sample", 3.5},
          {"cost_ratio", 1.1},
          {"build_seconds", 1.2},
          {"relmse", error / 64},
          {"standard_error", 0.1 * error / 64},
          {"ratio", error},
          {"relmse_at_equal_samples", error / 64},
          {"standard_error_at_equal_samples", 0.1 * error / 64},
          {"ratio_at_equal_samples", nullptr},
          {"convergence", curve},
          {"picture", pixel},
          {"difference", pixel}};
}

TEST(ComparePage, ShowsTablesCurvesAndPicturesAndAsksForNothing) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "needs chromium, which is not installed";
  const json comparison{
      {"gonio_version", "1.2.3"},
      {"machine", {{"cpu", "a </script> cpu"}, {"compiler", "GCC"}, {"threads", 2}}},
      {"scene", "satin <it>"},
      {"width", 64},
      {"height", 64},
      {"pixels", 1000},
      {"seconds", 0.64},
      {"seed", 1},
      {"equal_samples", 64},
      {"reference", {{"samples", 1024}, {"seconds", 10}, {"relmse", 1e-4}, {"picture", pixel}}},
      {"runs",
       {run("default", "mis", 1), run("cosine", "mis", 20), run("default", "bsdf", 2), run("cosine", "bsdf", 50)}}};
  const test::TemporaryFolder folder;
  {
    std::ofstream out(folder / "compare.html");
    write_compare_page(out, comparison);
  }
  const std::string address = "file://" + (folder / "compare.html").string();
  std::filesystem::create_directories(folder / "profile");
  Chromium browser(folder / "profile");
  browser.call("Page.navigate", {{"url", address}});
  ASSERT_TRUE(
      browser.wait_for("document.readyState === 'complete' && document.querySelectorAll('.chart svg').length === 4"));
  EXPECT_EQ(browser.evaluate("document.getElementById('scene').textContent"), "satin <it>");
  EXPECT_EQ(browser.evaluate("document.querySelectorAll('tbody tr').length"), 4);
  EXPECT_EQ(
      browser.evaluate("[...document.querySelectorAll('tr.best td:first-child')].map(td => td.textContent).join()"),
      "default,default");
  EXPECT_EQ(browser.evaluate("[...document.images].filter(i => i.naturalWidth === 1).length"), 10);
  EXPECT_TRUE(browser.complaints.empty()) << browser.complaints.front();
  for (const std::string& request : browser.requests)
    EXPECT_TRUE(request == address || request.rfind("data:", 0) == 0) << request;
}

}  // namespace
}  // namespace gonio
