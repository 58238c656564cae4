#include "core/motion/odometer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/motion/imu.h"
#include "tests/core/motion/lines.h"

namespace railcast {
namespace {

/// A vehicle that stands for 2 s, speeds up at 0.5 m/s^2 to 10 m/s, and brakes at 0.8 m/s^2 from 30
/// s on.
ScenarioSpec StartAndStop() {
  ScenarioSpec spec = StraightScenario();
  Drive({SpeedAt(0, 0), SpeedAt(2, 0), SpeedAt(22, 10), SpeedAt(30, 10), SpeedAt(42.5, 0)}, spec);
  return spec;
}
constexpr double kSpeedingUp_m = 100.0;
constexpr double kCruising_m = 80.0;
constexpr double kSlowingDown_m = 62.5;

std::int64_t AtNs(double time_s) {
  return static_cast<std::int64_t>(std::llround(time_s * 1e9));
}

OdometerSample SampleAt(const ScenarioSpec& scenario, const OdometerSpec& spec, double time_s) {
  const auto world = MakeWorld(scenario);
  return MeasureOdometer(spec, TrackOdometry(*world), *world,
                         static_cast<std::uint64_t>(std::llround(time_s * spec.rate_hz)));
}

TEST(TrackOdometry, KnowsDistanceSpeedAndHowTheyCameAbout) {
  const auto world = MakeWorld(StartAndStop());
  const TrackOdometry odometry(*world);
  EXPECT_EQ(odometry.At(*world, AtNs(1.0)).distance_m, 0.0);
  const TrackOdometry::State cruising = odometry.At(*world, AtNs(25.0));
  EXPECT_NEAR(cruising.distance_m, kSpeedingUp_m + 30.0, 1e-9);
  EXPECT_NEAR(cruising.speed_mps, 10.0, 1e-9);
  EXPECT_NEAR(cruising.speeding_up_m, kSpeedingUp_m, 1e-9);
  EXPECT_NEAR(cruising.work_m2_per_s2, 50.0, 1e-9);
  const TrackOdometry::State at_end = odometry.At(*world, AtNs(60.0));
  EXPECT_NEAR(at_end.distance_m, kSpeedingUp_m + kCruising_m + kSlowingDown_m, 1e-9);
  EXPECT_NEAR(at_end.slowing_down_m, kSlowingDown_m, 1e-9);
  EXPECT_NEAR(at_end.work_m2_per_s2, 0.0, 1e-9);
}

// A track 4 m outside an arc of 400 m is longer than the alignment by 1 %; over a gradient of 30
// permil a track is longer than its plan by 0.45 permil.
TEST(TrackOdometry, IsMeasuredAlongTheVehiclesOwnTrackInSpace) {
  ScenarioSpec spec = BareLine({{ElementType::kArc, 1000.0, 400.0}});
  spec.world.tracks = {{.name = "main", .offset_m = -4.0}};
  spec.world.alignment.gradients_permil = {{0.0, 30.0}};
  Drive({SpeedAt(0, 10)}, spec);
  const auto world = MakeWorld(spec);
  const TrackOdometry::State state = TrackOdometry(*world).At(*world, AtNs(20.0));
  const double expected_m = std::hypot(200.0 * 404.0 / 400.0, 200.0 * 0.03);
  // The chords between samples of the track every metre are too short by 1 / (24 R^2).
  EXPECT_NEAR(state.distance_m, expected_m, expected_m / (24.0 * 400.0 * 400.0) + 1e-6);
  EXPECT_NEAR(state.speed_mps, expected_m / 20.0, 1e-5);
  EXPECT_NEAR(state.work_m2_per_s2, kGravity_mps2 * 6.0, 1e-6);
}

TEST(TrackOdometry, GoesOnWhereACommandChangesTheSpeed) {
  const auto world = MakeWorld(StartAndStop());
  const TrackOdometry odometry(*world);
  const auto braking = world->WithVehicleSpeed(AtNs(25.0), 4.0, 1.0);
  const auto again = braking->WithVehicleSpeed(AtNs(28.0), 6.0, 0.5);
  EXPECT_NEAR(odometry.At(*braking, AtNs(25.0)).distance_m, kSpeedingUp_m + 30.0, 1e-9);
  // From 10 to 7 m/s in 3 s, and then up to 6 m/s: that is further down at 0.5 m/s^2.
  const TrackOdometry::State state = odometry.At(*again, AtNs(40.0));
  EXPECT_NEAR(state.slowing_down_m, 25.5 + 13.0, 1e-9);
  EXPECT_NEAR(state.speeding_up_m, kSpeedingUp_m, 1e-9);
  EXPECT_NEAR(state.distance_m, kSpeedingUp_m + 30.0 + 25.5 + 13.0 + 60.0, 1e-9);
  EXPECT_NEAR(state.work_m2_per_s2, 18.0, 1e-9);
}

TEST(TrackOdometry, CountsBackwardsRunsLikeForwardOnes) {
  ScenarioSpec spec = StartAndStop();
  spec.vehicle.start_s_m = 900.0;
  spec.vehicle.motion.reverse = true;
  const auto world = MakeWorld(spec);
  const TrackOdometry::State state = TrackOdometry(*world).At(*world, AtNs(25.0));
  EXPECT_NEAR(state.distance_m, kSpeedingUp_m + 30.0, 1e-9);
  EXPECT_NEAR(state.speed_mps, 10.0, 1e-9);
}

TEST(WheelTravel, HasTheGivenShareOfSlipOnlyWhileTheSpeedChanges) {
  const TrackOdometry::State state{
      .distance_m = 1000.0, .speeding_up_m = 200.0, .slowing_down_m = 300.0};
  EXPECT_DOUBLE_EQ(WheelTravel_m({}, state), 1000.0);
  EXPECT_DOUBLE_EQ(WheelTravel_m({.traction_slip_share = 0.02}, state), 1004.0);
  EXPECT_DOUBLE_EQ(WheelTravel_m({.braking_slip_share = 0.1}, state), 970.0);
}

// Braking from v at the deceleration a over v^2 / 2a: the wheel turns by c a / (mu g) less, which
// adds up to c v^2 / (2 mu g), however strongly it brakes.
TEST(WheelTravel, CreepsInProportionToTheAdhesionUsed) {
  ScenarioSpec spec = StraightScenario();
  Drive({SpeedAt(0, 20), SpeedAt(10, 20), SpeedAt(30, 0)}, spec);
  const auto world = MakeWorld(spec);
  const OdometerSpec odometer{.adhesion = 0.15, .creep_at_adhesion = 0.02};
  const TrackOdometry::State state = TrackOdometry(*world).At(*world, AtNs(40.0));
  const double used = 1.0 / (0.15 * 9.80665);
  EXPECT_NEAR(state.distance_m - WheelTravel_m(odometer, state), 0.02 * used * 200.0, 1e-9);
}

// Uphill at a constant speed the wheel passes on m g sin(slope).
TEST(WheelTravel, CreepsOnAGradient) {
  ScenarioSpec spec = StraightScenario();
  spec.world.alignment.gradients_permil = {{0.0, 25.0}};
  Drive({SpeedAt(0, 10)}, spec);
  const auto world = MakeWorld(spec);
  const OdometerSpec odometer{.adhesion = 0.25, .creep_at_adhesion = 0.01};
  const TrackOdometry::State state = TrackOdometry(*world).At(*world, AtNs(30.0));
  EXPECT_NEAR(WheelTravel_m(odometer, state) - state.distance_m, 0.01 * 0.025 / 0.25 * 300.0, 1e-9);
}

TEST(MeasureOdometer, CountsWholePulses) {
  const OdometerSpec spec{.rate_hz = 100.0, .wheel_diameter_m = 0.9, .pulses_per_revolution = 80};
  const double pulse_m = std::numbers::pi * 0.9 / 80.0;
  for (const double time_s : {0.0, 3.21, 10.0, 24.99, 35.5}) {
    const OdometerSample sample = SampleAt(StartAndStop(), spec, time_s);
    EXPECT_EQ(sample.time_ns, AtNs(time_s));
    EXPECT_EQ(sample.pulses,
              static_cast<std::int64_t>(std::floor(sample.true_distance_m / pulse_m)));
    EXPECT_DOUBLE_EQ(sample.distance_m, pulse_m * static_cast<double>(sample.pulses));
  }
}

// The speed is that of whole pulses in 10 ms: wrong by less than one of them.
TEST(MeasureOdometer, TellsTheSpeedByThePulsesSinceTheSampleBefore) {
  const OdometerSpec spec{.rate_hz = 100.0, .wheel_diameter_m = 0.9, .pulses_per_revolution = 80};
  const double pulse_mps = std::numbers::pi * 0.9 / 80.0 * 100.0;
  int num_high = 0;
  for (int i = 0; i < 50; ++i) {
    const OdometerSample sample = SampleAt(StartAndStop(), spec, 25.0 + 0.01 * i);
    EXPECT_NEAR(sample.true_speed_mps, 10.0, 1e-9);
    EXPECT_LT(std::abs(sample.speed_mps - 10.0), pulse_mps);
    EXPECT_NEAR(std::remainder(sample.speed_mps, pulse_mps), 0.0, 1e-9);
    num_high += sample.speed_mps > 10.0;
  }
  EXPECT_GT(num_high, 10);
  EXPECT_LT(num_high, 45);
  EXPECT_EQ(SampleAt(StartAndStop(), spec, 1.0).speed_mps, 0.0);
}

TEST(MeasureOdometer, AWornWheelTurnsMoreOften) {
  const OdometerSpec spec{.wheel_diameter_m = 0.92, .true_wheel_diameter_m = 0.90};
  const OdometerSample sample = SampleAt(StartAndStop(), spec, 60.0);
  const double pulse_m = std::numbers::pi * 0.92 / 100.0;
  EXPECT_NEAR(sample.distance_m, 242.5 * 0.92 / 0.90, pulse_m);
  EXPECT_NEAR(sample.true_distance_m, 242.5, 1e-9);
}

}  // namespace
}  // namespace railcast
