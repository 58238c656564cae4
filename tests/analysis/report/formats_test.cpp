#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/report/formats.h"
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

}  // namespace
}  // namespace railcast
