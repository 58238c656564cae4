#include "analysis/report/formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <string>

#include "analysis/report/cell_text.h"
#include "tests/analysis/report/made_report.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

using PlainJson = nlohmann::json;

TEST(TableCsv, GivesEstimatesFourColumnsAndQuotesText) {
  EXPECT_EQ(TableCsv(MadeTable()),
            "cause,beams,range_m,dropout,dropout_low,dropout_high,dropout_samples\n"
            "\"no \"\"surface\"\", <b>bold</b>\",1234567,12.5,12.3412,11.9,12.7811,4512\n"
            "it's rain & fog,0,,,,,3\n"
            "no interval,7,-0.25,0.5,,,20\n");
}

TEST(TableCsv, KeepsItsColumnsWhereOnlySomeCellsAreEstimates) {
  const Table table = {"t",
                       "",
                       "",
                       {{"a", "", ""}, {"b", "", ""}},
                       {{Estimate{1, 0, 2, 12}, std::uint64_t{5}}, {std::string("x"), 2.0}}};
  EXPECT_EQ(TableCsv(table), "a,a_low,a_high,a_samples,b\n1,0,2,12,5\nx,,,,2\n");
}

TEST(TableCsv, IsAHeaderWhereThereAreNoRows) {
  EXPECT_EQ(TableCsv({"t", "", "", {{"a", "", ""}, {"b,c", "", ""}}, {}}), "a,\"b,c\"\n");
}

TEST(ReportJson, HoldsEveryKindOfCell) {
  const PlainJson json = PlainJson::parse(ReportJson(MadeReport()));
  EXPECT_EQ(json["facts"]["Frames"], "50");
  EXPECT_EQ(json["headlines"][0]["value"]["samples"], 4512);
  EXPECT_TRUE(json["headlines"][2]["value"]["value"].is_null());
  const PlainJson& rows = json["sections"][0]["tables"][0]["rows"];
  EXPECT_EQ(rows[0]["cause"], "no \"surface\", <b>bold</b>");
  EXPECT_EQ(rows[0]["beams"], 1234567);
  EXPECT_EQ(rows[0]["dropout"]["low"], 11.9);
  EXPECT_TRUE(rows[1]["range_m"].is_null());
  EXPECT_TRUE(rows[1]["dropout"]["value"].is_null());
  EXPECT_EQ(rows[1]["dropout"]["samples"], 3);
  EXPECT_TRUE(rows[2]["dropout"]["high"].is_null());
}

TEST(ReportJson, HoldsWhatChartsShow) {
  const PlainJson charts = PlainJson::parse(ReportJson(MadeReport()))["sections"][0]["charts"];
  EXPECT_EQ(charts[1]["y"]["unit"], "1/m²");
  EXPECT_EQ(charts[2]["x"]["categories"][2], "snow");
  EXPECT_TRUE(charts[0]["series"][0]["points"][4]["y"].is_null());
  EXPECT_EQ(charts[0]["series"][0]["points"][5]["x"], 6);
}

TEST(ReportJson, LeavesTheLayoutToThePage) {
  const std::string json = ReportJson(MadeReport());
  for (const char* const text : {"A <paragraph>.", "Bands are the 95 %", "What is <seen>"}) {
    EXPECT_THAT(json, Not(HasSubstr(text)));
  }
}

TEST(ReportJson, HasTheDetailsBesideTheReport) {
  const PlainJson json = PlainJson::parse(ReportJson(MadeReport(), R"({"seed": 7})"));
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["facts"]["Frames"], "50");
}

TEST(ReportFormats, CallABinByItsEnds) {
  Report report{
      .sections = {
          {"s", "S", {}, {}, {{"t", "T", "", {{"range_m", "Range", "m"}}, {{Span{2.5, 5}}}}}}}};
  EXPECT_EQ(TableCsv(report.sections[0].tables[0]), "range_m\n2.5 to 5\n");
  const PlainJson row = PlainJson::parse(ReportJson(report))["sections"][0]["tables"][0]["rows"][0];
  EXPECT_EQ(row["range_m"]["low"], 2.5);
  EXPECT_EQ(row["range_m"]["high"], 5.0);
  EXPECT_THAT(ReportText(report), HasSubstr("  Range (m)\n  2.5 to 5\n"));
  EXPECT_THAT(ReportPage(report, {}), HasSubstr("<th scope=\"row\">2.5 to 5</th>"));
}

TEST(ReportJson, KeepsTheOrderOfColumns) {
  const std::string json = ReportJson(MadeReport());
  EXPECT_LT(json.find("\"cause\": "), json.find("\"beams\": "));
}

TEST(ReportJson, SurvivesNamesThatAreNoUtf8) {
  Report report{.title = "out/\xff"};
  EXPECT_FALSE(PlainJson::parse(ReportJson(report))["title"].get<std::string>().empty());
}

TEST(ReportText, LinesUpColumns) {
  EXPECT_THAT(
      ReportText(MadeReport()),
      HasSubstr(
          "Dropout by range\n"
          "Beams without a point <of all beams>.\n"
          "  Cause                          Beams  Range (m)                      Dropout (%)\n"
          "  no \"surface\", <b>bold</b>  1,234,567       12.5  12.34 [11.90, 12.78], n = 4,512\n"
          "  it's rain & fog                    0          -               not enough (n = 3)\n"
          "  no interval                        7      -0.25    0.5,                n = 20\n"));
}

