#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/core/io/damage.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

const std::string kCaptures = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/";

std::filesystem::path MakeSequence(const TemporaryFolder& folder, const std::string& options) {
  const auto scenario = WriteScenario(folder, R"("weather": {"rain_rate_mmph": 40},)");
  const auto out = scenario.parent_path() / "sequence";
  const Ended run = RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " +
                               out.string() + " --frames 11 " + options);
  if (run.status != 0) throw std::runtime_error(run.said);
  return out;
}

const Json& JsonTableOf(const Json& stats, const std::string& key) {
  for (const Json& section : stats.at("sections")) {
    for (const Json& table : section.at("tables")) {
      if (table.at("key") == key) return table;
    }
  }
  throw std::out_of_range(key);
}

TEST(StatsCommand, CountsTheOutcomesThatTheSequenceCounted) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto out = sequence.parent_path() / "out";
  const Ended run = Analyze("stats " + sequence.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  std::map<std::string, std::uint64_t> expected;
  std::ifstream lines(sequence / "frames.jsonl");
  for (std::string line; std::getline(lines, line);) {
    const Json record = Json::parse(line);
    for (const auto& [outcome, num] : record["outcomes"].items()) {
      if (num > 0) expected[outcome] += num.get<std::uint64_t>();
    }
  }
  ASSERT_GT(expected["rain_absorbed"], 100U);
  const Json stats = Json::parse(ReadFileWhole(out / "stats.json"));
  std::map<std::string, std::uint64_t> found;
  for (const Json& row : JsonTableOf(stats, "outcomes")["rows"]) {
    std::string outcome = row["outcome"];
    std::replace(outcome.begin(), outcome.end(), ' ', '_');
    found[outcome] = row["firings"];
  }
  EXPECT_EQ(found, expected);
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "csv" / "dropout_by_range.csv"));
  EXPECT_TRUE(std::filesystem::exists(out / "charts" / "dropout_by_range.svg"));
}

TEST(StatsCommand, FailsWhereItsTextIsLost) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const Ended run = Analyze("stats " + sequence.string() + " --format text > /dev/full");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, "stdout: not all of it could be written\n");
}

TEST(StatsCommand, GivesTheSameFiguresAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto json_of = [&](const std::string& threads) {
    const auto out = sequence.parent_path() / "out";
    const Ended run =
        Analyze("stats " + sequence.string() + " --out " + out.string() + " --threads " + threads);
    EXPECT_EQ(run.status, 0) << run.said;
    Json stats = Json::parse(ReadFileWhole(out / "stats.json"));
    stats.erase("command");  // The command line contains the number of threads.
    return stats.dump();
  };
  EXPECT_EQ(json_of("1"), json_of("2"));
}

TEST(StatsCommand, EstimatesWhatFilesWithoutOutcomesDoNotSay) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "--format ply --fields x,y,z,ring,column");
  const Ended run = Analyze("stats " + sequence.string() + " --format text");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, testing::Not(HasSubstr("Dropout, exact")));
  EXPECT_THAT(run.said, HasSubstr("Dropout, estimated"));
  EXPECT_THAT(run.said, HasSubstr("upright"));
}

TEST(StatsCommand, ReadsOneFileOfASequence) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const Ended run =
      Analyze("stats " + (sequence / "frames" / "000003.pcd").string() + " --format text");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("not enough (n = 1)"));
}

TEST(StatsCommand, RefusesWhatItCannotReadInOneLine) {
  const TemporaryFolder folder;
  const Ended missing = Analyze("stats /no/such/place --format text");
  EXPECT_EQ(missing.status, 1);
  EXPECT_EQ(missing.said, "/no/such/place: no such file or directory\n");
  const auto broken = folder.Write("broken.pcd", "VERSION 0.7\nFIELDS x y z\n");
  const Ended damaged = Analyze("stats " + broken.string() + " --format text");
  EXPECT_EQ(damaged.status, 1);
  EXPECT_EQ(std::count(damaged.said.begin(), damaged.said.end(), '\n'), 1) << damaged.said;
  EXPECT_THAT(damaged.said, testing::StartsWith(broken.string() + ": "));
}

TEST(StatsCommand, AsksWhereTheReportGoes) {
  EXPECT_EQ(Analyze("stats somewhere").status, 2);
  EXPECT_EQ(Analyze("stats").status, 2);
}

TEST(StatsCommand, RefusesToSumUpLabelsOfTwoMeanings) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto other = sequence.parent_path() / "other";
  const auto labels = ScenariosDir() / "labels.json";
  folder.Write("labels.json", Replaced(ReadFileWhole(labels), "\"animal\"", "\"beast\""));
  const auto scenario =
      folder.Write("other.json", Replaced(ReadFileWhole(sequence.parent_path() / "scenario.json"),
                                          labels.string(), "labels.json"));
  ASSERT_EQ(RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --frames 1 --out " +
                       other.string())
                .status,
            0);
  const Ended run = Analyze("stats " + sequence.string() + " " + other.string() + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, other.string() + ": must have the same labels and materials as " +
                          sequence.string() + "\n");
}

