#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/same_frames.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Several thousand random triangles, many of which intersect: plenty of edges, vertices and ties.
std::shared_ptr<SimpleWorld> ThicketWorld() {
  Mesh thicket;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto place = RandomWords(1, RandomUse::kTreePlacement, 0, i);
    const Eigen::Vector3f corner(10.0F + 80.0F * UnitFloat(place[0]),
                                 40.0F * UnitFloat(place[1]) - 20.0F,
                                 30.0F * UnitFloat(place[2]) - 15.0F);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto edge = RandomWords(1, RandomUse::kTreePlacement, 1 + k, i);
      thicket.vertices.emplace_back(
          corner + Eigen::Vector3f(UnitFloat(edge[0]), UnitFloat(edge[1]), UnitFloat(edge[2])));
    }
    thicket.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto world =
      WorldOfParts({{MakeFloor(-2.0F, 500.0F), 1, 1}, {MakeFloor(-2.0F, 400.0F), 2, 2}});
  const auto model = std::make_shared<Model>(Model{"thicket", {{thicket, 3, 3}}});
  world->AddObject(model, Transform::Identity());
  world->AddObject(model, Transform::Identity(), {-3.0, 1.0, 0.0});
  world->velocity_chunk_mps = {11.0, 0.0, 0.0};
  return world;
}

SimulatorSpec EverythingOn() {
  SimulatorSpec spec{.detector = {.seed = 42,
                                  .effects = {.threshold = true,
                                              .rain = true,
                                              .snow = true,
                                              .noise = true,
                                              .sensor_dropout = true}}};
  spec.detector.weather.rain_rate_mmph = 20.0;
  spec.detector.weather.snow_rate_mmph = 2.0;
  spec.detector.plausibility.dropout_probability = 0.05;
  return spec;
}

TEST(Determinism, SameBytesAtOneTwoAndEightThreads) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.25);
  const Frame one = ScanOnce(world, pattern, EverythingOn(), 4, 1);
  ExpectSameBytes(one, ScanOnce(world, pattern, EverythingOn(), 4, 2));
  ExpectSameBytes(one, ScanOnce(world, pattern, EverythingOn(), 4, 8));
}

TEST(Determinism, AFrameDoesNotDependOnThoseBeforeIt) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  Simulator simulator(world, pattern, TestMaterials(), EverythingOn(), 2);
  Frame frame;
  for (std::uint32_t index = 0; index <= 5; ++index) simulator.Scan(index, frame);
  ExpectSameBytes(frame, ScanOnce(world, pattern, EverythingOn(), 5, 2));
}

TEST(Determinism, FramesMadeAtOnceAreThoseMadeOneAfterAnother) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  Simulator simulator(world, pattern, TestMaterials(), EverythingOn(), 4);
  constexpr std::uint32_t kNumFrames = 8;
  std::vector<Frame> frames(kNumFrames);
  std::vector<std::vector<ObjectView>> views(kNumFrames);
  std::vector<std::shared_ptr<BegunFrame>> begun;
  for (std::uint32_t i = 0; i < kNumFrames; ++i) begun.push_back(simulator.Begin(i));
  simulator.Execute([&] {
    tbb::parallel_for(0U, kNumFrames,
                      [&](std::uint32_t i) { simulator.Scan(*begun[i], frames[i], views[i]); });
  });
  Simulator one(world, pattern, TestMaterials(), EverythingOn(), 1);
  Frame frame;
  for (std::uint32_t i = 0; i < kNumFrames; ++i) {
    one.Scan(i, frame);
    ExpectSameBytes(frame, frames[i]);
    EXPECT_EQ(one.ViewObjects(i), views[i]);
  }
}

TEST(Determinism, AnotherSeedChangesOnlyWhatIsRandom) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  SimulatorSpec other = EverythingOn();
  other.detector.seed = 43;
  const Frame a = ScanOnce(world, pattern, EverythingOn());
  const Frame b = ScanOnce(world, pattern, other);
  EXPECT_NE(a.outcome, b.outcome);
  std::size_t num_compared = 0;
  for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
    if (a.outcome[slot] == Outcome::kClutter || b.outcome[slot] == Outcome::kClutter) continue;
    if (a.label[slot] == 0) continue;
    ++num_compared;
    ASSERT_EQ(a.true_range_m[slot], b.true_range_m[slot]);
    ASSERT_EQ(a.label[slot], b.label[slot]);
  }
  EXPECT_GT(num_compared, 1000U);
}

