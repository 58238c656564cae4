#include "core/fidelity/sample_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/fidelity/line_scenario.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::uint32_t LastFrame(const Line& line) {
  const ScenarioSpec scenario = ReadLine(line);
  return LastFrameOfRun(scenario, *MakeSimulator(scenario, 1), 1);
}

// At 10 m/s and 10 frames per second, 600 m take 600 frames. The scan of the frame that begins at
// the track's end would end beyond it.
TEST(LastFrameOfRun, IsTheLastOnTheTrack) {
  EXPECT_NEAR(LastFrame({.end_s_m = "1000"}), 599.0, 1.0);
  EXPECT_EQ(LastFrame({.start_s_m = "1000", .end_s_m = "1000"}), 0U);
}

TEST(LastFrameOfRun, ComesWhenNothingMovesAnyMore) {
  EXPECT_EQ(LastFrame({.speed_mps = "0"}), 0U);
  const char* const wagon = R"([{"name": "wagon", "type": "open_wagon", "s_m": 100, "d_m": 0,
      "motion": {"profile": [{"time_s": 0, "speed_mps": 10}, {"time_s": 8, "speed_mps": 0}]}}])";
  EXPECT_NEAR(LastFrame({.objects = wagon, .speed_mps = "0"}), 80.0, 2.0);
}

TEST(LastFrameOfRun, ComesWhenBarriersHaveMoved) {
  ScenarioSpec scenario = ReadLine({.speed_mps = "0"});
  LevelCrossingSpec crossing = CrossingAt(430.0);
  crossing.barrier_angles_deg = {{2.0, 85.0}, {8.0, 0.0}, {14.0, 85.0}};
  scenario.world.structures = {crossing};
  EXPECT_EQ(LastFrameOfRun(scenario, *MakeSimulator(scenario, 1), 1), 140U);
}

// Frames of a scene at rest differ in their draws, but where the track ends none may follow.
TEST(LastFrameOfRun, LeavesAsManyFramesAtRestAsAreWanted) {
  const auto last = [](const Line& line, int num_frames) {
    const ScenarioSpec scenario = ReadLine(line);
    return LastFrameOfRun(scenario, *MakeSimulator(scenario, 1), num_frames);
  };
  EXPECT_EQ(last({.speed_mps = "0"}, 6), 5U);
  EXPECT_EQ(last({.start_s_m = "1000", .end_s_m = "1000"}, 6), 0U);
  EXPECT_NEAR(last({.end_s_m = "1000"}, 6), 599.0, 1.0);
}

TEST(SpreadFrames, AreTheMiddlesOfEqualParts) {
  EXPECT_THAT(SpreadFrames(599, 3), ElementsAre(100, 300, 500));
}

TEST(SpreadFrames, AreAllFramesOfAShorterRun) {
  EXPECT_THAT(SpreadFrames(0, 3), ElementsAre(0));
  EXPECT_THAT(SpreadFrames(1, 3), ElementsAre(0, 1));
  EXPECT_THAT(SpreadFrames(2, 3), ElementsAre(0, 1, 2));
}

std::vector<std::uint32_t> AtObjects(const Line& line, int num_most) {
  const ScenarioSpec scenario = ReadLine(line);
  return FramesAtObjects(scenario, *MakeSimulator(scenario, 1), LastFrame(line), num_most);
}

// At 10 m/s the vehicle is 60 m, half of the range, before a person 400 m ahead after 34 s, and
// beside it after 40 s. The sensor is at the vehicle's origin.
TEST(FramesAtObjects, AreWhereTheyComeNearAndAreNearest) {
  const char* const person = R"([{"name": "person", "type": "person", "s_m": 800, "d_m": 5}])";
  const std::vector<std::uint32_t> frames = AtObjects({.end_s_m = "1000", .objects = person}, 4);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_NEAR(frames[0], 341.0, 1.0);
  EXPECT_NEAR(frames[1], 400.0, 1.0);
}

TEST(FramesAtObjects, ServeSeveralObjectsAtOnce) {
  const char* const persons =
      R"([{"name": "a", "type": "person", "s_m": 800, "d_m": 5},
          {"name": "b", "type": "person", "s_m": 801, "d_m": 6},
          {"name": "left behind", "type": "person", "s_m": 200, "d_m": 5}])";
  EXPECT_EQ(AtObjects({.end_s_m = "1000", .objects = persons}, 4).size(), 2U);
  EXPECT_EQ(AtObjects({.end_s_m = "1000", .objects = persons}, 1).size(), 1U);
  EXPECT_THAT(AtObjects({}, 4), IsEmpty());
}

TEST(ApproachFrames, AreAtDistancesOfEqualRatios) {
  const char* const person = R"([{"name": "person", "type": "person", "s_m": 800, "d_m": 7.5}])";
  const ScenarioSpec scenario = ReadLine({.end_s_m = "1000", .objects = person});
  const auto frames = ApproachFrames(scenario, *MakeSimulator(scenario, 1), 5);
  // At 120, 60, 30, 15 and 7.5 m.
  ASSERT_EQ(frames.size(), 5U);
  const double expected[] = {280.0, 340.0, 371.0, 387.0, 400.0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(frames[i], expected[i], 1.5);
}

TEST(SampleFrames, AreSpreadAndAtObjects) {
  const char* const person = R"([{"name": "person", "type": "person", "s_m": 800, "d_m": 5}])";
  const ScenarioSpec scenario = ReadLine({.end_s_m = "1000", .objects = person});
  const auto simulator = MakeSimulator(scenario, 1);
  const auto frames = SampleFrames(scenario, *simulator, 4);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_NEAR(frames[0], 150.0, 1.0);
  EXPECT_NEAR(frames[2], 400.0, 1.0);
  EXPECT_EQ(SampleFrames(scenario, *simulator, 1).size(), 1U);
}

}  // namespace
}  // namespace railcast
