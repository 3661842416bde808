#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/chromium.h"
#include "tools/page/write_page.h"

namespace gonio {
namespace {

using nlohmann::json;

constexpr int charts = 7;  // of a material

/// A report as the program makes it, with made-up figures: `rank` makes a method worse.
json method(const std::string& id, const std::string& chart, double ns, double rank) {
  json angles = json::array(), curves = json::array(), qmc = json::array(), mc = json::array();
  for (const double theta_i : {2, 10, 30, 50, 70, 80, 85})
    angles.push_back({{"theta_i_deg", theta_i},
                      {"relvar", 1e-3 * rank * (1 + theta_i / 90)},
                      {"max_weight", 1 + rank},
                      {"invalid_fraction", 0},
                      {"pdf_integral", 1},
                      {"albedo", {0.5, 0.5, 0.5}},
                      {"albedo_table", {0.5, 0.5, 0.5}},
                      {"chi2_p", 0.5}});
  for (const double theta_i : {10, 30, 50, 80}) {
    json pdf = json::array(), shares = json(std::vector<double>(120, 0.0));
    for (double t = -88; t <= 88; t += 2) pdf.push_back(std::cos(t * 3.14159 / 180) / 3.14159 * (1 + 0.02 * rank));
    shares[59] = 0.4, shares[60] = 0.6;
    curves.push_back({{"theta_i_deg", theta_i}, {"pdf", pdf}, {"weights", {{"zero", 0}, {"shares", shares}}}});
    if (chart != "none") curves.back()["grid"] = "M0,0l100,0l0,-100M200,0l10,10";
  }
  for (int k = 4; k <= 16; ++k)
    qmc.push_back(rank * std::pow(2.0, -0.9 * k)), mc.push_back(rank * std::pow(2.0, -0.5 * k));
  return {{"id", id},
          {"chart", chart},
          {"params", json::object()},
          {"bytes", static_cast<int>(16 * rank)},
          {"build_seconds", 0.1},
          {"ns", {{"sample", ns}, {"pdf", ns / 2}, {"eval", ns / 3}}},
          {"angles", angles},
          {"coherence", {{"stretch_p50", 1}, {"stretch_p99", 2}, {"tears", 0}}},
          {"qmc_slope", -0.9},
          {"mc_slope", -0.5},
          {"qmc_error", qmc},
          {"mc_error", mc},
          {"mean_relvar", 1e-3 * rank},
          {"efficiency", 1 / ns},
          {"curves", curves}};
}

json material(const std::string& name, double outgoing_rank) {
  json curves = json::array();
  for (const double theta_i : {10, 30, 50, 80}) {
    json theta_o = json::array(), table = json::array();
    for (double t = -88; t <= 88; t += 2) theta_o.push_back(t), table.push_back(std::cos(t * 3.14159 / 180) / 3.14159);
    curves.push_back({{"theta_i_deg", theta_i},
                      {"theta_o_deg", theta_o},
                      {"table", table},
                      {"disk", {{"sectors", 2}, {"rings", 2}, {"levels", {0, -50, -100, -20}}}}});
  }
  return {{"name", name},
          {"source", "a/" + name + ".bsdf"},
          {"format", "rgl"},
          {"source_bytes", 123456},
          {"fits", json::array()},
          {"curves", curves},
          {"verdict", "Sample <it> & be done."},
          {"methods",
           {method("cosine", "none", 100, 500), method("displacement", "outgoing", 200, outgoing_rank),
            method("displacement", "half", 150, 2)}}};
}

json example() {
  return {{"gonio_version", "1.2.3"},
          {"machine", {{"cpu", "a </script> cpu"}, {"compiler", "GCC"}, {"threads", 2}}},
          {"lights", json::array()},
          {"materials", {material("first", 3), material("second", 1)}}};
}

/// The page of example() in a browser; GONIO_REPORT_JSON shows that report instead in Pictures.
class PageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "needs chromium, which is not installed";
    directory_ = std::filesystem::temp_directory_path() / ("gonio_page_" + std::to_string(getpid()));
    std::filesystem::create_directories(directory_ / "profile");
    std::filesystem::create_directories(GONIO_PAGE_PICTURES);
    browser_ = std::make_unique<Chromium>(directory_ / "profile");
  }
  void TearDown() override {
    browser_.reset();
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }

  void open(const json& report, const std::string& ready = "document.querySelector('.chart svg')") {
    const auto file = directory_ / "report.html";
    std::ofstream out(file);
    write_page(out, report);
    out.close();
    address_ = "file://" + file.string();
    browser_->call("Page.navigate", {{"url", address_}});
    ASSERT_TRUE(browser_->wait_for("document.readyState === 'complete' && " + ready));
  }

