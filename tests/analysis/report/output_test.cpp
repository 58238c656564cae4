#include "analysis/report/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "core/io/image/png.h"
#include "core/io/write_file.h"
#include "core/program/program.h"
#include "tests/analysis/report/made_report.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The report of a command "stats" with these arguments; nothing where they are a usage error.
std::optional<ReportOutput> Parsed(std::vector<std::string> arguments) {
  std::optional<ReportOutput> parsed;
  ReportOutput output;
  std::vector<std::string> sources;
  const auto add = [&](ProgramOptions& program, ProgramCommand& command) {
    program.RequireCommand();
    ProgramOptions stats = program.AddCommand("stats", "");
    stats.AddOption("SOURCE", sources);
    AddReportOptions(stats, output);
    command = [&](const std::string&) {
      parsed = output;
      return kExitSuccess;
    };
  };
  arguments.insert(arguments.begin(), {"program", "stats"});
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  testing::internal::CaptureStderr();
  const int status =
      ProgramMain({"program", "", "", add}, static_cast<int>(words.size()), words.data());
  static_cast<void>(testing::internal::GetCapturedStderr());
  EXPECT_EQ(status, parsed ? kExitSuccess : kExitUsage);
  return parsed;
}

TEST(ReportOptions, WantFilesOrText) {
  EXPECT_EQ(Parsed({"--out", "here", "a", "b"})->out, "here");
  EXPECT_FALSE(Parsed({"--out", "here"})->is_text);
  EXPECT_TRUE(Parsed({"--format", "text"})->is_text);
  EXPECT_FALSE(Parsed({"--format", "json"})->is_text);
  EXPECT_TRUE(Parsed({"--format", "json"})->is_json);
  EXPECT_TRUE(Parsed({"a", "--out", "here", "--format", "text"})->is_text);
  EXPECT_FALSE(Parsed({}));
  EXPECT_FALSE(Parsed({"--format", "html"}));
}

TEST(EmitReport, WritesEveryFile) {
  const TemporaryFolder folder;
  const auto out = folder.Write("here", "").parent_path() / "a new/folder";
  testing::internal::CaptureStdout();
  EmitReport(MadeReport(), {out, false}, "made");
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("12.34 [11.90, 12.78], n = 4,512"));
  EXPECT_THAT(said, HasSubstr("report.html, made.json, csv/ and charts/ in " + out.string()));
  EXPECT_THAT(said, Not(HasSubstr("Beams without")));
  EXPECT_THAT(ReadFileWhole(out / "report.html"), HasSubstr("<svg class=\"chart\""));
  EXPECT_THAT(ReadFileWhole(out / "csv/dropout_by_range.csv"), HasSubstr("dropout_low"));
  for (const Chart& chart : MadeCharts()) {
    EXPECT_TRUE(std::filesystem::exists(out / "charts" / (chart.key + ".svg"))) << chart.key;
    EXPECT_TRUE(std::filesystem::exists(out / "charts" / (chart.key + ".png"))) << chart.key;
  }
  // A red line from one corner to the other on a dark ground.
  const auto seen = DecodePngRgb(ReadFileWhole(out / "charts" / "seen.png"));
  EXPECT_EQ(seen.size.width_px, 200U);
  EXPECT_EQ(seen.size.height_px, 100U);
  std::size_t num_red = 0;
  for (std::size_t i = 0; i < seen.values.size(); i += 3) {
    num_red += seen.values[i] > 200 && seen.values[i + 1] < 60 ? 1 : 0;
  }
  EXPECT_GT(num_red, 50U);
  EXPECT_LT(num_red, 1000U);
}

TEST(EmitReport, PrintsAndWritesNoFiles) {
  testing::internal::CaptureStdout();
  EmitReport(MadeReport(), {{}, true}, "made");
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("Beams without"));
  EXPECT_THAT(said, Not(HasSubstr("made.json")));
}

TEST(EmitReportDeathTest, RefusesRowsThatAreTooShort) {
  Report report = MadeReport();
  report.sections[0].tables[0].rows[0].pop_back();
  EXPECT_DEATH(EmitReport(report, {{}, true}, "made"), "a row has a cell for every column");
}

TEST(EmitReportDeathTest, RefusesChartsThatDoNotSayWhatToSee) {
  Report report = MadeReport();
  report.sections[0].charts[0].caption = "";
  EXPECT_DEATH(EmitReport(report, {{}, true}, "made"), "a sentence that says what to see");
}

TEST(EmitReport, GivesBinsWithoutDataARow) {
  Report report;
  report.sections.push_back({"s",
                             "S",
                             {},
                             {},
                             {{"t",
                               "T",
                               "",
                               {{"label", "Label", ""}, {"range_m", "Range", "m"}, {"n", "N", ""}},
                               {{std::string("mast"), Span{0, 10}, std::uint64_t{3}},
                                {std::string("mast"), Span{10, 20}, std::uint64_t{4}},
                                {std::string("mast"), Span{40, 50}, std::uint64_t{5}},
                                {std::string("tree"), Span{60, 70}, std::uint64_t{6}}}}}});
  const TemporaryFolder folder;
  const auto here = folder.Write("here", "").parent_path() / "out";
  testing::internal::CaptureStdout();
  EmitReport(report, {here, false}, "made");
  testing::internal::GetCapturedStdout();
  EXPECT_EQ(ReadFileWhole(here / "csv/t.csv"),
            "label,range_m,n\nmast,0 to 10,3\nmast,10 to 20,4\nmast,20 to 40,\nmast,40 to "
            "50,5\ntree,60 to 70,6\n");
}

TEST(EmitReport, GivesTheSameBytesAgain) {
  const TemporaryFolder folder;
  const auto here = folder.Write("here", "").parent_path();
  testing::internal::CaptureStdout();
  EmitReport(MadeReport(), {here / "a", false}, "made");
  EmitReport(MadeReport(), {here / "b", false}, "made");
  testing::internal::GetCapturedStdout();
  for (const char* const name :
       {"report.html", "made.json", "charts/lines.png", "charts/seen.png"}) {
    EXPECT_EQ(ReadFileWhole(here / "a" / name), ReadFileWhole(here / "b" / name)) << name;
  }
}

}  // namespace
}  // namespace railcast
