#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using PlainJson = nlohmann::json;

Ended Compare(const std::string& arguments) {
  return Analyze("compare " + arguments);
}

// A PCD file with a line of points `offset_m` above the ground.
std::string Pcd(double offset_m) {
  std::string text =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 20\nDATA ascii\n";
  for (int i = 1; i <= 20; ++i) text += std::to_string(i) + " 0 " + std::to_string(offset_m) + "\n";
  return text;
}

TEST(RailcastAnalyzeCompare, WantsTwoRecordingsOrAScenario) {
  for (const char* const arguments :
       {"--format text", "a.pcd --format text", "a b c --format text", "a b",
        "a --ablate s.json --format text", "a b --frames 3 --format text",
        "--ablate s.json --pair index --format text", "a b --pair time --format text",
        "--ablate s.json --kitti-columns 5 --format text",
        "--ablate s.json --frame-id lidar --format text"}) {
    EXPECT_EQ(Compare(arguments).status, 2) << arguments;
  }
}

TEST(RailcastAnalyzeCompare, ComparesTwoClouds) {
  const TemporaryFolder folder;
  const auto a = folder.Write("a.pcd", Pcd(0.0)), b = folder.Write("b.pcd", Pcd(0.25));
  const auto out = a.parent_path() / "out";
  const Ended run = Compare(a.string() + " " + b.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const PlainJson json = PlainJson::parse(ReadFileWhole(out / "compare.json"));
  EXPECT_EQ(json["facts"]["Pairs"], "1, by index");
  EXPECT_EQ(json["headlines"][0]["title"], "Density-aware Chamfer distance");
  // 1 - exp(-alpha d), of points that have a nearest point each.
  EXPECT_NEAR(json["headlines"][0]["value"].get<double>(), 1.0 - std::exp(-10.0 * 0.25), 1e-6);
  EXPECT_EQ(json["headlines"][1]["title"], "MAPE of points");
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
}

TEST(RailcastAnalyzeCompare, PrintsTheReportsOfSeveralSensorsAsOneArray) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder);
  DoubleSensor(scenario);
  const Ended run = Compare("--ablate " + scenario.string() + " --frames 1 --format json");
  EXPECT_EQ(run.status, 0);
  const PlainJson reports = PlainJson::parse(run.said);
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[0].at("title"), reports[1].at("title"));
}

TEST(RailcastAnalyzeCompare, RefusesDistancesThatAreNone) {
  const Ended run = Compare("a b --distances 0.1,-1 --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, "--distances: must be > 0 (got -1)\n");
}

TEST(RailcastAnalyzeCompare, StudiesEffects) {
  const TemporaryFolder folder;
  const auto scenario =
      WriteScenario(folder, R"("fidelity": "plausibility", "weather": {"rain_rate_mmph": 20},)");
  const auto out = scenario.parent_path() / "out";
  const Ended run =
      Compare("--ablate " + scenario.string() + " --frames 2 --seed 7 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const PlainJson json = PlainJson::parse(ReadFileWhole(out / "ablation.json"));
  EXPECT_EQ(json["facts"]["Seed"], "7");
  const PlainJson& rows = json["sections"][0]["tables"][0]["rows"];
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[1]["effect"], "rain");
  EXPECT_GT(rows[1]["points_taken"], 0);
  EXPECT_EQ(rows[1]["points_added"], 0);
}

// Two draws of one scene: whatever differs is chance, the yardstick of docs/compare.md.
TEST(RailcastAnalyzeCompare, CannotTellTwoSeedsOfASceneApart) {
  const TemporaryDirectory directory;
  const auto run = [&](const std::string& seed) {
    const auto out = directory.path() / seed;
    const Ended made =
        RunCommand(RAILCAST_GENERATE " sequence " + (ScenariosDir() / "open_line.json").string() +
                   " --out " + out.string() + " --frames 10 --stride 20 --seed " + seed);
    EXPECT_EQ(made.status, 0) << made.said;
    return out.string();
  };
  const std::string a = run("1"), b = run("2");
  const Ended compared = Compare(a + " " + b + " --out " + a + "_out");
  ASSERT_EQ(compared.status, 0) << compared.said;
  const PlainJson area =
      PlainJson::parse(ReadFileWhole(a + "_out/compare.json"))["headlines"].back();
  ASSERT_EQ(area["title"], "AUC of the classifier");
  EXPECT_LT(area["value"]["low"], 0.5);
  EXPECT_GT(area["value"]["high"], 0.5);
}

}  // namespace
}  // namespace railcast
