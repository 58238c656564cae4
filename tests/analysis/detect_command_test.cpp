#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/image/png.h"
#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using PlainJson = nlohmann::json;

constexpr const char* kVehicle =
    R"("world": {"alignment": {"course": {"type": "elements", "elements": [)"
    R"({"type": "straight", "length_m": 1000}]}}, "vegetation": {"trees_per_hectare": 0, )"
    R"("grass": false}, "objects": [{"name": "box", "type": "box", "s_m": 480, "h_m": 0, )"
    R"("size_m": [2, 2, 3]}, {"name": "man", "type": "person", "s_m": 450, "d_m": -2.5}]}, )"
    R"("vehicle": {"start_s_m": 400, "motion": {"profile": )"
    R"([{"time_s": 0, "speed_mps": 10}]}}, )";

/// Frames of an approach at 10 m/s towards a box that is 79 m ahead of the sensor at first.
std::filesystem::path MakeApproach(const TemporaryFolder& folder,
                                   const std::string& name,
                                   const std::string& options = "--frames 40 --fidelity geometry") {
  const std::string scenarios = ScenariosDir().string();
  static const TemporaryFolder kept;
  const auto scenario =
      kept.Write("approach.json",
                 std::string("{\"version\": 1, ") + kVehicle +
                     R"("lidar": {"scan": {"rate_hz": 10, )" + R"("pattern": {"type": "raster", )" +
                     R"("horizontal_fov_deg": 20, )" + R"("vertical_fov_deg": 20, )" +
                     R"("angular_resolution_deg": 0.5}}}, )" + R"("materials": ")" + scenarios +
                     R"(/materials/railway.json", "labels": ")" + scenarios + R"(/labels.json"})");
  auto out = folder.Write("here", "").parent_path() / name;
  GenerateOnce("sequence " + scenario.string() + " --fields x,y,z,label " + options, out);
  return out;
}

TEST(DetectCommand, FindsWhereABoxIsFirstSeenByTwentyBeams) {
  const TemporaryFolder folder;
  const auto run = MakeApproach(folder, "run");
  const auto out = run.parent_path() / "report";
  const Ended ended =
      Analyze("detect " + run.string() + " --points 20 --frames 2/3 --out " + out.string());
  ASSERT_EQ(ended.status, 0) << ended.said;
  const PlainJson report = PlainJson::parse(ReadFileWhole(out / "detect.json"));
  // Evaluate objects.jsonl independently: find the second of three frames with 20 points.
  std::istringstream lines(ReadFileWhole(run / "objects.jsonl"));
  std::vector<int> points;
  for (std::string line; std::getline(lines, line);) {
    points.push_back(PlainJson::parse(line).at("objects").at(0).at("points"));
  }
  std::size_t expected = 0;
  int in_last_three = 0;
  for (std::size_t i = 0; i < points.size() && in_last_three < 2; ++i) {
    in_last_three = 0;
    for (std::size_t j = i < 2 ? 0 : i - 2; j <= i; ++j) in_last_three += points[j] >= 20 ? 1 : 0;
    expected = i;
  }
  ASSERT_GT(expected, 2U);
  for (const PlainJson& section : report.at("sections")) {
    for (const PlainJson& table : section.at("tables")) {
      if (table.at("key") != "runs") continue;
      const PlainJson& row = table.at("rows").at(0);
      // The box's face is 79 m away at first and 1 m nearer in each frame.
      EXPECT_NEAR(row.at("detected_at_m").get<double>(), 79.0 - static_cast<double>(expected),
                  0.01);
      EXPECT_NEAR(row.at("speed_kmph").get<double>(), 36.0, 1e-3);
      EXPECT_NEAR(row.at("needed_m").get<double>(), 135.0, 0.01);
      EXPECT_EQ(row.at("outcome"), "too late");
    }
  }
  // The person stands 2.5 m beside the axis and is no reason to brake.
  const PlainJson& verdicts = report.at("sections").at(0).at("tables").at(0).at("rows");
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts.at(0).at("object"), "box");
  const PlainJson& beside = report.at("sections").at(2).at("tables").at(0).at("rows");
  ASSERT_EQ(beside.size(), 1U);
  EXPECT_EQ(beside.at(0).at("object"), "man");
  EXPECT_THAT(ended.said, HasSubstr("Beside the track, not judged      man\n"));
  EXPECT_TRUE(exists(out / "report.html"));
}

