#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Tests pointing, sun, dropout and the independence of effects through the whole simulator.

// A wall at 50 m, only to the right of the x axis.
std::shared_ptr<SimpleWorld> HalfAWall() {
  return WorldOfParts(
      {{{{{50, -60, -30}, {50, 0, -30}, {50, 0, 30}, {50, -60, 30}}, {{0, 1, 2}, {0, 2, 3}}},
        2,
        1}});
}

std::shared_ptr<SimpleWorld> WallAndGround() {
  auto world = HalfAWall();
  world->ground.parts.push_back({MakeFloor(-2.0F, 300.0F), 1, 2});
  return world;
}

EffectSet Surface() {
  return EffectsOfRung(Fidelity::kSurface);
}

// A beam aimed beside the edge by an angle a hits with the probability Phi(a / sigma).
TEST(PointingJitter, ScattersBeamsOverAnEdgeByTheNormalLaw) {
  SimulatorSpec spec{.detector = {.effects = {.pointing_jitter = true}}};
  spec.detector.receiver.pointing_jitter_deg = 0.05;
  const ScanPattern pattern = MakeRaster(0.4, 2.0, 0.02);
  Simulator simulator(HalfAWall(), pattern, TestMaterials(), spec, 0);
  std::vector<double> hits(pattern.columns);
  Frame frame;
  constexpr std::uint32_t kNumFrames = 40;
  for (std::uint32_t index = 0; index < kNumFrames; ++index) {
    simulator.Scan(index, frame);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (frame.outcome[slot] == Outcome::kReturned) hits[slot % pattern.columns] += 1.0;
    }
  }
  const double n = double{kNumFrames} * pattern.rows;  // 4000
  for (std::uint32_t column = 0; column < pattern.columns; ++column) {
    // Column 0 is the leftmost; the wall is on the right.
    const double beside_deg = 0.02 * (column + 0.5) - 0.2;
    const double p = 0.5 * std::erfc(-beside_deg / 0.05 / std::sqrt(2.0));
    EXPECT_NEAR(hits[column], n * p, 4.0 * std::sqrt(n * p * (1.0 - p)) + 1.0) << column;
  }
}

TEST(PointingJitter, LeavesTheReportedDirectionAsItWas) {
  SimulatorSpec spec{.detector = {.effects = {.pointing_jitter = true}}};
  spec.detector.receiver.pointing_jitter_deg = 0.5;
  const ScanPattern pattern = MakeRaster(10.0, 2.0, 0.5);
  const Frame jittered = ScanOnce(WallAndGround(), pattern, spec);
  std::size_t checked = 0;
  for (std::size_t slot = 0; slot < jittered.num_slots(); ++slot) {
    if (!HasPoint(jittered.outcome[slot])) continue;
    const double azimuth_deg = 4.75 - 0.5 * static_cast<double>(slot % pattern.columns);
    EXPECT_NEAR(DegFromRad(std::atan2(static_cast<double>(jittered.y[slot]),
                                      static_cast<double>(jittered.x[slot]))),
                azimuth_deg, 1e-4);
    ++checked;
  }
  EXPECT_GT(checked, 30U);
}

SimulatorSpec Downpour() {
  SimulatorSpec spec{.detector = {.seed = 9, .effects = Surface()}};
  spec.detector.plausibility.dropout_probability = 0.18;
  spec.detector.weather.rain_rate_mmph = 50.0;
  spec.detector.weather.visibility_m = 200.0;
  spec.detector.weather.wetness = 1.0;
  spec.detector.receiver.clutter_gain = 1.0;
  // In every beam the strongest echo would be that of the fog.
  spec.detector.receiver.return_mode = ReturnMode::kLast;
  return spec;
}

TEST(SensorDropout, HitsTheSameFiringsWhateverElseIsOn) {
  const ScanPattern pattern = MakeRaster(40.0, 20.0, 0.25);
  SimulatorSpec spec = Downpour();
  spec.detector.effects.sunlight = false;  // A missed pulse can still be a false alarm.
  const Frame all = ScanOnce(WallAndGround(), pattern, spec);
  spec.detector.effects = {.sensor_dropout = true};
  const Frame alone = ScanOnce(WallAndGround(), pattern, spec);
  double count = 0.0;
  for (std::size_t slot = 0; slot < all.num_slots(); ++slot) {
    ASSERT_EQ(all.outcome[slot] == Outcome::kSensorDropout,
              alone.outcome[slot] == Outcome::kSensorDropout)
        << slot;
    count += alone.outcome[slot] == Outcome::kSensorDropout ? 1.0 : 0.0;
  }
  const double n = static_cast<double>(all.num_slots());
  EXPECT_NEAR(count, 0.18 * n, 4.0 * std::sqrt(n * 0.18 * 0.82));
}

