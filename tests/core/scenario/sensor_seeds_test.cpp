// Every sensor has draws of its own, keyed by its name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

// Sensors of these names in one place, over open ground.
ScenarioSpec SensorsNamed(const std::vector<std::string>& names, Fidelity fidelity) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  spec.fidelity = fidelity;
  LidarSpec lidar = spec.lidar;
  lidar.scan.pattern = RasterSpec{60.0, 30.0, 0.5};
  lidar.mount.position_m = {2.0, 0.0, 2.5};
  lidar.plausibility.dropout_probability = 0.3;
  lidar.receiver.clutter_gain = 1.0;
  spec.weather.rain_rate_mmph = 50.0;
  for (const std::string& name : names) {
    lidar.name = name;
    spec.lidars.push_back(lidar);
  }
  spec.lidar = {};
  return spec;
}

std::vector<Frame> Scan(const ScenarioSpec& spec, std::uint32_t index) {
  std::vector<Frame> frames;
  for (const auto& simulator : MakeSimulators(spec, 1)) {
    simulator->Scan(index, frames.emplace_back());
  }
  return frames;
}

double Error(const Frame& frame, std::size_t slot) {
  return static_cast<double>(frame.range_m[slot]) - static_cast<double>(frame.true_range_m[slot]);
}

// Sums over the slots of two frames.
struct PairCounts {
  double num = 0.0, lost_a = 0.0, lost_b = 0.0, lost_both = 0.0;
  double num_errors = 0.0, product = 0.0, squares_a = 0.0, squares_b = 0.0;
  double clutter_both = 0.0, clutter_same = 0.0;

  void Add(const Frame& a, const Frame& b) {
    for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
      const Outcome of_a = a.outcome[slot];
      const Outcome of_b = b.outcome[slot];
      num += 1.0;
      lost_a += of_a == Outcome::kSensorDropout ? 1.0 : 0.0;
      lost_b += of_b == Outcome::kSensorDropout ? 1.0 : 0.0;
      lost_both += of_a == Outcome::kSensorDropout && of_b == of_a ? 1.0 : 0.0;
      if (of_a != of_b) continue;
      if (of_a == Outcome::kClutter) {
        clutter_both += 1.0;
        clutter_same += a.true_range_m[slot] == b.true_range_m[slot] ? 1.0 : 0.0;
      } else if (of_a == Outcome::kReturned) {
        num_errors += 1.0;
        product += Error(a, slot) * Error(b, slot);
        squares_a += Error(a, slot) * Error(a, slot);
        squares_b += Error(b, slot) * Error(b, slot);
      }
    }
  }
};

TEST(SensorSeeds, MakeTwoSensorsIndependent) {
  for (const Fidelity fidelity : {Fidelity::kPlausibility, Fidelity::kSurface}) {
    ScenarioSpec spec = SensorsNamed({"left", "right"}, fidelity);
    // The same constant errors of channels would correlate all errors of a channel.
    for (LidarSpec& lidar : spec.lidars) lidar.receiver.channel_bias_sigma_m = 0.0;
    PairCounts counts;
    for (std::uint32_t index = 0; index < 4; ++index) {
      const std::vector<Frame> frames = Scan(spec, index);
      counts.Add(frames[0], frames[1]);
    }
    ASSERT_GT(counts.num_errors, 1000.0);
    const double correlation = counts.product / std::sqrt(counts.squares_a * counts.squares_b);
    EXPECT_NEAR(correlation, 0.0, 4.0 / std::sqrt(counts.num_errors));
    const double p = 0.3 * 0.3;
    EXPECT_NEAR(counts.lost_both, p * counts.num, 4.0 * std::sqrt(counts.num * p * (1.0 - p)));
    EXPECT_EQ(counts.clutter_same, 0.0);
    EXPECT_TRUE(fidelity != Fidelity::kSurface || counts.clutter_both > 10.0);
  }
}

