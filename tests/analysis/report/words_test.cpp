#include "analysis/report/words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/compare/compare_report.h"
#include "analysis/detectability/detect_report.h"
#include "analysis/frontier/frontier_report.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

using testing::ElementsAre;

constexpr const char* kWords = R"({
  "texts": {"rule": "{{num}} of 3 & more"},
  "sections": {
    "a": {"title": "A of {{what}}",
          "paragraphs": ["{{#is_known}}Known.{{/is_known}}{{^is_known}}Unknown.{{/is_known}}",
                         "{{#num}}There are {{num}}.{{/num}}", "{{lines}}"]}},
  "tables": {
    "t": {"title": "T", "note": "N", "open": true,
          "columns": "range_m: Range{{#has_share}}; share_percent: Share{{/has_share}}"}},
  "charts": {
    "lines": {"title": "L", "caption": "C.", "x": ["Range", "m", "log"], "y": ["Share", "%"],
              "series": [["range_m", "share_percent", "shares"]]},
    "bars": {"title": "B", "caption": "C.", "y": ["{{what}}"],
             "series": [["name", "num"]], "style": "bars"},
    "groups": {"title": "G", "caption": "C.", "series": [["range_m", "num"]], "by": "name"}}
})";

TEST(Words, FillPlacesAndLeaveOutWhatIsNotSo) {
  const Section known = railcast::SectionOf(
      kWords, "a", {{"what", "b"}, {"is_known", true}, {"num", "2"}, {"lines", "one\n\ntwo"}});
  EXPECT_EQ(known.key, "a");
  EXPECT_EQ(known.title, "A of b");
  EXPECT_THAT(known.paragraphs, ElementsAre("Known.", "There are 2.", "one", "two"));
  const Section unknown = railcast::SectionOf(kWords, "a", {{"is_known", false}, {"num", ""}});
  EXPECT_THAT(unknown.paragraphs, ElementsAre("Unknown."));
}

// Formats escape what they must; words are plain text.
TEST(Words, KeepLettersThatHtmlEscapes) {
  EXPECT_EQ(SentencesOf(kWords, "rule", {{"num", "< 2"}}), "< 2 of 3 & more");
}

TEST(Words, GiveTablesTheirColumns) {
  const Table table = railcast::TableOf(kWords, "t", {{"has_share", true}});
  EXPECT_EQ(table.note, "N");
  EXPECT_TRUE(table.is_open);
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[1].unit, "%");
  EXPECT_EQ(railcast::TableOf(kWords, "t").columns.size(), 1U);
}

TEST(Words, GiveChartsTheirAxesAndSeries) {
  Table table = railcast::TableOf(kWords, "t", {{"has_share", true}});
  table.rows = {{1.0, 10.0}, {2.0, 20.0}};
  const Chart chart = ChartOfTable(kWords, "lines", table);
  EXPECT_EQ(chart.x.title, "Range");
  EXPECT_EQ(chart.x.unit, "m");
  EXPECT_TRUE(chart.x.is_log);
  EXPECT_FALSE(chart.y.is_log);
  ASSERT_EQ(chart.series.size(), 1U);
  EXPECT_EQ(chart.series[0].title, "shares");
  EXPECT_EQ(chart.series[0].points[1].y, 20.0);
  EXPECT_TRUE(railcast::ChartOf(kWords, "lines").series.empty());
}

TEST(Words, PutTextsBelowBarsAndNamesBesideLines) {
  const Table table{.columns = ColumnsOf("name: Name; range_m: Range; num: Number"),
                    .rows = {{std::string("a"), 1.0, 3.0}, {std::string("b"), 1.0, 4.0}}};
  const Chart bars = ChartOfTable(kWords, "bars", table, {{"what", "Number"}});
  EXPECT_EQ(bars.y.title, "Number");
  EXPECT_THAT(bars.x.categories, ElementsAre("a", "b"));
  EXPECT_EQ(bars.series[0].style, SeriesStyle::kBars);
  const Chart groups = ChartOfTable(kWords, "groups", table);
  ASSERT_EQ(groups.series.size(), 2U);
  EXPECT_EQ(groups.series[1].title, "b");
}

TEST(Words, AreThereForEveryChartAndTableOfTheProduct) {
  for (const char* const words :
       {kCompareWords, kDetectabilityWords, kFrontierWords, kStatsWords}) {
    const auto all = nlohmann::json::parse(words);
    for (const auto& [key, chart] : all.at("charts").items()) {
      EXPECT_FALSE(chart.value("title", "").empty()) << key;
      EXPECT_TRUE(chart.value("caption", "").ends_with('.') ||
                  chart.value("caption", "").ends_with("}}"))
          << key;
    }
    for (const auto& [key, table] : all.at("tables").items()) {
      EXPECT_FALSE(table.value("title", "").empty()) << key;
    }
  }
}

}  // namespace
}  // namespace railcast
