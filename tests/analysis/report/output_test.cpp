#include "analysis/report/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/provenance.h"
#include "core/io/image/png.h"
#include "core/io/write_file.h"
#include "core/program/program.h"
#include "tests/analysis/report/made_report.h"
#include "tests/core/io/message_of.h"
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

TEST(EmitReport, RemovesTheFilesOfTheReportThatItReplacesAndNoOthers) {
  const TemporaryFolder folder;
  const auto out = folder.Write("here", "").parent_path() / "out";
  Report report = MadeReport();
  testing::internal::CaptureStdout();
  EmitReport(report, {out, false}, "made");
  WriteFileWhole(out / "csv/mine.csv", "mine");
  for (Section& section : report.sections) {
    section.tables.clear();
    section.charts.clear();
    section.pictures.clear();
  }
  EmitReport(report, {out, false}, "other");
  EXPECT_TRUE(std::filesystem::exists(out / "csv/dropout_by_range.csv"));
  EmitReport(report, {out, false}, "made");
  testing::internal::GetCapturedStdout();
  EXPECT_FALSE(std::filesystem::exists(out / "csv/dropout_by_range.csv"));
  EXPECT_EQ(ReadFileWhole(out / "csv/mine.csv"), "mine");
  EXPECT_TRUE(std::filesystem::is_empty(out / "charts"));
}

TEST(EmitReport, ReplacesAFileOfItsNameThatIsNoReport) {
  for (const std::string text : {"", "{", "[]", R"({"sections": [{"tables": [{"key": 1}]}]})"}) {
    const TemporaryFolder folder;
    const auto out = folder.Write("made.json", text).parent_path();
    testing::internal::CaptureStdout();
    EmitReport({.title = "Empty"}, {out, false}, "made");
    testing::internal::GetCapturedStdout();
    EXPECT_THAT(ReadFileWhole(out / "made.json"), HasSubstr("Empty"));
  }
}

TEST(ReportFolder, IsCheckedAndNotLeft) {
  const TemporaryFolder folder;
  const auto file = folder.Write("here", "");
  CheckReportFolder({}, {});
  CheckReportFolder(file.parent_path() / "out", {});
  EXPECT_FALSE(std::filesystem::exists(file.parent_path() / "out"));
  EXPECT_EQ(MessageOf([&] { CheckReportFolder(file, {}); }), file.string() + ": not a directory");
}

TEST(ReportFolder, HoldsNoLinksInPlaceOfTheReport) {
  for (const std::string name :
       {"report.html", "stats.json", "csv", "charts", "csv/a.csv", "charts/a.svg"}) {
    const TemporaryFolder folder;
    const auto out = folder.Write("mine", "mine").parent_path();
    std::filesystem::create_symlink(out / "mine", out / "of_others");
    CheckReportFolder(out, {"stats.json"});
    std::filesystem::create_directories((out / name).parent_path());
    std::filesystem::create_symlink(out / "nothing", out / name);
    EXPECT_EQ(MessageOf([&] { CheckReportFolder(out, {"stats.json"}); }),
              (out / name).string() + ": must not be a symbolic link");
    EXPECT_FALSE(std::filesystem::exists(out / "nothing"));
  }
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

// Changing the environment is safe, since the tests of one program run one after another.
class ReportDate : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(::setenv("SOURCE_DATE_EPOCH", "1700000000", 1), 0); }
  void TearDown() override { ::unsetenv("SOURCE_DATE_EPOCH"); }
};

TEST_F(ReportDate, IsThatOfTheEnvironment) {
  const Facts expected = {{"Version", "railcast 0.1.0"}, {"Date", "2023-11-14 22:13 UTC"}};
  EXPECT_EQ(MakerFacts("0.1.0"), expected);
}

TEST_F(ReportDate, RefusesWhatIsNoTime) {
  for (const std::string text : {"", "now", "-1", "1e9", "253402300800"}) {
    ::setenv("SOURCE_DATE_EPOCH", text.c_str(), 1);
    EXPECT_EQ(MessageOf([] { (void)MakerFacts("0.1.0"); }),
              "SOURCE_DATE_EPOCH: must be whole seconds from 0 to 253402300799 (got " + text + ")");
  }
}

RecordingInfo InfoOf(const std::string& data_hash) {
  RecordingInfo info;
  info.origin = {.version = "0.1.0+14c4fad0a1b2",
                 .embree = "3.13.5",
                 .isa = "avx2",
                 .scenario_hash = "5ce0a410",
                 .data_hash = data_hash,
                 .is_finished = true,
                 .has_commands = false};
  info.scenario.emplace();
  return info;
}

TEST(OriginFacts, SayOnceWhatSourcesHaveInCommon) {
  const Facts expected = {{"Data hash", "da7a1; da7a2"},
                          {"Scenario hash", "5ce0a410"},
                          {"Weather", "clear"},
                          {"Generated by", "railcast 0.1.0+14c4fad0a1b2, Embree 3.13.5, avx2"}};
  EXPECT_EQ(OriginFacts({InfoOf("da7a1"), RecordingInfo{}, InfoOf("da7a2")}), expected);
  EXPECT_EQ(OriginFacts({RecordingInfo{}}), Facts{});
}

TEST(OriginFacts, SayWhatIsNotKnown) {
  RecordingInfo older = InfoOf("");
  older.origin->embree.clear();
  older.origin->isa.clear();
  older.origin->has_commands = true;
  older.scenario->weather.rain_rate_mmph = 12.0;
  const Facts expected = {
      {"Data hash", "not recorded"},
      {"Scenario hash", "5ce0a410"},
      {"Weather", "rain 12 mm/h, wetness 1, as far as commands did not change it"},
      {"Generated by", "railcast 0.1.0+14c4fad0a1b2"}};
  EXPECT_EQ(OriginFacts({older}), expected);
  older.origin->is_finished = false;
  EXPECT_EQ(OriginFacts({older}).front().second, "none yet: the run is unfinished");
}

TEST(WeatherText, NamesWhatDiffersFromAClearDryNight) {
  WeatherSpec weather;
  weather.visibility_m = 200.0;
  weather.snow_rate_mmph = 2.5;
  weather.snow_type = SnowType::kWet;
  weather.wetness = 1.0;
  weather.snow_cover = 0.5;
  weather.puddle_share = 0.1;
  weather.sun.illuminance_klx = 40.0;
  EXPECT_EQ(
      WeatherText(weather),
      "visibility 200 m, wet snow 2.5 mm/h, wetness 1, snow cover 0.5, puddles 0.1, sun 40 klx");
  weather = {};
  weather.fog_density_per_m = 0.01;
  EXPECT_EQ(WeatherText(weather), "fog 0.01 per m");
}

}  // namespace
}  // namespace railcast
