#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "analysis/report/output.h"
#include "core/io/write_file.h"
#include "tests/analysis/report/made_report.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

// A script, inserted into a copy of the page, that reports how a browser renders it.
constexpr const char* kProbe = R"(<pre id="probe"></pre><script>
const box = e => { const b = e.getBoundingClientRect(); return [b.left, b.right, b.width, b.height]; };
const style = (selector, name) => getComputedStyle(document.querySelector(selector))[name];
document.getElementById("probe").textContent = "PROBE" + JSON.stringify({
  charts: [...document.querySelectorAll("svg.chart")].map(box),
  drawn: [...document.querySelectorAll("svg.chart")].map(s => s.getBBox().width),
  texts: [...document.querySelectorAll("svg.chart")].map(s => {
    const b = s.getBoundingClientRect();
    return [...s.querySelectorAll("text")].every(t => {
      const r = t.getBoundingClientRect();
      return r.left >= b.left - 1 && r.right <= b.right + 1 && r.top >= b.top - 1 && r.bottom <= b.bottom + 1;
    });
  }),
  pictures: [...document.images].map(i => i.naturalWidth),
  requests: performance.getEntriesByType("resource").map(r => r.name).filter(n => !n.startsWith("data:")),
  width: document.documentElement.clientWidth, needed: document.documentElement.scrollWidth,
  ground: style("body", "backgroundColor"), ink: style(".chart", "color"),
  series: style(".chart [stroke='#0072b2']", "stroke"),
}) + "PROBE";
</script></body>)";

class ReportInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "chromium is not installed";
    }
    here_ = folder_.Write("here", "").parent_path();
    testing::internal::CaptureStdout();
    EmitReport(MadeReport(), {here_, false}, "made");
    testing::internal::GetCapturedStdout();
  }

  // Runs Chromium headless and without network.
  Ended Browse(const std::string& options, const std::string& page) const {
    return RunCommand(
        "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
        "--disable-background-networking --disable-component-update --disable-sync "
        "--host-resolver-rules='MAP * ~NOTFOUND' --hide-scrollbars "
        "--user-data-dir='" +
        (here_ / "profile").string() + "' " + options + " 'file://" + (here_ / page).string() +
        "'");
  }

  // Result of the probe in a window of the given size.
  Json Probe(const std::string& options) const {
    std::string page = ReadFileWhole(here_ / "report.html");
    const std::size_t policy = page.find("<meta http-equiv");
    page.erase(policy, page.find('>', policy) + 1 - policy);
    page.replace(page.find("</body>"), 7, kProbe);
    WriteFileWhole(here_ / "probe.html", page);
    const Ended dumped = Browse("--dump-dom " + options, "probe.html");
    const std::size_t begin = dumped.said.find("PROBE{");
    const std::size_t end = dumped.said.find("}PROBE", begin);
    EXPECT_NE(end, std::string::npos) << dumped.said;
    return end == std::string::npos ? Json()
                                    : Json::parse(dumped.said.substr(begin + 5, end - begin - 4));
  }

  TemporaryFolder folder_;
  std::filesystem::path here_;
};

TEST_F(ReportInBrowser, SaysNothingToTheConsole) {
  const Ended shown = Browse("--enable-logging=stderr --dump-dom", "report.html");
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.said, HasSubstr("<svg"));
  // A request would violate the page's content security policy, which the console would report.
  EXPECT_THAT(shown.said, Not(HasSubstr("CONSOLE")));
}

TEST_F(ReportInBrowser, ShowsEveryChartInLightAndDark) {
  const Json light = Probe("--window-size=1400,1000");
  const Json dark = Probe("--window-size=1400,1000 --blink-settings=preferredColorScheme=0");
  for (const Json& page : {light, dark}) {
    ASSERT_EQ(page["charts"].size(), MadeCharts().size());
    for (std::size_t i = 0; i < MadeCharts().size(); ++i) {
      EXPECT_GT(page["charts"][i][2], 400) << i;
      EXPECT_GT(page["charts"][i][3], 100) << i;
      EXPECT_GT(page["drawn"][i], 300) << i;
      EXPECT_TRUE(page["texts"][i]) << "chart " << i << " cuts its text off";
    }
    EXPECT_EQ(page["pictures"], Json::array({200}));
    EXPECT_EQ(page["requests"], Json::array());
  }
  EXPECT_NE(light["ground"], dark["ground"]);
  EXPECT_NE(light["ink"], dark["ink"]);
  EXPECT_EQ(light["series"], "rgb(0, 114, 178)");
  EXPECT_NE(light["series"], dark["series"]);
}

TEST_F(ReportInBrowser, FitsANarrowWindow) {
  const Json page = Probe("--window-size=500,1000");
  EXPECT_LE(page["needed"], page["width"]);
}

TEST_F(ReportInBrowser, UnfoldsTablesOnPaper) {
  const auto pdf = here_ / "report.pdf";
  Browse("--no-pdf-header-footer --print-to-pdf='" + pdf.string() + "'", "report.html");
  ASSERT_TRUE(std::filesystem::exists(pdf));
  if (std::system("command -v pdftotext >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "pdftotext is not installed";
  }
  const Ended text = RunCommand("pdftotext -layout '" + pdf.string() + "' -");
  EXPECT_THAT(text.said, HasSubstr("it's rain & fog"));
  // This includes the last columns of tables that are wider than paper.
  EXPECT_THAT(text.said, HasSubstr("Column30"));
  EXPECT_THAT(text.said, HasSubstr("[299.0, 301.0]"));
}

}  // namespace
}  // namespace railcast