// Random keys include the effect, so switching snow off must not change the draws of other effects.
TEST(Determinism, SwitchingOneEffectOffLeavesTheOthersDrawsAlone) {
  const auto world = ThicketWorld();
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  SimulatorSpec without_snow = EverythingOn();
  without_snow.detector.effects.snow = false;
  const Frame with = ScanOnce(world, pattern, EverythingOn());
  const Frame without = ScanOnce(world, pattern, without_snow);
  std::size_t num_compared = 0;
  for (std::size_t slot = 0; slot < with.num_slots(); ++slot) {
    if (with.outcome[slot] == Outcome::kClutter) continue;
    ++num_compared;
    ASSERT_EQ(with.outcome[slot], without.outcome[slot]);
    if (with.outcome[slot] == Outcome::kReturned) {
      ASSERT_EQ(with.range_m[slot], without.range_m[slot]);
    }
  }
  EXPECT_GT(num_compared, with.num_slots() / 2);
}

// Sensors whose frames differ: each frame is that of a repeating sensor with this frame's pattern.

constexpr std::uint32_t kFrame = 7;

// Two lasers; 1000 firings, which fill some tiles and a part of one.
ScanPattern Rosettes() {
  return BuildScanPattern(
      {.rate_hz = 10.0,
       .pattern = RisleySpec{
           .channels = {{.elevation_deg = -1.0}, {.elevation_deg = 1.0}},
           .cycle_us = 190.0,
           .columns = 500,
           .prisms = {{.wedge_deg = 10.0, .refractive_index = 1.5, .turns_hz = -77.7},
                      {.wedge_deg = 10.0, .refractive_index = 1.5, .turns_hz = 121.6}}}});
}

/// A sensor that has the firings of one frame in all frames.
ScanPattern Frozen(const ScanPattern& pattern, std::uint32_t frame_index) {
  ScanPattern frozen = PatternOfFrame(pattern, frame_index);
  frozen.figure = nullptr;
  return frozen;
}

MaterialLibrary BoardMaterials() {
  return MaterialLibrary({{.name = "grey", .reflectivity = 0.5, .texture = 0.2},
                          {.name = "sheet", .reflectivity = 0.2, .retroreflectance = 500.0}});
}

// A wall, before it a moving board that reflects back, and a wagon's side that hides a part.
std::shared_ptr<SimpleWorld> Yard() {
  const auto world =
      WorldOfParts({{MakeWall(80.0F, 100.0F), 1, 1}, {MakeFloor(-2.0F, 200.0F), 1, 1}});
  world->AddObject(std::make_shared<Model>(Model{"board", {{MakeWall(40.0F, 2.0F), 2, 2}}}),
                   Transform::Identity(), {-2.0, 1.0, 0.0});
  world->AddObject(std::make_shared<Model>(Model{"side", {{MakeWall(30.0F, 1.0F), 1, 3}}}),
                   Transform::Identity());
  world->velocity_chunk_mps = {11.0, 0.5, 0.0};
  return world;
}

// Everything that looks at directions or at other beams.
SimulatorSpec EveryEffect() {
  SimulatorSpec spec{.detector = {.seed = 5, .effects = EffectsOfRung(Fidelity::kFootprint)}};
  DetectorSpec& detector = spec.detector;
  detector.cover = {.drop_coverage = 0.1, .dirt_coverage = 0.1, .snow_coverage = 0.05};
  detector.receiver.halo_share_at_1_deg = 1e-4;
  detector.receiver.pointing_jitter_deg = 0.05;
  detector.receiver.channel_bias_sigma_m = 0.02;
  detector.receiver.intensity_noise = 0.1;
  detector.receiver.channel_gain = 0.15;
  detector.receiver.channel_gain_variation = 0.2;
  detector.receiver.edge_loss = 0.5;
  detector.receiver.saturation_power_ratio = 100.0;
  detector.receiver.ghost_reflectance = 0.1;
  detector.receiver.foreign_pulses_hz = 1e4;
  detector.weather.rain_rate_mmph = 20.0;
  detector.weather.sun = {.illuminance_klx = 80.0, .azimuth_deg = 2.0, .elevation_deg = 1.0};
  return spec;
}

Frame ScanYard(const ScanPattern& pattern, std::uint32_t frame_index, int num_threads) {
  return FrameBy(Simulator(Yard(), pattern, BoardMaterials(), EveryEffect(), num_threads),
                 frame_index);
}