// The scene, the box with at most 19 points of its colour, and the box with 20 or more.
TEST(DetectCommand, ShowsWhatWasSeenOfABox) {
  const TemporaryFolder folder;
  const auto run = MakeApproach(folder, "run");
  const auto out = run.parent_path() / "report";
  const Ended ended =
      Analyze("detect " + run.string() + " --points 20 --frames 1/1 --out " + out.string());
  ASSERT_EQ(ended.status, 0) << ended.said;
  const auto seen = DecodePngRgb(ReadFileWhole(out / "charts" / "seen_box.png"));
  ASSERT_EQ(seen.size.width_px, 3U * 480U);
  ASSERT_EQ(seen.size.height_px, 320U);
  const PlainJson labels = PlainJson::parse(ReadFileWhole(ScenariosDir() / "labels.json"));
  std::array<int, 3> object{};
  for (const PlainJson& label : labels["labels"]) {
    if (label["name"] == "object") object = label["rgb"].get<std::array<int, 3>>();
  }
  const auto count = [&](std::size_t place, const std::array<int, 3>& rgb) {
    std::size_t num = 0;
    for (std::size_t i = 0; i < seen.values.size(); i += 3) {
      const bool is_there = i / 3 % seen.size.width_px / 480 == place;
      num += is_there && std::equal(rgb.begin(), rgb.end(),
                                    seen.values.begin() + static_cast<std::ptrdiff_t>(i))
                 ? 1
                 : 0;
    }
    return num;
  };
  // A point is 6 pixels wide, of which those at its rim have mixed colours.
  EXPECT_LE(count(1, object), 19U * 36U);
  EXPECT_GE(count(2, object), 20U * 5U);
  EXPECT_GT(count(2, object), count(1, object));
  // The frame in the scene, and the box.
  for (const std::size_t place : {0U, 1U, 2U}) EXPECT_GT(count(place, {255, 255, 255}), 100U);
  EXPECT_THAT(ReadFileWhole(out / "report.html"),
              HasSubstr("<img alt=\"box. Run of seed 1. Outlined: "));
}

TEST(DetectCommand, SaysWhichRungMadeTheFrames) {
  const TemporaryFolder folder;
  const auto detect = [&](const std::string& fidelity) {
    const auto run = MakeApproach(folder, fidelity, "--frames 3 --fidelity " + fidelity);
    return Analyze("detect " + run.string() + " --format text").said;
  };
  EXPECT_THAT(detect("surface"), testing::AllOf(HasSubstr("surface: one ray per beam"),
                                                HasSubstr("sends one ray into each beam")));
  EXPECT_THAT(detect("footprint"),
              testing::AllOf(HasSubstr("footprint: beams with a width"),
                             testing::Not(HasSubstr("sends one ray into each beam"))));
  // The manifest records what was chosen.
  EXPECT_THAT(detect("auto"),
              testing::ContainsRegex("auto: (beams with a width|one ray per beam)"));
}

TEST(DetectCommand, RefusesWhatIsNoSetOfRuns) {
  const TemporaryFolder folder;
  const auto one = MakeApproach(folder, "one", "--frames 3 --fidelity geometry");
  const auto same = MakeApproach(folder, "same", "--frames 3 --fidelity geometry");
  const Ended twice = Analyze("detect " + one.string() + " " + same.string() + " --format text");
  EXPECT_EQ(twice.status, 1);
  EXPECT_EQ(twice.said,
            same.string() + ": /seed: must be another than that of " + one.string() + " (got 1)\n");
  const Ended cloud =
      Analyze("detect " + (one / "frames" / "000000.pcd").string() + " --format text");
  EXPECT_EQ(cloud.status, 1);
  EXPECT_THAT(cloud.said, HasSubstr("must be a sequence directory"));
  EXPECT_EQ(Analyze("detect " + one.string() + " --format text --frames 5/3").status, 2);
}

}  // namespace
}  // namespace railcast
