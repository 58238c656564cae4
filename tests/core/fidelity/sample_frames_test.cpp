#include "core/fidelity/sample_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "core/fidelity/beam_steps.h"
#include "core/fidelity/frame_comparison.h"
#include "core/fidelity/scene_parts.h"
#include "tests/core/fidelity/line_scenario.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/echo_frame.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"
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

// Newcombe 1998 (Stat. Med. 17, 857), table I, method 4.
TEST(LeastShare, IsThatOfThePublishedExamples) {
  EXPECT_NEAR(LeastShare(81, 263), 0.2535, 5e-5);
  EXPECT_NEAR(LeastShare(15, 148), 0.0598, 5e-5);
  EXPECT_EQ(LeastShare(0, 20), 0.0);
  EXPECT_NEAR(LeastShare(1, 29), 0.0018, 5e-5);
}

// docs/frontier.md says so.
TEST(LeastShare, IsBeyondATenthFrom4Of10And7Of30And17Of100On) {
  EXPECT_LE(LeastShare(3, 10), 0.1);
  EXPECT_GT(LeastShare(4, 10), 0.1);
  EXPECT_LE(LeastShare(6, 30), 0.1);
  EXPECT_GT(LeastShare(7, 30), 0.1);
  EXPECT_LE(LeastShare(16, 100), 0.1);
  EXPECT_GT(LeastShare(17, 100), 0.1);
}

TEST(LeastShare, OfOneEchoIsBelowATenth) {
  EXPECT_LT(LeastShare(1, 1), 0.1);
  EXPECT_EQ(LeastShare(0, 0), 0.0);
}

TEST(MedianOf, HasALowerEndByRanks) {
  std::vector<float> errors(101);
  std::iota(errors.begin(), errors.end(), 1.0F);
  // (101 - 1.96 x sqrt(101)) / 2 = 40.65.
  EXPECT_EQ(MedianOf(errors).median, 51.0);
  EXPECT_EQ(MedianOf(errors).least, 40.0);
}

TEST(MedianOf, OfAFewErrorsSaysNothing) {
  EXPECT_EQ(MedianOf({1.0F, 2.0F, 3.0F}).least, 0.0);
  EXPECT_TRUE(std::isnan(MedianOf({}).median));
}

std::vector<ScenePart> Parts() {
  std::vector<Label> labels(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    labels[i].id = i + 1;
    labels[i].name = std::array{"ground", "contact_wire", "person"}[i];
  }
  std::vector<SceneObject> objects(2);
  objects[0].name = "a person";
  objects[0].instance = 7;
  objects[1].name = "ego";
  objects[1].is_ego = true;
  return MakeSceneParts(120.0, LabelTable(labels), {2}, objects);
}

TEST(SceneParts, AreRangesClassesAndObjects) {
  std::vector<std::string> names;
  for (const ScenePart& part : Parts()) names.push_back(part.name);
  EXPECT_THAT(names, testing::ElementsAre("0 to 50 m", "50 to 100 m", "100 to 150 m", "ground",
                                          "person", "a person"));
}

// A person of 30 echoes far off loses 13 of them, among a thousand echoes of the ground: 1.3 % of
// all.
TEST(SceneParts, ShowWhatTheMeanHides) {
  std::vector<std::vector<MadeEcho>> reference(1000, {{20.0F, 1}});
  std::vector<std::vector<MadeEcho>> other = reference;
  for (int i = 0; i < 30; ++i) {
    reference.push_back({{110.0F, 3}});
    other.push_back({{i < 13 ? 90.0F : 110.0F, 3}});
  }
  Frame seen = MakeEchoFrame(reference);
  for (std::size_t slot = 3000; slot < seen.num_slots(); ++slot) seen.instance[slot] = 7;
  FrameComparison comparison(
      {.match_distance_m = 0.375F, .range_max_m = 120.0F, .thin_labels = {}, .parts = Parts()});
  comparison.Add(seen, MakeEchoFrame(other));
  const FrameDifference d = comparison.Result();
  EXPECT_NEAR(1.0 - d.reference_echoes.share(), 0.013, 1e-3);
  EXPECT_EQ(d.parts[0].reference_echoes, (Matched{1000, 1000}));
  EXPECT_EQ(d.parts[1].echoes, (Matched{13, 0}));
  for (const std::size_t part : {2U, 4U, 5U}) {
    EXPECT_EQ(d.parts[part].reference_echoes, (Matched{30, 17})) << d.parts[part].part.name;
  }
  EXPECT_EQ(d.parts[2].range_m.median, 0.0);
}

