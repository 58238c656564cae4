#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/report/browser.h"

namespace railcast {
namespace {

using Json = nlohmann::json;

/// The reports of commands on two short recordings, in folders of the commands' names.
class CommandPages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const auto scenario =
        WriteScenario(*folder_, R"("weather": {"rain_rate_mmph": 40}, "fidelity": "surface",)");
    here_ = scenario.parent_path();
    const std::string sequence =
        RAILCAST_GENERATE " sequence " + scenario.string() + " --frames 12 ";
    Make(sequence + "--out " + (here_ / "a").string());
    Make(sequence + "--fidelity plausibility --out " + (here_ / "b").string());
    const std::string a = (here_ / "a").string(), b = (here_ / "b").string();
    Report("stats", "stats " + a);
    Report("compare", "compare " + a + " " + b);
    Report("ablation", "compare --frames 1 --ablate " + scenario.string());
    Report("fit", "fit " + a);
    Report("frontier", "frontier --frames 1 --rows surface,footprint " + scenario.string());
  }
  static void TearDownTestSuite() { delete folder_; }

  static constexpr std::array<const char*, 5> kNames = {"stats", "compare", "ablation", "fit",
                                                        "frontier"};

  static std::filesystem::path PageOf(const std::string& name) {
    return here_ / ("of_" + name) / "report.html";
  }

  static Json JsonOf(const std::string& name) {
    return Json::parse(ReadFileWhole(here_ / ("of_" + name) / (name + ".json")));
  }

 private:
  static void Make(const std::string& command) {
    const Ended run = RunCommand(command);
    ASSERT_EQ(run.status, 0) << run.said;
  }
  static void Report(const std::string& name, const std::string& arguments) {
    Make("SOURCE_DATE_EPOCH=1700000000 " RAILCAST_ANALYZE " " + arguments + " --out " +
         (here_ / ("of_" + name)).string());
  }

  inline static TemporaryFolder* folder_ = nullptr;
  inline static std::filesystem::path here_;
};

TEST_F(CommandPages, AreReadableInLightAndDark) {
  if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  // All pages have one template; this one has most in it.
  ExpectReadable(PageOf("stats"));
}

TEST_F(CommandPages, FitOnTenPagesOfPaper) {
  if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  if (!IsInstalled("pdftotext")) GTEST_SKIP() << "pdftotext is not installed";
  for (const char* const name : {"stats", "ablation"}) {
    SCOPED_TRACE(name);
    ExpectFitsOnPaper(PageOf(name));
  }
}

// The axes of all charts, the columns of all tables and the headlines.
void ForEachQuantity(const Json& report, const std::function<void(const Json&)>& visit) {
  for (const Json& headline : report.at("headlines")) visit(headline);
  for (const Json& section : report.at("sections")) {
    for (const Json& chart : section.at("charts")) {
      visit(chart.at("x"));
      visit(chart.at("y"));
    }
    for (const Json& table : section.at("tables")) {
      for (const Json& column : table.at("columns")) visit(column);
    }
  }
}

TEST_F(CommandPages, HaveOneUnitForAQuantity) {
  const std::set<std::string> units = {"",   "%", "m",   "mm",  "m²",  "1/m²", "1/sr",
                                       "ms", "s", "deg", "bit", "m/s", "x raw"};
  for (const char* const name : kNames) {
    SCOPED_TRACE(name);
    ForEachQuantity(JsonOf(name), [&](const Json& quantity) {
      const std::string title = quantity.at("title"), unit = quantity.at("unit");
      EXPECT_TRUE(units.contains(unit)) << title << " in " << unit;
      if (title.find("deviation") != std::string::npos || title.starts_with("Range error") ||
          title.starts_with("Bias")) {
        EXPECT_TRUE(unit == "mm" || unit == "m/s") << title << " in " << unit;
      }
      if (title == "Range" || title == "Distance" || title == "True range") {
        EXPECT_EQ(unit, "m") << title;
      }
    });
  }
}

}  // namespace
}  // namespace railcast