TEST(ReportText, BreaksParagraphsAtTheTerminalsWidth) {
  Report report;
  std::string paragraph;
  for (int i = 0; i < 60; ++i) paragraph += "word ";
  report.sections.push_back({"s", "Section", {paragraph}, {}, {}});
  const std::string text = ReportText(report);
  EXPECT_THAT(text, HasSubstr("word word\nword"));
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos;
       at = end + 1) {
    EXPECT_LE(end - at, 100U);
  }
}

TEST(ReportText, BreaksWideTablesIntoBlocksThatBeginAlike) {
  Table table = {"t", "Wide", "", {{"name", "Name", ""}}, {{std::string("row")}}};
  for (int i = 0; i < 20; ++i) {
    table.columns.push_back({"c", "A long title " + std::to_string(i), "m"});
    table.rows[0].emplace_back(std::uint64_t{7});
  }
  Report report;
  report.sections.push_back({"s", "Section", {}, {}, {table}});
  const std::string text = ReportText(report);
  EXPECT_THAT(text, HasSubstr("\n\n  Name  A long title "));
  EXPECT_THAT(text, HasSubstr("A long title 19 (m)\n"));
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos;
       at = end + 1) {
    EXPECT_LE(end - at, 160U);
  }
}

TEST(ReportText, SaysNanNowhere) {
  EXPECT_THAT(ReportText(MadeReport()), Not(HasSubstr("nan")));
}

TEST(HeadlinesText, GivesEachFigureItsLine) {
  EXPECT_THAT(HeadlinesText(MadeReport()),
              HasSubstr("  Temporal noise (mm)             not enough (n = 3)\n"));
}

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

std::string Line(const Cell& cell) {
  return LineOf(TextOf(cell));
}

TEST(CellText, EndsAnEstimateAtTheSecondDigitOfItsInterval) {
  EXPECT_EQ(Line(Estimate{12.3412, 11.9, 12.7811, 4512}), "12.34 [11.90, 12.78], n = 4,512");
  EXPECT_EQ(Line(Estimate{0.012345, 0.01234, 0.01235, 10}),
            "0.0123450 [0.0123400, 0.0123500], n = 10");
  EXPECT_EQ(Line(Estimate{123456.0, 121000.0, 126000.0, 10}), "123,500 [121,000, 126,000], n = 10");
  EXPECT_EQ(Line(Estimate{-2.98, -3.9, -2.1, 10}), "-2.98 [-3.90, -2.10], n = 10");
}

TEST(CellText, ShowsNoMoreThanSevenDigitsHoweverNarrowTheInterval) {
  EXPECT_EQ(Line(Estimate{1.0, 1.0 - 1e-12, 1.0 + 1e-12, 10}),
            "1.000000 [1.000000, 1.000000], n = 10");
}

TEST(CellText, TakesPowersOfTenForTinyAndHugeNumbers) {
  EXPECT_EQ(Line(Estimate{3.0663e-5, 2.7741e-5, 3.3585e-5, 12}),
            "3.07e-05 [2.77e-05, 3.36e-05], n = 12");
  EXPECT_EQ(Line(2.5e12), "2.500e+12");
}

TEST(CellText, CallsTooFewSamplesNotEnough) {
  EXPECT_EQ(Line(NotEnough(3)), "not enough (n = 3)");
  EXPECT_TRUE(TextOf(NotEnough(0)).is_absent);
}

TEST(CellText, LeavesOutAnIntervalThatIsNotKnown) {
  EXPECT_EQ(Line(Estimate{0.5, kNoFigure, kNoFigure, 20}), "0.5, n = 20");
  EXPECT_EQ(Line(Estimate{0.5, 0.2, std::numeric_limits<double>::infinity(), 20}), "0.5, n = 20");
}

TEST(CellText, ShowsAnIntervalWithoutWidth) {
  EXPECT_EQ(Line(Estimate{2.5, 2.5, 2.5, 20}), "2.5 [2.5, 2.5], n = 20");
}

TEST(CellText, WritesNumbersForPeople) {
  EXPECT_EQ(Line(std::uint64_t{1234567}), "1,234,567");
  EXPECT_EQ(Line(std::uint64_t{0}), "0");
  EXPECT_EQ(Line(119.94321), "119.9");
  EXPECT_EQ(Line(0.5), "0.5");
  EXPECT_EQ(Line(-1234.5), "-1,234");
  EXPECT_EQ(Line(123456.0), "123,456");
  EXPECT_EQ(Line(1.5e-7), "1.500e-07");
  EXPECT_EQ(Line(0.0), "0");
  EXPECT_EQ(Line(-0.0), "0");
}

TEST(CellText, NeverWritesNanAsANumber) {
  EXPECT_EQ(Line(kNoFigure), "-");
  EXPECT_TRUE(TextOf(kNoFigure).is_absent);
  EXPECT_EQ(Line(Estimate{kNoFigure, 1.0, 2.0, 50}), "not enough (n = 50)");
}

}  // namespace
}  // namespace railcast
