#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// A scenario whose sensor is 2.5 m above the rails and 0.2 m left of the middle, on a track with a
/// second one at 4.5 m.
std::filesystem::path WriteLine(const TemporaryFolder& folder) {
  const std::string scenarios = ScenariosDir().string();
  return folder.Write("scenario.json", R"({
    "version": 1,
    "fidelity": "footprint",
    "lidar": {"file": ")" + scenarios + R"(/sensors/xt32.json",
              "mount": {"position_m": [2, 0.2, 2.5], "pitch_deg": 10}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.5}]
    },
    "vehicle": {"start_s_m": 400, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "materials": "railcast:railway.json",
    "labels": "railcast:labels.json"})");
}

std::filesystem::path MakeRun(const TemporaryFolder& folder) {
  const auto scenario = WriteLine(folder);
  auto out = scenario.parent_path() / "run";
  GenerateOnce("sequence " + scenario.string() + " --frames 4", out);
  return out;
}

nlohmann::json JsonIn(const std::filesystem::path& file) {
  return nlohmann::json::parse(ReadFileWhole(file));
}

TEST(TrackCommand, WritesTheMountAndATwinThatRuns) {
  const TemporaryFolder folder;
  const auto run = MakeRun(folder);
  const auto out = run.parent_path() / "out";
  const Ended track = Analyze("track " + run.string() + " --out " + out.string());
  ASSERT_EQ(track.status, 0) << track.said;
  EXPECT_THAT(track.said, HasSubstr("Sensor above the rails (m)"));
  const auto mount = JsonIn(out / "mount.json");
  EXPECT_EQ(mount.at("position_m").at(0), 0.0);
  EXPECT_NEAR(mount.at("position_m").at(1), 0.2, 0.015);
  EXPECT_NEAR(mount.at("position_m").at(2), 2.5, 0.01);
  EXPECT_NEAR(mount.at("pitch_deg"), 10.0, 0.1);
  const auto twin = JsonIn(out / "twin.json");
  EXPECT_EQ(twin.at("lidar").at("mount"), mount);
  EXPECT_EQ(twin.at("world").at("alignment").at("gauge_mm"), 1435.0);
  EXPECT_NEAR(twin.at("world").at("tracks").at(1).at("offset_m"), 4.5, 0.03);

  const auto again = run.parent_path() / "twin";
  const Ended made = RunCommand(RAILCAST_GENERATE " sequence " + (out / "twin.json").string() +
                                " --frames 1 --out " + again.string());
  ASSERT_EQ(made.status, 0) << made.said;
  ASSERT_EQ(
      Analyze("track " + again.string() + " --out " + (run.parent_path() / "b").string()).status,
      0);
  EXPECT_NEAR(JsonIn(run.parent_path() / "b/mount.json").at("position_m").at(2),
              mount.at("position_m").at(2), 0.01);
}

// As a sensor's user has recordings: packets without poses, and clouds in a bag.
TEST(TrackCommand, FindsTheTrackInCapturesAndBags) {
  const TemporaryFolder folder;
  const auto scenario = WriteLine(folder);
  const auto capture = scenario.parent_path() / "drive.pcap";
  const auto bag = scenario.parent_path() / "bag";
  for (const std::string& made : std::vector<std::string>{
           " stream " + scenario.string() + " --protocol xt32 --duration 0.3 --pcap " +
               capture.string(),
           " sequence " + scenario.string() + " --format mcap --frames 3 --out " + bag.string()}) {
    const Ended run = RunCommand(RAILCAST_GENERATE + made);
    ASSERT_EQ(run.status, 0) << run.said;
  }
  for (const auto& recording : {capture, bag}) {
    const auto out = scenario.parent_path() / "out";
    const Ended track = Analyze("track " + recording.string() + " --points --out " + out.string());
    ASSERT_EQ(track.status, 0) << track.said;
    const auto mount = JsonIn(out / "mount.json");
    EXPECT_NEAR(mount.at("position_m").at(1), 0.2, 0.015) << recording;
    EXPECT_NEAR(mount.at("position_m").at(2), 2.5, 0.01) << recording;
    EXPECT_NEAR(mount.at("pitch_deg"), 10.0, 0.1) << recording;
    EXPECT_TRUE(std::filesystem::exists(out / "points/000001.npy")) << recording;
  }
}

TEST(TrackCommand, WritesWhereEachPointIsOnTheTrack) {
  const TemporaryFolder folder;
  const auto run = MakeRun(folder);
  const auto out = run.parent_path() / "out";
  const Ended track = Analyze("track " + run.string() + " --points --out " + out.string());
  ASSERT_EQ(track.status, 0) << track.said;
  // Another program's reader: all is on the ground beside the rails, or above it, and no obstacle.
  const Ended read = RunCommand(
      "/usr/bin/python3 -c \"import numpy, sys; a = numpy.load(sys.argv[1]); "
      "near = a[numpy.abs(a['track_lateral_m']) < 3]; "
      "print(len(a), len(near) > 1000, near['track_height_m'].min() > -1, "
      "a['in_gauge'][a['track_height_m'] > 0.1].sum())\" " +
      (out / "points/000003.npy").string());
  EXPECT_EQ(read.said, "64000 True True 0\n");
  EXPECT_THAT(ReadFileWhole(out / "csv/in_the_way.csv"), HasSubstr("points_in_clear_space"));
  // Nothing of a longer run stays.
  const std::string again = "track " + run.string() + " --out " + out.string();
  ASSERT_EQ(Analyze(again + " --points --frames 2").status, 0);
  EXPECT_TRUE(std::filesystem::exists(out / "points/000001.npy"));
  EXPECT_FALSE(std::filesystem::exists(out / "points/000002.npy"));
  ASSERT_EQ(Analyze(again).status, 0);
  EXPECT_TRUE(std::filesystem::is_empty(out / "points"));
  EXPECT_EQ(Analyze("track " + run.string() + " --points --format text").said,
            "--points: needs --out, the folder to which it writes\n");
}

TEST(TrackCommand, SaysWhyThereIsNoTrack) {
  const TemporaryFolder folder;
  const auto run = MakeRun(folder);
  const Ended track = Analyze("track " + run.string() + " --gauge 1000 --format text");
  EXPECT_EQ(track.status, 1);
  EXPECT_THAT(track.said, HasSubstr(run.string() + ": no frame shows a track: "));
}

}  // namespace
}  // namespace railcast
