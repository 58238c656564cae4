// Velocities along beams through the whole simulator, against closed forms and differences of
// ranges.
#include "core/simulate/velocity_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/core/io/message_of.h"
#include "tests/core/simulate/measured_velocities.h"
#include "tests/support/same_frames.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

TEST(VelocityMeter, StandingThingsComeNearerByTheSensorsOwnSpeed) {
  auto world = WorldWithWallAt(50.0);
  world->velocity_chunk_mps = {30.0, 1.0, 0.0};
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  const Frame frame = ScanOnce(world, pattern, Measuring());
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    EXPECT_NEAR(TrueAt(frame, slot), -direction.dot(world->velocity_chunk_mps), kRounding_mps);
    // Without an effect of noise, what is measured is true.
    EXPECT_EQ(frame.radial_velocity_mps[slot], frame.true_radial_velocity_mps[slot]);
  });
}

// Of a plane that moves along its normal, the range changes by v / cos, and a point of it comes
// nearer by v cos.
TEST(VelocityMeter, IsTheChangeOfRangeOfAPlaneTimesTheCosineSquared) {
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  const auto world = WorldWithWallAt(40.0, {-17.0, 0.0, 0.0});
  const Frame now = ScanOnce(world, pattern, Measuring(), 0);
  const Frame later = ScanOnce(world, pattern, Measuring(), 1);
  for (std::size_t slot = 0; slot < now.num_slots(); ++slot) {
    const double change_mps =
        (static_cast<double>(later.range_m[slot]) - static_cast<double>(now.range_m[slot])) / 0.1;
    const double cosine = std::cos(static_cast<double>(now.incidence_rad[slot]));
    // float32 rounds ranges of 40 m by 2 um, over 0.1 s.
    EXPECT_NEAR(TrueAt(now, slot), change_mps * cosine * cosine, 3e-4);
  }
}

// What moves within its own plane keeps its range, but its points go by.
TEST(VelocityMeter, SeesWhatMovesAlongItsOwnSurface) {
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  const auto world = WorldWithWallAt(40.0, {0.0, 12.0, -3.0});
  const Frame frame = ScanOnce(world, pattern, Measuring());
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    EXPECT_NEAR(TrueAt(frame, slot), 12.0 * direction.y() - 3.0 * direction.z(), kRounding_mps);
  });
}

TEST(VelocityMeter, CountsTheSensorsTurnByItsLeverArm) {
  auto world = WorldWithWallAt(60.0);
  world->velocity_chunk_mps = {10.0, 0.0, 0.0};
  world->yaw_rate_radps = 0.5;
  SimulatorSpec spec = Measuring();
  spec.vehicle_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.1, 0.05, 0.0), Vector3(2.0, 1.5, 3.0));
  const ScanPattern pattern = MakeRaster(30, 10, 1);
  const Frame frame = ScanOnce(world, pattern, spec, 2);
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double time_s) {
    const Eigen::AngleAxisd turn(0.5 * time_s, Vector3::UnitZ());
    const Vector3 arm_m = turn * spec.vehicle_from_sensor.translation();
    const Vector3 origin_mps = world->velocity_chunk_mps + 0.5 * Vector3::UnitZ().cross(arm_m);
    const Vector3 beam = turn * (spec.vehicle_from_sensor.linear() * direction);
    // Linear between 10 ms: w^3 r dt^2 / 8; poses are rounded to 1e-6 rad.
    EXPECT_NEAR(TrueAt(frame, slot), -beam.dot(origin_mps), 1e-4);
  });
}

SimulatorSpec Noisy(const VelocitySpec& velocity) {
  SimulatorSpec spec = Measuring(velocity);
  spec.detector.seed = 11;
  spec.detector.effects = {.noise = true};
  return spec;
}

TEST(VelocityMeter, NoiseIsNormalWithTheGivenSigma) {
  const Frame frame = ScanOnce(WorldWithWallAt(30.0, {5.0, 0.0, 0.0}), MakeRaster(60, 30, 0.25),
                               Noisy({.sigma_mps = 0.25, .max_mps = 100.0}));
  double sum = 0.0;
  double squares = 0.0;
  double beyond = 0.0;
  const auto num = static_cast<double>(frame.num_slots());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double n =
        (static_cast<double>(frame.radial_velocity_mps[slot]) - TrueAt(frame, slot)) / 0.25;
    sum += n;
    squares += n * n;
    beyond += std::abs(n) > 1.959964 ? 1.0 : 0.0;
  }
  // Four standard errors of 28,800 draws.
  EXPECT_NEAR(sum / num, 0.0, 4.0 / std::sqrt(num));
  EXPECT_NEAR(squares / num, 1.0, 4.0 * std::sqrt(2.0 / num));
  EXPECT_NEAR(beyond / num, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / num));
}

TEST(VelocityMeter, FoldsWhatIsFasterThanTheUnambiguousVelocity) {
  const ScanPattern pattern = MakeRaster(10, 10, 1);
  for (const auto& [speed_mps, folded_mps] : std::vector<std::pair<double, double>>{
           {9.0, 9.0}, {11.0, -9.0}, {-11.0, 9.0}, {45.0, 5.0}}) {
    const Frame frame = ScanOnce(WorldWithWallAt(50.0, {speed_mps, 0.0, 0.0}), pattern,
                                 Measuring({.sigma_mps = 0.0, .max_mps = 10.0}));
    ForEachFiring(frame, pattern,
                  [&, folded = folded_mps, speed = speed_mps](std::size_t slot,
                                                              const Vector3& direction, double) {
                    const double true_mps = speed * direction.x();
                    EXPECT_NEAR(TrueAt(frame, slot), true_mps, kRounding_mps);
                    EXPECT_NEAR(static_cast<double>(frame.radial_velocity_mps[slot]),
                                true_mps - speed + folded, kRounding_mps);
                  });
  }
}