// Sigma is a quarter of the wider divergence: 1 mrad.
constexpr BeamSpec kBeam{.divergence_mrad = {4.0, 1.0}};

std::vector<float> Steps(const std::vector<std::vector<MadeEcho>>& firings,
                         const StepLimits& limits = kReferenceSteps,
                         float incidence_rad = 0.0F) {
  Frame frame = MakeEchoFrame(firings);
  for (float& value : frame.incidence_rad) value = incidence_rad;
  return StepsOf(frame, kBeam, limits);
}

MadeEcho Part(float range_m, float share) {
  return {range_m, 3, 0.2F, share};
}

TEST(StepsOf, AreTheGapsBetweenPartsOneBehindTheOther) {
  const std::vector<float> steps_m =
      Steps({{Part(20.3F, 0.6F), Part(20.0F, 0.4F)},
             {Part(20.0F, 0.6F), Part(20.1F, 0.2F), Part(20.4F, 0.2F)},
             {Part(20.0F, 1.0F)},
             {}});
  EXPECT_NEAR(static_cast<double>(steps_m[0]), 0.3, 1e-5);
  EXPECT_NEAR(static_cast<double>(steps_m[1]), 0.3, 1e-5);
  EXPECT_TRUE(std::isnan(steps_m[2]));
  EXPECT_TRUE(std::isnan(steps_m[3]));
}

TEST(StepsOf, LeaveOutGapsBeyondTheirLimitsAndSmallParts) {
  const std::vector<std::vector<MadeEcho>> firings = {{Part(20.0F, 0.6F), Part(20.04F, 0.4F)},
                                                      {Part(20.0F, 0.6F), Part(20.6F, 0.4F)},
                                                      {Part(20.0F, 0.96F), Part(20.2F, 0.04F)}};
  for (const float step_m : Steps(firings)) EXPECT_TRUE(std::isnan(step_m));
  for (const float step_m : Steps(firings, kFoundSteps)) EXPECT_FALSE(std::isnan(step_m));
}

// At 20 m and 85 deg a beam of 1 mrad has a spread of 0.23 m.
TEST(StepsOf, AreNotThoseOfASlope) {
  EXPECT_TRUE(
      std::isnan(Steps({{Part(20.0F, 0.6F), Part(20.4F, 0.4F)}}, kReferenceSteps, 1.4835F)[0]));
  EXPECT_FALSE(
      std::isnan(Steps({{Part(20.0F, 0.6F), Part(20.4F, 0.4F)}}, kReferenceSteps, 1.2F)[0]));
}

// Beams of 3 mrad whose centres are up to two sigmas from a plate's edge, before a wall.
std::shared_ptr<SimpleWorld> PlateBeforeWall(float step_m) {
  return WorldOfParts(
      {{{{{20, -9, -9}, {20, 0, -9}, {20, 0, 9}, {20, -9, 9}}, {{0, 1, 2}, {0, 2, 3}}}, 2, 7},
       {MakeWall(20.0F + step_m, 9.0F), 2, 8}});
}

TEST(ShowParts, ShowsAStepThatTheSensorsOwnPulsesMerge) {
  SimulatorSpec spec{
      .detector = {.effects = WithoutRangeErrors(EffectsOfRung(Fidelity::kReference))}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam = {.divergence_mrad = {3.0, 3.0}};
  const ScanPattern pattern = MakeRaster(0.1, 0.1, 0.05);  // Two columns, 0.6 sigma off the edge.
  for (const float step_m : {0.07F, 0.2F, 0.45F}) {
    spec.detector.receiver.return_mode = ReturnMode::kTriple;
    const Frame own = ScanOnce(PlateBeforeWall(step_m), pattern, spec);
    const Frame parts = ScanOnce(PlateBeforeWall(step_m), pattern, ShowParts(spec));
    for (const float found_m : StepsOf(own, spec.detector.beam, kReferenceSteps)) {
      EXPECT_TRUE(std::isnan(found_m)) << step_m;
    }
    for (const float found_m : StepsOf(parts, spec.detector.beam, kReferenceSteps)) {
      EXPECT_NEAR(static_cast<double>(found_m), static_cast<double>(step_m), 1e-3);
    }
  }
}

}  // namespace
}  // namespace railcast