// NaN, where there is none, is the same as NaN.
bool AreSame(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(NonRepeatingSensor, MakesTheFrameOfASensorWithThisFramesFirings) {
  const ScanPattern pattern = Rosettes();
  const Frame frame = ScanYard(pattern, kFrame, 1);
  ExpectSameBytes(frame, ScanYard(Frozen(pattern, kFrame), kFrame, 1));
  EXPECT_NE(frame.y, ScanYard(Frozen(pattern, 0), kFrame, 1).y);
}

TEST(NonRepeatingSensor, MakesTheSameBytesInAnyOrderAndAtAnyNumberOfThreads) {
  const ScanPattern pattern = Rosettes();
  const Frame alone = ScanYard(pattern, kFrame, 1);
  ExpectSameBytes(alone, ScanYard(pattern, kFrame, 4));
  Simulator simulator(Yard(), pattern, BoardMaterials(), EveryEffect(), 2);
  Frame frame;
  for (std::uint32_t index = 0; index <= kFrame; ++index) simulator.Scan(index, frame);
  ExpectSameBytes(alone, frame);
  const auto begun = simulator.Begin(kFrame);
  const auto later = simulator.Begin(kFrame + 1);
  Frame other;
  simulator.Scan(*later, other);
  simulator.Scan(*begun, frame);
  ExpectSameBytes(alone, frame);
  EXPECT_NE(other.y, frame.y);
}

TEST(NonRepeatingSensor, PutsItsPointsOnThisFramesBeams) {
  const ScanPattern pattern = Rosettes();
  const ScanPattern of_frame = PatternOfFrame(pattern, kFrame);
  const Frame frame = FrameBy(Simulator(Yard(), pattern, BoardMaterials(), {}, 1), kFrame);
  std::size_t num_points = 0;
  for (std::size_t i = 0; i < of_frame.num_firings(); ++i) {
    const std::size_t slot = of_frame.row[i] * pattern.columns + of_frame.column[i];
    EXPECT_EQ(frame.time_ns[slot], pattern.time_ns[i]);
    if (frame.outcome[slot] != Outcome::kReturned) continue;
    const Vector3 point = PointAt(frame, slot);
    ASSERT_LT((point.normalized() - DirectionOf(of_frame, i)).norm(), 1e-6);
    ++num_points;
  }
  EXPECT_GT(num_points, 900U);
}

TEST(NonRepeatingSensor, ExplainsAFiringAsItIsScanned) {
  const ScanPattern pattern = Rosettes();
  Simulator simulator(Yard(), pattern, BoardMaterials(), EveryEffect(), 1);
  Simulator frozen(Yard(), Frozen(pattern, kFrame), BoardMaterials(), EveryEffect(), 1);
  const ScanPattern of_frame = PatternOfFrame(pattern, kFrame);
  for (const std::uint32_t firing : {0U, 123U, 999U}) {
    const FiringStory story = simulator.Explain(kFrame, firing);
    const FiringStory same = frozen.Explain(kFrame, firing);
    EXPECT_LT((story.direction_sensor - DirectionOf(of_frame, firing)).norm(), 1e-6);
    EXPECT_EQ(story.slot, same.slot);
    EXPECT_EQ(story.time_ns, same.time_ns);
    EXPECT_EQ(story.origin_world, same.origin_world);
    ASSERT_EQ(story.echoes.size(), same.echoes.size());
    for (std::size_t i = 0; i < same.echoes.size(); ++i) {
      EXPECT_EQ(story.echoes[i].label, same.echoes[i].label);
      EXPECT_TRUE(AreSame(story.echoes[i].range_m, same.echoes[i].range_m));
      EXPECT_TRUE(AreSame(story.echoes[i].power_ratio, same.echoes[i].power_ratio));
      EXPECT_EQ(story.echoes[i].slot, same.echoes[i].slot);
    }
  }
}

TEST(NonRepeatingSensor, SeesOfObjectsWhatThisFramesBeamsSee) {
  const ScanPattern pattern = Rosettes();
  Simulator simulator(Yard(), pattern, BoardMaterials(), EveryEffect(), 2);
  Simulator frozen(Yard(), Frozen(pattern, kFrame), BoardMaterials(), EveryEffect(), 2);
  const std::vector<ObjectView> views = simulator.ViewObjects(kFrame);
  EXPECT_EQ(views, frozen.ViewObjects(kFrame));
  EXPECT_NE(views, simulator.ViewObjects(0));
  EXPECT_GT(views[0].firings_alone, views[0].firings_visible);
}

}  // namespace
}  // namespace railcast
