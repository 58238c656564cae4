#include "core/motion/imu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "tests/core/motion/lines.h"

namespace railcast {
namespace {

// Of differences of poses within 2 km of the origin: 5.4 x 2.3e-13 m / (4 ms)^2, and some roundings
// within each pose.
constexpr double kTolerance_mps2 = 1e-6;
constexpr double kTolerance_radps = 1e-9;

Transform Placed(double x_m, double y_m, double z_m) {
  return MakeTransform(Eigen::Matrix3d::Identity(), {x_m, y_m, z_m});
}

ImuSample TrueSampleAt(const ScenarioSpec& spec,
                       double time_s,
                       const Transform& vehicle_from_imu = Transform::Identity()) {
  const auto time_ns = static_cast<std::int64_t>(std::llround(time_s * 1e9));
  return TrueImuSample(MakeWorld(spec)->VehicleMotion(time_ns), vehicle_from_imu, time_ns);
}

void ExpectNear(const Vector3& got, const Vector3& expected, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(got(axis), expected(axis), tolerance) << axis;
}

TEST(TrueImuSample, StandingOnLevelTrackIsGravityAlone) {
  const ImuSample sample = TrueSampleAt(StraightScenario(), 1.0, Placed(2.0, 0.5, 3.0));
  ExpectNear(sample.true_specific_force_mps2, {0.0, 0.0, 9.80665}, kTolerance_mps2);
  ExpectNear(sample.true_angular_velocity_radps, Vector3::Zero(), kTolerance_radps);
}

TEST(TrueImuSample, IsInTheAxesOfItsMount) {
  const Transform upside_down =
      MakeTransform(RotationFromYawPitchRoll(0.0, 0.0, std::numbers::pi), Vector3::Zero());
  const ImuSample sample = TrueSampleAt(StraightScenario(), 1.0, upside_down);
  ExpectNear(sample.true_specific_force_mps2, {0.0, 0.0, -9.80665}, kTolerance_mps2);
}

TEST(TrueImuSample, StandingOnAGradientLeansBack) {
  ScenarioSpec spec = StraightScenario();
  spec.world.alignment.gradients_permil = {{0.0, 30.0}};
  const ImuSample sample = TrueSampleAt(spec, 0.0);
  const double slope_rad = std::atan(0.03);
  ExpectNear(sample.true_specific_force_mps2,
             {9.80665 * std::sin(slope_rad), 0.0, 9.80665 * std::cos(slope_rad)}, kTolerance_mps2);
}

TEST(TrueImuSample, BrakingIsFeltFromTheInstantAtWhichItBegins) {
  ScenarioSpec spec = StraightScenario();
  Drive({SpeedAt(0, 20), SpeedAt(10, 20), SpeedAt(20, 8)}, spec);
  const auto forward_at = [&](double time_s) {
    return TrueSampleAt(spec, time_s).true_specific_force_mps2.x();
  };
  EXPECT_NEAR(forward_at(9.999), 0.0, kTolerance_mps2);
  EXPECT_NEAR(forward_at(10.0), -1.2, kTolerance_mps2);
  EXPECT_NEAR(forward_at(19.999), -1.2, kTolerance_mps2);
  EXPECT_NEAR(forward_at(20.0), 0.0, kTolerance_mps2);
}

/// An arc of 600 m to the left, with the cant that the rule gives at 90 km/h.
ScenarioSpec CantedArcScenario() {
  ScenarioSpec spec = BareLine({{ElementType::kArc, 2000.0, 600.0}});
  spec.world.alignment.speed_limits_kmph = {{0.0, 90.0}};
  Drive({SpeedAt(0, 20)}, spec);
  return spec;
}

// The track leans by the angle c into the curve: of v^2 / R and gravity, each has a share in the
// axes of the leaning vehicle, and so has v / R.
TEST(TrueImuSample, InACantedCurveHasTheClosedForm) {
  const ScenarioSpec spec = CantedArcScenario();
  const ImuSample sample = TrueSampleAt(spec, 20.0);
  const double lean_rad = -Alignment(spec.world.alignment).At(500.0).cant_rad;
  EXPECT_GT(lean_rad, 0.04);
  const double sideways_mps2 = 20.0 * 20.0 / 600.0;
  const double sine = std::sin(lean_rad);
  const double cosine = std::cos(lean_rad);
  ExpectNear(
      sample.true_specific_force_mps2,
      {0.0, cosine * sideways_mps2 - sine * 9.80665, sine * sideways_mps2 + cosine * 9.80665},
      kTolerance_mps2);
  ExpectNear(sample.true_angular_velocity_radps, {0.0, -sine * 20.0 / 600.0, cosine * 20.0 / 600.0},
             kTolerance_radps);
}

// A body on pivots lies along a chord: the front pivot, at its origin, is on the arc, and the body
// is turned outwards by asin(a / 2R) against the tangent there.
TEST(TrueImuSample, OnPivotsIsInTheAxesOfTheChord) {
  ScenarioSpec spec = BareLine({{ElementType::kArc, 1000.0, -400.0}});
  spec.vehicle.pivot_distance_m = 19.0;
  Drive({SpeedAt(0, 10)}, spec);
  const double turn_rad = std::asin(0.5 * 19.0 / 400.0);
  const double inwards_mps2 = 100.0 / 400.0;
  const ImuSample sample = TrueSampleAt(spec, 30.0);
  ExpectNear(sample.true_specific_force_mps2,
             {-inwards_mps2 * std::sin(turn_rad), -inwards_mps2 * std::cos(turn_rad), 9.80665},
             kTolerance_mps2);
  ExpectNear(sample.true_angular_velocity_radps, {0.0, 0.0, -10.0 / 400.0}, kTolerance_radps);
}

// Every point of the vehicle circles about the same centre: beside the axis on another radius, and
// ahead of it with an acceleration that points backwards, too.
TEST(TrueImuSample, AtALeverArmHasTheCentripetalAccelerationOfItsOwnPlace) {
  ScenarioSpec spec = BareLine({{ElementType::kArc, 1000.0, 500.0}});
  Drive({SpeedAt(0, 25)}, spec);
  const double turn_radps = 25.0 / 500.0;
  const ImuSample sample = TrueSampleAt(spec, 10.0, Placed(8.0, 2.0, 3.0));
  ExpectNear(sample.true_specific_force_mps2,
             {-turn_radps * turn_radps * 8.0, turn_radps * turn_radps * (500.0 - 2.0), 9.80665},
             kTolerance_mps2);
}

// In a clothoid the curvature rises by 1 / (R L) per metre: with it v^2 times the curvature, and
// the rate of turn at a constant rate, which moves what is ahead of the origin sideways.
TEST(TrueImuSample, InATransitionHasTheAngularAccelerationOfTheClothoid) {
  ScenarioSpec spec = BareLine({{ElementType::kStraight, 200.0, {}},
                                {ElementType::kClothoid, 100.0, {}},
                                {ElementType::kArc, 500.0, 500.0}});
  Drive({SpeedAt(0, 20)}, spec);
  constexpr double kChange_per_m2 = 1.0 / (500.0 * 100.0);
  const double curvature_per_m = 60.0 * kChange_per_m2;  // After 160 m, at 260 m.
  const ImuSample sample = TrueSampleAt(spec, 8.0, Placed(5.0, 0.0, 2.0));
  const double turn_radps = 20.0 * curvature_per_m;
  EXPECT_NEAR(sample.true_angular_velocity_radps.z(), turn_radps, 1e-8);
  ExpectNear(sample.true_specific_force_mps2,
             {-turn_radps * turn_radps * 5.0,
              400.0 * curvature_per_m + 400.0 * kChange_per_m2 * 5.0, 9.80665},
             2e-6);
}

// Twice integrated, what is measured leads to where the vehicle is: over a second of a rough ride
// through a canted clothoid while braking. Simpson's rule at 1 kHz is wrong by far less.
TEST(TrueImuSample, LeadsFromOnePoseToALaterOne) {
  ScenarioSpec spec = BareLine({{ElementType::kStraight, 100.0, {}},
                                {ElementType::kClothoid, 120.0, {}},
                                {ElementType::kArc, 800.0, 400.0}});
  spec.world.alignment.speed_limits_kmph = {{0.0, 80.0}};
  spec.vehicle.pivot_distance_m = 14.0;
  spec.vehicle.ride = RideSpec{TrackQuality::kPoor};
  Drive({SpeedAt(0, 20), SpeedAt(20, 0)}, spec);
  const auto world = MakeWorld(spec);
  constexpr int kNumSteps = 1000;
  constexpr std::int64_t kBegin_ns = 1'500'000'000;
  const RigidMotion begin = world->VehicleMotion(kBegin_ns);
  Vector3 change_m = begin.velocity_mps;
  Vector3 change_mps = Vector3::Zero();
  for (int i = 0; i <= kNumSteps; ++i) {
    const double weight = i == 0 || i == kNumSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const Vector3 acceleration_mps2 =
        world->VehicleMotion(kBegin_ns + 1'000'000 * i).acceleration_mps2;
    const double left_s = 1.0 - 1.0 * i / kNumSteps;
    change_mps += weight / (3.0 * kNumSteps) * acceleration_mps2;
    change_m += weight / (3.0 * kNumSteps) * left_s * acceleration_mps2;
  }
  const RigidMotion end = world->VehicleMotion(kBegin_ns + 1'000'000'000);
  ExpectNear(end.velocity_mps - begin.velocity_mps, change_mps, 2e-4);
  ExpectNear(end.world_from_body.translation() - begin.world_from_body.translation(), change_m,
             2e-4);
  // The ride is part of it.
  spec.vehicle.ride.reset();
  EXPECT_GT((MakeWorld(spec)->VehicleMotion(kBegin_ns).acceleration_mps2 - begin.acceleration_mps2)
                .norm(),
            0.05);
}

constexpr double kRate_hz = 100.0;
constexpr std::size_t kNumImuSamples = 1 << 15;
constexpr std::size_t kClusters[] = {1, 4, 16, 64};

std::vector<Vector3> TurnErrorsOf(const ImuSpec& spec, std::uint64_t seed) {
  const ImuErrors errors(spec, seed);
  std::vector<Vector3> of_samples;
  for (std::uint64_t sample = 0; sample < kNumImuSamples; ++sample) {
    of_samples.push_back(errors.Of(sample).angular_velocity_radps);
  }
  return of_samples;
}

/// The Allan variance of three axes over averages of so many samples.
double AllanVariance(const std::vector<Vector3>& samples, std::size_t num_averaged) {
  const std::size_t num_clusters = samples.size() / num_averaged;
  double sum = 0.0;
  Vector3 before = Vector3::Zero();
  for (std::size_t cluster = 0; cluster < num_clusters; ++cluster) {
    Vector3 total = Vector3::Zero();
    for (std::size_t i = 0; i < num_averaged; ++i) total += samples[cluster * num_averaged + i];
    const Vector3 mean = total / static_cast<double>(num_averaged);
    if (cluster > 0) sum += 0.5 * (mean - before).squaredNorm() / 3.0;
    before = mean;
  }
  return sum / static_cast<double>(num_clusters - 1);
}

// Relative: five standard deviations. Half the squared difference of two averages has a variance of
// 2; neighbouring differences share an average, which raises it to 3 at most.
double AllanTolerance(double num_averaged) {
  return 5.0 * std::sqrt(3.0 * num_averaged / (3.0 * kNumImuSamples));
}

// IEEE Std 952-1997, C.1.1: N^2 / tau.
TEST(ImuErrors, NoiseDensityGivesAnAllanDeviationOfSlopeMinusOneHalf) {
  const std::vector<Vector3> errors =
      TurnErrorsOf({.rate_hz = kRate_hz, .gyroscope_noise_density_degps_per_sqrthz = 0.01}, 3);
  const double density = RadFromDeg(0.01);
  for (const std::size_t cluster : kClusters) {
    const auto num_averaged = static_cast<double>(cluster);
    const double tau_s = num_averaged / kRate_hz;
    EXPECT_NEAR(AllanVariance(errors, cluster) * tau_s / (density * density), 1.0,
                AllanTolerance(num_averaged))
        << tau_s;
  }
}

// IEEE Std 952-1997, C.1.4: K^2 tau / 3; of averages of n samples, of which steps are at the
// samples only, 1 + 1 / (2 n^2) times that.
TEST(ImuErrors, RandomWalkGivesAnAllanDeviationOfSlopeOneHalf) {
  const std::vector<Vector3> errors =
      TurnErrorsOf({.rate_hz = kRate_hz, .gyroscope_random_walk_degps2_per_sqrthz = 0.02}, 4);
  const double walk = RadFromDeg(0.02);
  for (const std::size_t cluster : kClusters) {
    const auto num_averaged = static_cast<double>(cluster);
    const double tau_s = num_averaged / kRate_hz;
    const double expected = walk * walk * tau_s / 3.0 * (1.0 + 0.5 / (num_averaged * num_averaged));
    EXPECT_NEAR(AllanVariance(errors, cluster) / expected, 1.0, AllanTolerance(num_averaged))
        << tau_s;
  }
}

TEST(ImuErrors, BiasIsTheSameInAllSamplesAndOfTheGivenSpread) {
  double squares = 0.0;
  constexpr int kNumSeeds = 2000;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const ImuErrors errors({.accelerometer_bias_mps2 = 0.3}, seed);
    EXPECT_EQ(errors.Of(5).specific_force_mps2, errors.Of(100'000).specific_force_mps2);
    EXPECT_EQ(errors.Of(5).angular_velocity_radps, Vector3::Zero());
    squares += errors.Of(5).specific_force_mps2.squaredNorm() / 3.0;
  }
  EXPECT_NEAR(squares / kNumSeeds / (0.3 * 0.3), 1.0, 5.0 * std::sqrt(2.0 / (3.0 * kNumSeeds)));
}

TEST(ImuErrors, AreIndependentBetweenAxesAndTriads) {
  const ImuErrors errors({.gyroscope_noise_density_degps_per_sqrthz = DegFromRad(0.1),
                          .accelerometer_noise_density_mps2_per_sqrthz = 0.1},
                         8);
  constexpr int kNum = 4000;
  double products[3] = {};
  for (std::uint64_t i = 0; i < kNum; ++i) {
    const auto [turn, force] = errors.Of(i);
    products[0] += turn.x() * turn.y() / kNum;
    products[1] += turn.x() * force.x() / kNum;
    products[2] += force.y() * force.z() / kNum;
  }
  // At 100 Hz each has a standard deviation of 1.
  for (const double product : products) EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(kNum));
}

}  // namespace
}  // namespace railcast