TEST(VelocityMeter, ReportsMultiplesOfItsStep) {
  const Frame frame = ScanOnce(WorldWithWallAt(50.0, {7.0, 2.0, 0.0}), MakeRaster(20, 10, 0.5),
                               Noisy({.sigma_mps = 0.03, .max_mps = 100.0, .step_mps = 0.125}));
  double most_off_mps = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double steps = static_cast<double>(frame.radial_velocity_mps[slot]) / 0.125;
    EXPECT_EQ(steps, std::round(steps));
    most_off_mps = std::max(most_off_mps, std::abs(steps * 0.125 - TrueAt(frame, slot)));
  }
  EXPECT_GT(most_off_mps, 0.0625);
  EXPECT_LT(most_off_mps, 0.0625 + 5.0 * 0.03);
}

TEST(VelocityMeter, KnowsWhatWasLostButMeasuresOnlyPoints) {
  SimulatorSpec spec = Noisy({.sigma_mps = 0.03, .max_mps = 100.0});
  spec.detector.effects.sensor_dropout = true;
  spec.detector.plausibility.dropout_probability = 0.5;
  const Frame frame = ScanOnce(WorldWithWallAt(50.0, {7.0, 0.0, 0.0}), MakeRaster(20, 10, 1), spec);
  std::size_t num_lost = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_NEAR(TrueAt(frame, slot), 7.0, 0.2);
    EXPECT_EQ(std::isnan(frame.radial_velocity_mps[slot]), std::isnan(frame.x[slot]));
    num_lost += std::isnan(frame.x[slot]) ? 1 : 0;
  }
  EXPECT_GT(num_lost, 50U);
}

TEST(VelocityMeter, SlotsWithoutAnEchoHaveNoVelocity) {
  SimulatorSpec spec = Measuring();
  spec.detector.effects = {.surface_response = true, .detection = true};
  spec.detector.receiver.return_mode = ReturnMode::kDual;
  const Frame frame = ScanOnce(WorldWithWallAt(50.0), MakeRaster(4, 4, 1), spec);
  ASSERT_EQ(frame.returns, 2U);
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
    EXPECT_EQ(TrueAt(frame, slot), 0.0);
    EXPECT_TRUE(std::isnan(frame.radial_velocity_mps[slot + 1]));
    EXPECT_TRUE(std::isnan(frame.true_radial_velocity_mps[slot + 1]));
  }
}

TEST(VelocityMeter, GivesTheSameBytesAtAnyNumberOfThreads) {
  auto world = WorldWithWallAt(40.0, {-17.0, 3.0, 0.0});
  world->velocity_chunk_mps = {9.0, 0.0, 0.0};
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  const SimulatorSpec spec = Noisy({.sigma_mps = 0.03, .max_mps = 20.0, .step_mps = 0.01});
  const Frame one = ScanOnce(world, pattern, spec, 5, 1);
  ASSERT_TRUE(one.has_velocity);
  ExpectSameBytes(one, ScanOnce(world, pattern, spec, 5, 4));
}

TEST(VelocityMeter, LeavesAllElseAsItIsWithout) {
  auto world = WorldWithWallAt(40.0, {-17.0, 3.0, 0.0});
  const ScanPattern pattern = MakeRaster(60, 30, 0.5);
  SimulatorSpec spec = Noisy({.sigma_mps = 0.03, .max_mps = 20.0});
  const Frame with = ScanOnce(world, pattern, spec, 5);
  spec.detector.velocity.reset();
  const Frame without = ScanOnce(world, pattern, spec, 5);
  EXPECT_FALSE(without.has_velocity);
  EXPECT_TRUE(without.radial_velocity_mps.empty());
  ExpectSameBytes(with, without);
}

TEST(VelocityMeter, AHostsSceneHasNone) {
  const auto world = WorldWithWallAt(40.0);
  const ScanPattern pattern = MakeRaster(10, 10, 1);
  Simulator simulator(world, pattern, TestMaterials(), Measuring(), 1);
  Frame frame = FrameBy(simulator);
  ASSERT_TRUE(frame.has_velocity);
  simulator.VisitScene(0, [&](const SceneOfFrame& scene) {
    simulator.Scan(0, {scene.caster, scene.window_from_world, scene.surfaces}, frame);
  });
  EXPECT_FALSE(frame.has_velocity);
  EXPECT_TRUE(frame.true_radial_velocity_mps.empty());
}

TEST(VelocityMeter, RefusesVelocitiesThatMakeNoSense) {
  const auto fault_of = [](const VelocitySpec& velocity) -> std::string {
    return MessageOf([&] { CheckDetectorSpec({.velocity = velocity}); });
  };
  EXPECT_EQ(fault_of({.sigma_mps = -0.1, .max_mps = 100.0}),
            "/velocity/sigma_mps: must be >= 0 and <= 100 (got -0.1)");
  EXPECT_EQ(fault_of({.sigma_mps = 0.1, .max_mps = 0.0}),
            "/velocity/max_mps: must be > 0 and <= 1000 (got 0)");
  EXPECT_EQ(fault_of({.sigma_mps = 0.1, .max_mps = 100.0, .step_mps = 11.0}),
            "/velocity/step_mps: must be >= 0 and <= 10 (got 11)");
}

}  // namespace
}  // namespace railcast
