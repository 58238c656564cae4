#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/extras/dossier/dossier_report.h"
#include "analysis/report/formats.h"
#include "analysis/report/output.h"
#include "tests/analysis/report/browser.h"
#include "tests/analysis/report/made_report.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;
using PlainJson = nlohmann::json;

class ReportInBrowser : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryDirectory();
    testing::internal::CaptureStdout();
    EmitReport(MadeReport(), {folder_->path(), false}, "made");
    testing::internal::GetCapturedStdout();
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override {
    if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  }

  [[nodiscard]] static std::filesystem::path page() { return folder_->path() / "report.html"; }
  /// The page on paper, printed when it is first asked for.
  [[nodiscard]] static std::string pdf() {
    static const std::filesystem::path file = Printed(page());
    return file.string();
  }

  static inline TemporaryDirectory* folder_ = nullptr;
};

TEST_F(ReportInBrowser, SaysNothingToTheConsole) {
  const Ended shown = Browse("--enable-logging=stderr --dump-dom", page());
  EXPECT_EQ(shown.status, 0);
  EXPECT_THAT(shown.said, HasSubstr("<svg"));
  // A request would violate the page's content security policy, which the console would report.
  EXPECT_THAT(shown.said, Not(HasSubstr("CONSOLE")));
}

TEST_F(ReportInBrowser, ShowsEveryChartInLightAndDark) {
  const PlainJson light = Probe("--window-size=1400,1000", page());
  const PlainJson dark = Probe("--window-size=1400,1000" + std::string(kDarkScheme), page());
  for (const PlainJson& look : {light, dark}) {
    ASSERT_EQ(look["charts"].size(), MadeCharts().size());
    for (std::size_t i = 0; i < MadeCharts().size(); ++i) {
      EXPECT_GT(look["charts"][i][2], 400) << i;
      EXPECT_GT(look["charts"][i][3], 100) << i;
      EXPECT_GT(look["drawn"][i], 300) << i;
      EXPECT_TRUE(look["texts"][i]) << "chart " << i << " cuts its text off";
    }
    EXPECT_EQ(look["pictures"], PlainJson::array({200}));
    EXPECT_EQ(look["requests"], PlainJson::array());
  }
  EXPECT_NE(light["ground"], dark["ground"]);
  EXPECT_NE(light["ink"], dark["ink"]);
  EXPECT_EQ(light["series"], "rgb(0, 114, 178)");
  EXPECT_NE(light["series"], dark["series"]);
}

TEST_F(ReportInBrowser, FitsEveryWidth) {
  ExpectFitWidths({page()});
}

TEST_F(ReportInBrowser, IsReadableInLightAndDark) {
  ExpectReadable(page());
}

TEST_F(ReportInBrowser, UnfoldsTablesOnPaper) {
  if (!IsInstalled("pdftotext")) GTEST_SKIP() << "pdftotext is not installed";
  const Ended text = RunCommand("pdftotext -layout '" + pdf() + "' -");
  EXPECT_THAT(text.said, HasSubstr("it's rain & fog"));
  // This includes the last columns of tables that are wider than paper.
  EXPECT_THAT(text.said, HasSubstr("Column30"));
  EXPECT_THAT(text.said, HasSubstr("[299.0, 301.0]"));
}

TEST_F(ReportInBrowser, FitsOnTenPagesOfPaper) {
  if (!IsInstalled("pdftotext")) GTEST_SKIP() << "pdftotext is not installed";
  ExpectFitsOnPaper(pdf(), 10, 12.0);
}

// Figures of all lengths that a report writes, in cards as narrow as they become.
TEST_F(ReportInBrowser, KeepsEveryFigureOfACardOnOneLine) {
  Report report{.title = "Figures"};
  for (const double value : {8.0, 98.76, -999.9, 1234567.0, -123.4567, 0.0003456, -123456789.0}) {
    for (const double power : {1.0, 1e-9, 1e9}) {
      const double figure = value * power;
      const double half_width = 1e-6 * std::abs(figure);
      report.headlines.push_back({"Without an interval", "points", figure});
      report.headlines.push_back({"With a narrow one", "m",
                                  Estimate{figure, figure - half_width, figure + half_width, 99}});
    }
  }
  const TemporaryDirectory folder;
  const auto file = folder.path() / "cards.html";
  const std::string page = ReportPage(report, {});
  WriteFileWhole(file, page);
  constexpr const char* kLines = R"(<pre id="probe"></pre><script>
const lines = [...document.querySelectorAll(".figure")].filter(e => {
  const card = e.closest(".card").getBoundingClientRect(), own = e.getBoundingClientRect();
  const digits = document.createRange();
  digits.selectNodeContents(e);
  const height = parseFloat(getComputedStyle(e).lineHeight);
  return own.right > card.right - 8 || digits.getBoundingClientRect().height > 1.6 * height;
}).map(e => e.textContent);
document.getElementById("probe").textContent = "PROBE" + JSON.stringify({lines: lines}) + "PROBE";
</script></body>)";
  const auto copy = folder.path() / "probe.html";
  WriteFileWhole(copy, WithScript(file, kLines));
  for (const char* const width : {"1300", "1000", "700", "500"}) {
    const std::string window = "--window-size=" + std::string(width) + ",1000";
    EXPECT_EQ(ProbeOf(window, copy)["lines"], PlainJson::array()) << width;
  }
}

// As the dossier is.
TEST_F(ReportInBrowser, IsPrintedByWeasyprintWithEveryColumn) {
  if (!IsInstalled("pdftotext")) GTEST_SKIP() << "pdftotext is not installed";
  if (!IsInstalled("weasyprint")) GTEST_SKIP() << "weasyprint is not installed";
  const auto made = folder_->path() / "made.pdf";
  PrintPage(page(), made);
  ExpectFitsOnPaper(made, 20, 14.0);
  EXPECT_THAT(RunCommand("pdftotext -layout '" + made.string() + "' -").said,
              HasSubstr("Column30"));
}

}  // namespace
}  // namespace railcast