// Also the constant errors of channels, which are drawn once.
TEST(SensorSeeds, GiveTwoSensorsOtherConstantErrors) {
  const ScenarioSpec spec = SensorsNamed({"left", "right"}, Fidelity::kSurface);
  ScenarioSpec still = spec;
  for (LidarSpec& lidar : still.lidars) lidar.receiver.range_noise_floor_m = 0.0;
  for (LidarSpec& lidar : still.lidars) lidar.receiver.range_noise_scale_m = 0.0;
  PairCounts counts;
  const std::vector<Frame> frames = Scan(still, 0);
  counts.Add(frames[0], frames[1]);
  EXPECT_LT(std::abs(counts.product / std::sqrt(counts.squares_a * counts.squares_b)), 0.9);
}

TEST(SensorSeeds, LeaveASensorTheSameAloneAndBesideOthers) {
  for (const Fidelity fidelity : {Fidelity::kPlausibility, Fidelity::kSurface}) {
    const ScenarioSpec two = SensorsNamed({"left", "right"}, fidelity);
    const ScenarioSpec three = SensorsNamed({"top", "right", "left"}, fidelity);
    const std::string left = FrameBytes(Scan(two, 3)[0]);
    EXPECT_EQ(FrameBytes(Scan(three, 3)[2]), left);
    EXPECT_EQ(FrameBytes(Scan(PickSensor(two, "left"), 3)[0]), left);
    EXPECT_NE(FrameBytes(Scan(two, 3)[1]), left);
  }
}

TEST(SensorSeeds, DependOnNameAndSeedAlone) {
  EXPECT_EQ(SensorSeed(7, ""), 7U);
  std::set<std::uint64_t> seeds;
  for (const char* name : {"", "a", "b", "ab", "ba", "VLP-16", "VLP-16 "}) {
    for (const std::uint64_t seed : {1ULL, 2ULL, 1ULL << 32U, ~0ULL}) {
      seeds.insert(SensorSeed(seed, name));
    }
  }
  EXPECT_EQ(seeds.size(), 7U * 4U);
}

// What the air holds and the shape of the world are no sensor's own.
TEST(SensorSeeds, AreNotThoseOfTheAir) {
  const ScenarioSpec spec = SensorsNamed({"left", "right"}, Fidelity::kSurface);
  for (const LidarSpec& lidar : spec.lidars) {
    EXPECT_EQ(DetectorSpecOf(spec, lidar, {}).air_seed, spec.seed);
    EXPECT_EQ(DetectorSpecOf(spec, lidar, {}).seed, SensorSeed(spec.seed, lidar.name));
  }
}

// Haze of 2 km and more has no echo of fog on any sensor that is shipped, fog of 50 m has: fewest
// where the range cell is short, since a cell's fog scatters in proportion to its length.
TEST(ShippedSensors, SeeNoFogInHaze) {
  ScenarioSpec all = ReadScenario(ScenariosDir() / "minimal.json");
  all.fidelity = Fidelity::kSurface;
  for (const auto& file : JsonFilesIn(ScenariosDir() / "sensors")) {
    const TemporaryFolder folder;
    const auto scenario = folder.Write("a.json", R"({"version": 1, "file": ")" +
                                                     (ScenariosDir() / "minimal.json").string() +
                                                     R"(", "lidar": ")" + file.string() + R"("})");
    all.lidars.push_back(ReadScenario(scenario).lidar);
    all.lidars.back().name = file.stem();
  }
  all.lidar = {};
  const std::uint32_t fog = LabelTable(all.labels).Id("fog");
  for (const double visibility_m : {2000.0, 50.0}) {
    all.weather.visibility_m = visibility_m;
    const auto simulators = MakeSimulators(all, 1);
    for (std::size_t i = 0; i < simulators.size(); ++i) {
      Frame frame;
      simulators[i]->Scan(0, frame);
      const auto num_fog = std::ranges::count(frame.label, fog);
      if (visibility_m < 100.0) {
        EXPECT_GT(num_fog, 100) << all.lidars[i].name;
      } else {
        EXPECT_EQ(num_fog, 0) << all.lidars[i].name << " " << visibility_m;
      }
    }
  }
}

}  // namespace
}  // namespace railcast
