#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "analysis/report/formats.h"
#include "tests/analysis/report/made_report.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ReportMarkdown, BeginsWithTitleFactsAndHeadlines) {
  const std::string text = ReportMarkdown(MadeReport());
  EXPECT_TRUE(
      text.starts_with("# Statistics of \\<out/demo\\> \\& \"more\"\n\n- **Input**: out/demo, "
                       "a sequence\n"))
      << text.substr(0, 200);
  EXPECT_THAT(text, HasSubstr("- **Sensor**: VLP-16 \\<script\\>alert(1)\\</script\\>\n"));
  EXPECT_THAT(text, HasSubstr("- **Farthest point (m)**: 119.9\n"));
}

TEST(ReportMarkdown, ShowsOpenTablesAndLinksTheOthersToTheirFiles) {
  Report report{.sections = {{.key = "a", .title = "A", .tables = {MadeTable()}}}};
  EXPECT_THAT(ReportMarkdown(report),
              HasSubstr("\n[Dropout by range](csv/dropout_by_range.csv)\n"));
  report.sections[0].tables[0].is_open = true;
  const std::string text = ReportMarkdown(report);
  EXPECT_THAT(text, Not(HasSubstr("csv/")));
  EXPECT_THAT(text,
              HasSubstr("### Dropout by range\n\nBeams without a point \\<of all beams\\>.\n\n"
                        "| Cause | Beams | Range (m) | Dropout (%) |\n"
                        "| --- | --- | --- | --- |\n"
                        "| no \"surface\", \\<b\\>bold\\</b\\> | 1,234,567 | 12.5 |"));
}

TEST(ReportMarkdown, RefersToDrawingsBesideIt) {
  Report report{.sections = {{.key = "a",
                              .title = "A",
                              .charts = {MadeCharts().front()},
                              .pictures = {MadePicture()}}}};
  EXPECT_THAT(ReportMarkdown(report),
              HasSubstr("![What is \\<seen\\>](charts/seen.png)\n\nA line \"upwards\".\n\n"
                        "![Lines keep a gap where a figure is absent](charts/lines.png)\n"));
}

// A cell must not end its row or begin a column.
TEST(ReportMarkdown, KeepsACellInItsPlace) {
  Report report{.sections = {{.key = "a",
                              .title = "A",
                              .tables = {{.key = "t",
                                          .title = "T",
                                          .columns = {{"x", "X", ""}},
                                          .rows = {{std::string("a|b\nc `d` *e*")}},
                                          .is_open = true}}}}};
  EXPECT_THAT(ReportMarkdown(report), HasSubstr("| X |\n| --- |\n| a\\|b c \\`d\\` \\*e\\* |\n"));
}

}  // namespace
}  // namespace railcast
