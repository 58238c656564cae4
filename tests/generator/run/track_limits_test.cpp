#include "core/scenario/track_limits.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

// A straight line of 1 km with the vehicle at 400 m and a rock at 450 m; 10 scans of 30 us per
// second.
class TrackLimits : public testing::Test {
 protected:
  // Returns the error for frames `first` to `last`, without the names of the scenario's file.
  std::string Message(std::uint32_t first, std::uint32_t last) const {
    const auto world = MakeWorld(scenario_);
    const ScanPattern pattern = BuildScanPattern(scenario_.lidar.scan);
    std::string said =
        MessageOf([&] { CheckStaysOnTracks(scenario_, *world, pattern, first, last); });
    const std::string file = (directory_.path() / "scenario.json").string() + ": ";
    for (std::size_t at = said.find(file); at != std::string::npos; at = said.find(file)) {
      said.erase(at, file.size());
    }
    return said;
  }

 private:
  TemporaryDirectory directory_;

 protected:
  ScenarioSpec scenario_ = ReadScenario(MakeProject(directory_.path()));
};

MotionSpec Constantly(double speed_mps, bool reverse = false) {
  return {{{.time_s = 0.0, .s_m = {}, .speed_mps = speed_mps}}, reverse};
}

TEST_F(TrackLimits, AreKeptByWhatStands) {
  EXPECT_EQ(Message(0, 4'000'000'000U), "no error");
}

TEST_F(TrackLimits, NameTheFirstFrameBeyondTheEnd) {
  // 600 m at 25 m/s take 24 s. Frame 240 ends 0.75 mm beyond the end, which is within the
  // tolerance.
  scenario_.vehicle.motion = Constantly(25.0);
  EXPECT_EQ(Message(0, 240), "no error");
  const std::string fault =
      "/vehicle/motion: leaves track \"main\", from 0 to 1000 m, at frame 241 (24.1 s)";
  EXPECT_EQ(Message(0, 241), fault);
  EXPECT_EQ(Message(0, 1'000'000'000), fault);
  EXPECT_EQ(Message(300, 301),
            "/vehicle/motion: leaves track \"main\", from 0 to 1000 m, at frame 300 (30 s)");
}

// The buffers of an open wagon of 14.04 m are 2.52 m ahead of its front pivot, and 7.02 m ahead of
// its middle.
TEST_F(TrackLimits, HoldForTheForemostBuffersOfTrains) {
  scenario_.vehicle.consist = {{TypeNamed("open_wagon"), {}, false}};
  scenario_.vehicle.motion = Constantly(25.0);
  TrainSpec train{.name = "freight",
                  .s_m = 600.0,
                  .vehicles = {{TypeNamed("open_wagon"), {}, false}},
                  .motion = Constantly(50.0, true)};
  scenario_.world.trains = {train};
  // 597.48 m at 25 m/s take 23.9 s, and 600 - 14.04 m at 50 m/s 11.72 s.
  EXPECT_EQ(Message(0, 116), "no error");
  EXPECT_EQ(Message(0, 300),
            "/vehicle/motion: leaves track \"main\", from 0 to 1000 m, at frame 239 (23.9 s)\n"
            "/world/trains/0/motion: leaves track \"main\", from 0 to 1000 m, at frame 120 "
            "(12 s)");
}

TEST_F(TrackLimits, HoldInReverseAndOnAShorterTrack) {
  scenario_.world.tracks[0].start_s_m = 100.0;
  scenario_.world.tracks[0].end_s_m = 500.0;
  scenario_.vehicle.motion = Constantly(20.0, true);
  EXPECT_EQ(Message(0, 1000),
            "/vehicle/motion: leaves track \"main\", from 100 to 500 m, at frame 151 (15.1 s)");
}

TEST_F(TrackLimits, HoldForObjectsToo) {
  scenario_.vehicle.motion = Constantly(25.0);
  scenario_.world.objects[0].motion = Constantly(5.0, true);
  const std::string said = Message(0, 5000);
  EXPECT_NE(said.find("/world/objects/0/motion: leaves track \"main\", from 0 to 1000 m, at frame "
                      "901 (90.1 s)"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("/vehicle/motion: "), 0U);
}

TEST_F(TrackLimits, LetATrainStopAtTheVeryEnd) {
  // 600 m that begin at 10 m/s; over the last 100 m the vehicle brakes to a stop.
  scenario_.vehicle.motion = {{{.time_s = {}, .s_m = 400.0, .speed_mps = 10.0},
                               {.time_s = {}, .s_m = 900.0, .speed_mps = 10.0},
                               {.time_s = {}, .s_m = 1000.0, .speed_mps = 0.0}},
                              false};
  EXPECT_EQ(Message(0, 1'000'000), "no error");
}

TEST_F(TrackLimits, AreAskedForTheFramesBeforeATime) {
  const ScanPattern pattern = BuildScanPattern(scenario_.lidar.scan);  // 10 Hz
  EXPECT_EQ(LastFrameBefore(pattern, 0), 0U);
  EXPECT_EQ(LastFrameBefore(pattern, 1), 0U);
  EXPECT_EQ(LastFrameBefore(pattern, 100'000'000), 0U);
  EXPECT_EQ(LastFrameBefore(pattern, 100'000'001), 1U);
  EXPECT_EQ(LastFrameBefore(pattern, 24'100'000'000), 240U);
  EXPECT_EQ(LastFrameBefore(pattern, std::numeric_limits<std::int64_t>::max()),
            pattern.LastFrame());
}

}  // namespace
}  // namespace railcast