// One sensor of 20 Hz without rings and one of 10 Hz with 16.
TEST(StatsCommand, SumsUpDifferentSensorsWithoutTheirRings) {
  const TemporaryFolder folder;
  const auto out = folder.Write("x", "").parent_path();
  const auto run = out / "run";
  const std::string scenario = (ScenariosDir() / "two_sensors.json").string();
  ASSERT_EQ(
      RunCommand(RAILCAST_GENERATE " sequence " + scenario + " --frames 4 --out " + run.string())
          .status,
      0);
  const auto points_of = [&](const std::string& sources, const std::string& name) {
    const Ended ended = Analyze("stats " + sources + " --out " + (out / name).string());
    EXPECT_EQ(ended.status, 0) << ended.said;
    return Json::parse(ReadFileWhole(out / name / "stats.json"));
  };
  const Json front = points_of((run / "front").string(), "of_front");
  const Json roof = points_of((run / "roof").string(), "of_roof");
  const Json both = points_of(run.string(), "of_both");
  const auto fact = [](const Json& stats, const std::string& name) {
    return std::stoul(stats.at("facts").at(name).get<std::string>());
  };
  EXPECT_EQ(fact(both, "Points"), fact(front, "Points") + fact(roof, "Points"));
  EXPECT_EQ(fact(both, "Frames"), 6U);
  for (const char* table : {"rings", "dropout_by_ring", "holes_by_ring"}) {
    EXPECT_NO_THROW(static_cast<void>(JsonTableOf(roof, table))) << table;
    EXPECT_THROW(static_cast<void>(JsonTableOf(both, table)), std::out_of_range) << table;
  }
}

TEST(StatsCommand, SumsUpADataSet) {
  const TemporaryFolder folder;
  const auto out = folder.Write("x", "").parent_path();
  const auto recipe = folder.Write(
      "recipe.json", R"({"version": 1, "num_scenarios": 3, "num_frames": 2, "bases": [{"file": ")" +
                         (ScenariosDir() / "minimal.json").string() +
                         R"("}], "set": {"/lidar/scan/pattern/angular_resolution_deg": 1.0,
                           "/world/vegetation/trees_per_hectare": 0,
                           "/world/vegetation/grass": false}})");
  ASSERT_EQ(RunCommand(RAILCAST_GENERATE " dataset " + recipe.string() + " --out " +
                       (out / "set").string())
                .status,
            0);
  const Ended run = Analyze("stats " + (out / "set").string() + " --format text");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, testing::ContainsRegex("Frames +6\n"));
}

TEST(StatsCommand, RefusesToCountTwice) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const std::string again = sequence.string() + "/../sequence";
  const Ended run = Analyze("stats " + sequence.string() + " " + again + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, again + ": must be named once\n");
}

class StatsOfCapture : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kCaptures + GetParam() + ".pcap")) {
      GTEST_SKIP() << "no real captures in " << kCaptures;
    }
  }
};

// Limits that hold for any scene of a real sensor: range noise on planes of millimetres to
// centimetres (data sheets: 2 to 3 cm), hardly any holes in surfaces, and not enough turns for a
// mean over frames.
TEST_P(StatsOfCapture, ArePlausible) {
  const TemporaryFolder folder;
  const auto out = folder.Write("x", "").parent_path() / "out";
  const Ended run = Analyze("stats " + kCaptures + GetParam() + ".pcap --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const Json stats = Json::parse(ReadFileWhole(out / "stats.json"));
  int num_bins = 0;
  for (const Json& row : JsonTableOf(stats, "temporal_noise")["rows"]) {
    const Json& sigma_mm = row["robust_sigma_mm"];
    if (sigma_mm["value"].is_null() || sigma_mm["samples"] < 1000) continue;
    EXPECT_GT(sigma_mm["value"], 2.0);
    EXPECT_LT(sigma_mm["value"], 30.0);
    ++num_bins;
  }
  EXPECT_GT(num_bins, 1);
  const Json& holes = JsonTableOf(stats, "grid")["rows"][1]["share"];
  EXPECT_LT(holes["high"], 0.05);
  EXPECT_GT(holes["samples"], 10000);
  EXPECT_TRUE(JsonTableOf(stats, "frames")["rows"][0]["mean"]["value"].is_null());
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         StatsOfCapture,
                         testing::Values("vlp16_dual", "vlp32c_single", "pandar64"));

}  // namespace
}  // namespace railcast