  /// Everything on the page is drawn, whether in the window or not, as for a printer.
  void draw_all() { browser_->evaluate("dispatchEvent(new Event('beforeprint'))"); }

  int count(const std::string& selector) {
    return browser_->evaluate("document.querySelectorAll(" + json(selector).dump() + ").length").get<int>();
  }
  std::string text(const std::string& selector) {
    return browser_->evaluate("document.querySelector(" + json(selector).dump() + ").textContent").get<std::string>();
  }
  /// As a hand does: sets a control and says that it has changed.
  void choose(const std::string& selector, const std::string& value) {
    browser_->evaluate("(() => { const s = document.querySelector(" + json(selector).dump() + "); s.value = " +
                       json(value).dump() + "; s.dispatchEvent(new Event('change', {bubbles: true})); })()");
  }
  void click(const std::string& selector) {
    browser_->evaluate("document.querySelector(" + json(selector).dump() + ").click()");
  }

  void size(int width, int height, bool dark, bool print = false) {
    browser_->call("Emulation.setDeviceMetricsOverride",
                   {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", width < 500}});
    browser_->call("Emulation.setEmulatedMedia",
                   {{"media", print ? "print" : "screen"},
                    {"features", {{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}}}});
  }

  void expect_clean() {
    EXPECT_TRUE(browser_->complaints.empty()) << browser_->complaints.front();
    for (const std::string& request : browser_->requests)
      EXPECT_TRUE(request == address_ || request.rfind("data:", 0) == 0 || request.rfind("blob:", 0) == 0) << request;
  }

  std::filesystem::path directory_;
  std::string address_;
  std::unique_ptr<Chromium> browser_;
};

TEST_F(PageTest, ShowsEveryChartAndAsksForNothing) {
  open(example());
  EXPECT_EQ(text("#machine"), "gonio 1.2.3, a </script> cpu, GCC, 2 threads");
  EXPECT_EQ(text("#material-0 .verdict"), "Sample <it> & be done.");
  EXPECT_EQ(count("#overview-table tbody tr"), 2);
  // The best of each, by id and chart.
  EXPECT_EQ(text("#overview-table tbody tr:nth-child(1) td:nth-child(3)"), "displacement (half)");
  EXPECT_EQ(text("#material-0 tr.best td"), "displacement (half)");
  EXPECT_EQ(count("#methods input"), 3);
  EXPECT_LT(count(".chart svg"), 1 + 2 * charts) << "charts out of sight ought to wait";
  draw_all();
  EXPECT_EQ(count(".chart svg"), 1 + 2 * charts);
  EXPECT_EQ(count(".chart .empty"), 0);
  EXPECT_EQ(count(".material:not([hidden])"), 2);
  browser_->evaluate("dispatchEvent(new Event('afterprint'))");
  EXPECT_EQ(count(".material:not([hidden])"), 1);
  expect_clean();
}

/// The check of the other tests can fail.
TEST_F(PageTest, ComplaintsAndRequestsAreNoticed) {
  open(example());
  expect_clean();
  browser_->evaluate("console.error('found')");
  EXPECT_EQ(browser_->complaints.size(), 1u);
  browser_->evaluate(
      "new Promise(done => { const i = new Image(); i.onload = i.onerror = done; i.src = 'http://localhost:1/'; })");
  EXPECT_GT(browser_->complaints.size(), 1u) << "the page's policy ought to block requests";
}

TEST_F(PageTest, ControlsWork) {
  open(example());
  size(1200, 6000, false);
  ASSERT_TRUE(
      browser_->wait_for("document.querySelectorAll('#material-0 .chart svg').length === "
                         "document.querySelectorAll('#material-0 .chart').length"));
  const auto drawing = [&](const std::string& chart) {
    return browser_
        ->evaluate("document.querySelector('section:not([hidden]) [data-chart=" + chart + "] .chart').innerHTML")
        .get<std::string>();
  };
  const auto changes = [&](const std::string& chart, const std::string& before) {
    return browser_->wait_for("document.querySelector('section:not([hidden]) [data-chart=" + chart +
                              "] .chart').innerHTML !== " + json(before).dump());
  };
  for (const auto& [tool, chart, value] :
       std::vector<std::array<std::string, 3>>{{"time", "speed-accuracy", "pdf"},
                                               {"relvar", "speed-accuracy", "85"},
                                               {"radial", "goniometric", "linear"}}) {
    const std::string before = drawing(chart);
    choose("#material-0 [data-tool=" + tool + "]", value);
    EXPECT_TRUE(changes(chart, before)) << tool;
  }
  choose("#angle", "80");
  EXPECT_TRUE(
      browser_->wait_for("document.querySelector('#material-0 [data-chart=weights] h3').textContent.includes('80')"));

  const std::string with_all = drawing("relvar");
  EXPECT_NE(with_all.find("#808080"), std::string::npos);
  click("[data-method=cosine]");
  EXPECT_TRUE(changes("relvar", with_all));
  EXPECT_EQ(drawing("relvar").find("#808080"), std::string::npos);
  click("#all");
  EXPECT_TRUE(browser_->wait_for(
      "document.querySelector('#material-0 [data-chart=relvar] .chart').innerHTML.includes('#808080')"));

  click("#next");
  EXPECT_TRUE(browser_->wait_for("document.querySelectorAll('#material-1:not([hidden]) .chart svg').length === 7"));
  EXPECT_EQ(count("#material-0[hidden]"), 1);
  EXPECT_EQ(text("#material-1 h2"), "second");
  click("#overview-table a");
  EXPECT_TRUE(browser_->wait_for("!document.querySelector('#material-0').hidden"));
  expect_clean();
}

TEST_F(PageTest, ChartsAreSavedAsFiles) {
  open(example());
  size(1200, 6000, false);
  ASSERT_TRUE(
      browser_->wait_for("document.querySelectorAll('#material-0 .chart svg').length === "
                         "document.querySelectorAll('#material-0 .chart').length"));
  // A link that would be followed is kept instead.
  browser_->evaluate(
      "window.saved = []; HTMLAnchorElement.prototype.click = function () { saved.push([this.download, "
      "this.href.slice(0, 14)]); }");
  const int buttons = count("#material-0 [data-save]");
  EXPECT_EQ(buttons, 2 * charts);
  browser_->evaluate("document.querySelectorAll('#material-0 [data-save]').forEach(b => b.click())");
  ASSERT_TRUE(browser_->wait_for("saved.length === " + std::to_string(buttons)));
  const json saved = browser_->evaluate("saved");
  for (const auto& [name, begin] : saved.get<std::vector<std::pair<std::string, std::string>>>()) {
    const bool png = name.substr(name.size() - 4) == ".png";
    EXPECT_EQ(name.rfind("first_", 0), 0u) << name;
    EXPECT_EQ(begin.rfind(png ? "data:image/png" : "blob:", 0), 0u) << name << ' ' << begin;
  }
  expect_clean();
}

TEST_F(PageTest, EveryControlIsReachedByKeyboard) {
  open(example());
  json seen = json::array();
  for (int k = 0; k < 12; ++k) {
    for (const char* type : {"rawKeyDown", "keyUp"})
      browser_->call("Input.dispatchKeyEvent",
                     {{"type", type}, {"key", "Tab"}, {"code", "Tab"}, {"windowsVirtualKeyCode", 9}});
    seen.push_back(
        browser_->evaluate("[document.activeElement.tagName + '#' + document.activeElement.id, "
                           "getComputedStyle(document.activeElement).outlineStyle]"));
  }
  const std::string order = seen.dump();
  for (const char* id : {"SELECT#material", "BUTTON#next", "SELECT#angle", "SUMMARY#", "INPUT#"})
    EXPECT_NE(order.find(id), std::string::npos) << id << " in " << order;
  for (const auto& stop : seen) EXPECT_EQ(stop[1], "solid") << stop;
}

TEST_F(PageTest, ReportsWithoutCurvesOrMaterialsAreShown) {
  json old = example();
  for (json& m : old["materials"]) {
    for (const char* key : {"curves", "verdict"}) m.erase(key);
    for (json& q : m["methods"])
      for (const char* key : {"curves", "qmc_error", "mc_error", "mean_relvar", "efficiency"}) q.erase(key);
  }
  open(old);
  draw_all();
  EXPECT_EQ(count("#material-0 .chart svg"), 3);
  EXPECT_EQ(count("#material-0 .chart .empty"), charts - 3);

  json lights = example();
  lights["materials"] = json::array();
  lights["lights"] = {{{"name", "lamp"},
                       {"source", "lamp.ies"},
                       {"format", "ies"},
                       {"flux", 1000},
                       {"methods", {{{"id", "texels"}, {"flux", 1001}, {"relvar", 0.1}, {"ns", {{"sample", 30}}}}}}}};
  open(lights, "document.querySelector('#lights td')");
  EXPECT_EQ(text("#lights h2"), "lamp");
  EXPECT_EQ(text("#lights tbody tr"), "texels10010.130");
  EXPECT_EQ(count("#controls:not([hidden])"), 0);
  expect_clean();
}

/// What a report need not hold: an error for each size of stack, fits, times of batches, provenance, the
/// study of textbook formulas.
json full_example() {
  json report = example();
  report["command"] = "gonio report 'a b.bsdf' -o <out>";
  report["seeds"] = {{"measures", 1}, {"times", 7}};
  json& first = report["materials"][0];
  first["sha256"] = "0123abcd";
  for (json& m : first["methods"])
    if (m["chart"] != "none") m["ns"]["sample_batch"] = 31.25;
  for (const int kib : {1, 4, 16, 64})
    first["front"].push_back({{"id", "compact"},
                              {"bytes", 1024 * kib},
                              {"ns", 300},
                              {"relvar", 0.1 / kib},
                              {"eval_error", 0.2 / kib},
                              {"chosen", kib == 16}});
  first["front"].push_back(
      {{"id", "lobes1"}, {"bytes", 2000}, {"ns", 250}, {"relvar", 0.02}, {"eval_error", 0.3}, {"chosen", false}});
  json curves = json::array();
  for (const json& c : first["curves"]) curves.push_back({{"theta_i_deg", c["theta_i_deg"]}, {"model", c["table"]}});
  const json errors = {{"cosine_rms", 1}, {"log_rms", 1}, {"relative_l1", 1}, {"albedo", 1}, {"delta_e_2000", 1}};
  first["fits"] = {{{"model", "lambert:albedo=0.5"},
                    {"errors", {{"inside_cutoff", errors}, {"beyond_cutoff", errors}}},
                    {"curves", curves}}};
  first["methods"].push_back(method("lobes1", "none", 120, 30));
  first["methods"].push_back(method("blend", "half", 180, 1.5));
  first["methods"].back()["params"]["default"] = true;
  report["materials"][1]["methods"].push_back(method("blend", "half", 180, 1.5));  // of a stack file
  for (const std::string variant : {"cardan", "gonio-diagram"})
    for (const std::string input : {"constant", "spike"}) {
      const bool fails = variant == "cardan" && input == "spike";
      report["stability"]["rows"].push_back({{"variant", variant},
                                             {"input", input},
                                             {"error_of", "mass"},
                                             {"why", "it <cancels>"},
                                             {"max_error", fails ? 5000 : 2},
                                             {"max_error_bound", 16},
                                             {"bias", fails ? -0.25 : 0.001},
                                             {"bias_standard_error", 0.001},
                                             {"chi2_p", 0.5},
                                             {"fails", fails},
                                             {"failed", fails ? json({"max_error", "bias"}) : json::array()}});
    }
  return report;
}

TEST_F(PageTest, ShowsWhatMemoryBuysAndTheFitsThemselves) {
  open(full_example());
  draw_all();
  EXPECT_EQ(count("#material-0 .chart svg"), charts + 1);
  EXPECT_EQ(count("#material-1 [data-chart=front]"), 0) << "a chart without data";
  // Four sizes and the lobes on each of two panels.
  EXPECT_EQ(count("[data-chart=front] .mark-symbol.role-mark.points path"), 5 + 5);
  EXPECT_EQ(text("[data-chart=front] .keys"), "compactlobes1");
  EXPECT_NE(text("[data-chart=front] .chart").find("kept"), std::string::npos);

  EXPECT_NE(text("#material-0 [data-chart=goniometric] .keys").find("fit of 1"), std::string::npos);
  EXPECT_EQ(text("#material-1 [data-chart=goniometric] .keys").find("fit"), std::string::npos);
  browser_->evaluate("dispatchEvent(new Event('afterprint'))");
  size(1200, 9000, false);
  choose("#material-0 [data-tool=diagram]", "pdf");
  EXPECT_TRUE(browser_->wait_for(
      "document.querySelector('#material-0 [data-chart=goniometric] .keys').textContent.includes('lobes1')"));
  EXPECT_EQ(text("#material-0 [data-chart=goniometric] .keys").find("fit of 1"), std::string::npos);

  EXPECT_NE(text("#material-0 .methods thead").find("sample, batch, ns"), std::string::npos);
  EXPECT_EQ(text("#material-1 .methods thead").find("batch"), std::string::npos);
  // What the library does by default says so, in the legend too.
  EXPECT_EQ(count("#material-0 .methods abbr"), 1);
  EXPECT_EQ(text("#material-0 .methods tr:has(abbr) td"), "blend (half) default");
  EXPECT_EQ(count("#material-1 .methods abbr"), 0);
  EXPECT_EQ(text("#methods label:has(abbr)"), "blend (half) default");
  EXPECT_NE(text("#provenance").find("gonio report 'a b.bsdf' -o <out>"), std::string::npos);
  EXPECT_NE(text("#provenance").find("SHA-256 0123abcd"), std::string::npos);
  // Whose bytes they are.
  EXPECT_NE(text("#provenance").find("121 KiB on disk"), std::string::npos);
  EXPECT_NE(text("#material-0 .provenance").find("file of 121 KiB on disk"), std::string::npos);
  EXPECT_NE(text("#material-0 .methods thead").find("in memory"), std::string::npos);
  EXPECT_NE(text("#overview-table thead").find("in memory"), std::string::npos);
  expect_clean();
}

TEST_F(PageTest, ShowsWhereMethodsFail) {
  open(full_example());
  EXPECT_NE(text("#stability > p").find("1 of 1 textbook formulas fail somewhere, none of the library's 1."),
            std::string::npos);
  EXPECT_EQ(text("#stability tbody tr"), "cardan1 of 25000 of 16-25 %0.5it <cancels>");
  EXPECT_EQ(count("#stability .matrix td"), 4);
  EXPECT_EQ(text("#stability .matrix td.fails"), "E Bfails");
  EXPECT_EQ(count("#variant-rows tbody strong"), 1);
  choose("#variant", "gonio-diagram");
  EXPECT_EQ(count("#variant-rows tbody strong"), 0);
  EXPECT_EQ(count("#variant-rows tbody tr"), 2);
  expect_clean();
}

/// A chart that leaves the page names its series.
TEST_F(PageTest, SavedChartsHaveAKey) {
  open(full_example());
  size(1200, 9000, false);
  ASSERT_TRUE(
      browser_->wait_for("document.querySelectorAll('#material-0 .chart svg').length === "
                         "document.querySelectorAll('#material-0 .chart').length"));
  EXPECT_EQ(count("#material-0 .mark-group.role-legend"), 0);
  browser_->evaluate(
      "window.texts = []; HTMLAnchorElement.prototype.click = function () {};"
      "URL.createObjectURL = blob => { blob.text().then(text => texts.push(text)); return 'blob:'; }");
  for (const std::string chart : {"relvar", "weights", "goniometric", "front"}) {
    browser_->evaluate("texts.length = 0; document.querySelector('#material-0 [data-chart=" + chart +
                       "] [data-save=svg]').click()");
    ASSERT_TRUE(browser_->wait_for("texts.length === 1")) << chart;
    const std::string svg = browser_->evaluate("texts[0]");
    EXPECT_NE(svg.find("role-legend"), std::string::npos) << chart;
    EXPECT_NE(svg.find(chart == "front" ? "compact" : "displacement (half)"), std::string::npos) << chart;
    std::ofstream(std::filesystem::path(GONIO_PAGE_PICTURES) / ("saved_" + chart + ".svg")) << svg;
  }
}

/// Pictures for people, in the folder GONIO_PAGE_PICTURES. Nothing may stick out of a phone.
TEST_F(PageTest, Pictures) {
  json report = full_example();
  if (const char* path = std::getenv("GONIO_REPORT_JSON")) {
    std::ifstream in(path);
    report = json::parse(in);
  }
  const std::filesystem::path folder = GONIO_PAGE_PICTURES;
  struct Picture {
    const char* name;
    int width;
    bool dark, print;
  };
  for (const Picture& picture : {Picture{"light", 1280, false, false},
                                 {"dark", 1280, true, false},
                                 {"phone", 390, false, false},
                                 {"phone_dark", 390, true, false},
                                 {"print", 740, false, true}}) {
    size(picture.width, 900, picture.dark, picture.print);
    open(report);
    if (picture.print) draw_all();
    size(picture.width, 9000, picture.dark, picture.print);
    ASSERT_TRUE(
        browser_->wait_for("document.querySelectorAll('#material-0 .chart svg').length === "
                           "document.querySelectorAll('#material-0 .chart').length"));
    EXPECT_LE(browser_->evaluate("document.documentElement.scrollWidth").get<int>(), picture.width) << picture.name;
    const int height = browser_->evaluate("Math.ceil(document.documentElement.getBoundingClientRect().height)");
    const std::string shown = browser_->evaluate("getComputedStyle(document.body).backgroundColor");
    EXPECT_EQ(shown, picture.dark ? "rgb(20, 23, 26)" : "rgb(255, 255, 255)");
    std::ofstream out(folder / (std::string("report_") + picture.name + ".png"), std::ios::binary);
    out << browser_->screenshot(picture.width, height);
    EXPECT_TRUE(out.flush());
  }
  expect_clean();
}

}  // namespace
}  // namespace gonio