// Without its cause, an effect does not change a single bit.
TEST(Effects, ChangeNothingWithoutTheirCause) {
  const ScanPattern pattern = MakeRaster(40.0, 20.0, 0.5);
  SimulatorSpec spec{.detector = {.effects = Surface()}};
  spec.detector.effects.sunlight = false;  // It has false alarms at night, too: one in a million.
  const std::string all = FrameBytes(ScanOnce(WallAndGround(), pattern, spec));
  for (bool EffectSet::*effect :
       {&EffectSet::sensor_dropout, &EffectSet::surface_condition, &EffectSet::extinction,
        &EffectSet::clutter, &EffectSet::fog_echo, &EffectSet::cover, &EffectSet::halo,
        &EffectSet::range_walk, &EffectSet::interference, &EffectSet::spray, &EffectSet::saturation,
        &EffectSet::ghost}) {
    SimulatorSpec fewer = spec;
    fewer.detector.effects.*effect = false;
    EXPECT_EQ(FrameBytes(ScanOnce(WallAndGround(), pattern, fewer)), all);
  }
  EffectSet moves = Surface();
  moves.sunlight = moves.range_noise = false;
  EXPECT_NE(FrameBytes(ScanOnce(WallAndGround(), pattern, {.detector = {.effects = moves}})), all);
}

// Counts the slots that return from a surface in both frames, and expects them to agree in `field`.
std::size_t CountSameWhereBothReturn(const Frame& a,
                                     const Frame& b,
                                     const std::vector<float> Frame::*field) {
  std::size_t count = 0;
  for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
    if (a.outcome[slot] != Outcome::kReturned || b.outcome[slot] != Outcome::kReturned) continue;
    EXPECT_EQ((a.*field)[slot], (b.*field)[slot]) << slot;
    ++count;
  }
  return count;
}

TEST(Effects, LeaveTheDrawsOfOthersAlone) {
  const ScanPattern pattern = MakeRaster(40.0, 20.0, 0.5);
  const Frame all = ScanOnce(WallAndGround(), pattern, Downpour());
  // Effects that add echoes or decide on detection do not move a point of a surface that returns
  // with and without them.
  for (bool EffectSet::*effect : {&EffectSet::clutter, &EffectSet::fog_echo,
                                  &EffectSet::detection_probability, &EffectSet::sensor_dropout}) {
    SimulatorSpec fewer = Downpour();
    fewer.detector.effects.*effect = false;
    const Frame frame = ScanOnce(WallAndGround(), pattern, fewer);
    EXPECT_NE(FrameBytes(frame), FrameBytes(all));
    EXPECT_GT(CountSameWhereBothReturn(all, frame, &Frame::range_m), 100U);
  }
  // Effects that move points do not change detection.
  SimulatorSpec still = Downpour();
  still.detector.effects.range_noise = still.detector.effects.channel_bias = false;
  const Frame exact = ScanOnce(WallAndGround(), pattern, still);
  EXPECT_EQ(exact.outcome, all.outcome);
  EXPECT_EQ(CountSameWhereBothReturn(all, exact, &Frame::power_ratio),
            static_cast<std::size_t>(
                std::count(all.outcome.begin(), all.outcome.end(), Outcome::kReturned)));
}

// The figures of docs/results/validation.md about dead time on the demo's scene.

constexpr double kDeadTime_m = 0.5 * 299'792'458.0 * 7.9e-9;

struct Pairs {
  std::size_t num{};
  std::size_t num_near{};  ///< Nearer than the dead time of VLP-16 allows.
  double nearest_m = std::numeric_limits<double>::infinity();
};

Pairs CountPairs(const std::string& dead_time_ns) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  const auto file = folder.Write("scenario.json", R"({"version": 1, "file": ")" + scenarios +
                                                      R"(/st_gallen_approach.json",
    "fidelity": "footprint", "lidar": {"file": ")" + scenarios +
                                                      R"(/sensors/vlp16.json",
    "mount": {"position_m": [2.2, 0, 2.5]}, "receiver": {"return_mode": "dual", "range_at_10_percent_m": 200, "dead_time_ns": )" +
                                                      dead_time_ns + "}}}");
  const auto simulator = MakeSimulator(ReadScenario(file), 0);
  Pairs pairs;
  Frame frame;
  for (std::uint32_t index = 0; index < 5; ++index) {
    simulator->Scan(index, frame);
    for (std::size_t slot = 0; slot + 1 < frame.num_slots(); slot += 2) {
      const double apart_m = std::abs(static_cast<double>(frame.range_m[slot]) -
                                      static_cast<double>(frame.range_m[slot + 1]));
      if (std::isnan(apart_m)) continue;
      ++pairs.num;
      if (apart_m < 1.18) ++pairs.num_near;
      pairs.nearest_m = std::min(pairs.nearest_m, apart_m);
    }
  }
  return pairs;
}

TEST(DeadTimeInFrames, SeparatesTheReturnsOfAVlp16InTheDemo) {
  const Pairs without = CountPairs("0");
  const double share = static_cast<double>(without.num_near) / static_cast<double>(without.num);
  // A fifth of 9,402: what the plants of the scene make of it.
  EXPECT_GT(without.num, 5000U);
  EXPECT_NEAR(share, 0.20, 0.05);
  const Pairs with = CountPairs("7.9");
  EXPECT_EQ(with.num_near, 0U);
  EXPECT_GE(with.nearest_m, kDeadTime_m - 1e-4);
  // An echo that is lost to its forerunner may leave its place to one farther off.
  EXPECT_LE(with.num, without.num);
  EXPECT_GE(with.num, without.num - without.num_near);
}

}  // namespace
}  // namespace railcast
