#include "core/rail/motion/ride.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/rail/motion/track_path.h"

namespace railcast {
namespace {

constexpr double kPivots_m = 10.4;
constexpr double kSpeed_mps = 20.0;

// One mode's variance: the integral of the track's spectrum over the wavelengths that count, times
// the square of what bogies, pivots and suspension make of each.
double ExpectedVariance(const std::function<double(double)>& spectrum,
                        const std::function<double(double)>& of_pivots,
                        const Suspension& suspension) {
  constexpr int kNumSteps = 200'000;
  const double least = 2.0 * std::numbers::pi / kLongestIrregularity_m;
  const double most = 2.0 * std::numbers::pi / kShortestIrregularity_m;
  const double step = (most - least) / kNumSteps;
  double sum = 0.0;
  for (int i = 0; i < kNumSteps; ++i) {
    const double rad_per_m = least + (i + 0.5) * step;
    const double hz = rad_per_m * kSpeed_mps / (2.0 * std::numbers::pi);
    const double ratio = hz / suspension.frequency_hz;
    const double damped = 4.0 * suspension.damping * suspension.damping * ratio * ratio;
    const double squared =
        (1.0 + damped) / ((1.0 - ratio * ratio) * (1.0 - ratio * ratio) + damped);
    const double of_axles = std::cos(0.5 * rad_per_m * Ride::kAxleDistance_m);
    const double gain = of_axles * of_pivots(rad_per_m);
    sum += spectrum(rad_per_m) * squared * gain * gain * step;
  }
  return sum / std::numbers::pi;
}

double MeanGain(double rad_per_m) {
  return std::cos(0.5 * rad_per_m * kPivots_m);
}

double SlopeGain(double rad_per_m) {
  return 2.0 / kPivots_m * std::sin(0.5 * rad_per_m * kPivots_m);
}

struct Variances {
  double vertical{}, lateral{}, yaw{}, pitch{}, roll{};
};

Variances Measured(const Ride& ride) {
  constexpr int kNumSamples = 20'000;
  constexpr double kSampling_m = 1.3;
  Variances sums;
  for (int i = 0; i < kNumSamples; ++i) {
    const RideMotion motion = ride.At(kSampling_m * i, kSpeed_mps, false);
    sums.vertical += motion.vertical_m * motion.vertical_m / kNumSamples;
    sums.lateral += motion.lateral_m * motion.lateral_m / kNumSamples;
    sums.yaw += motion.yaw_rad * motion.yaw_rad / kNumSamples;
    sums.pitch += motion.pitch_rad * motion.pitch_rad / kNumSamples;
    sums.roll += motion.roll_rad * motion.roll_rad / kNumSamples;
  }
  return sums;
}

// Bands are 4.5 % wide, over which spectrum and resonance change little: a few percent. Waves whose
// frequencies differ by that are uncorrelated over 26 km to less than a percent.
TEST(Ride, HasTheVarianceThatTheTracksSpectrumGives) {
  for (const TrackQuality quality : {TrackQuality::kGood, TrackQuality::kPoor}) {
    const TrackSpectrum track = SpectrumOf(quality);
    const auto vertical = [&](double w) { return track.Vertical(w); };
    const auto lateral = [&](double w) { return track.Lateral(w); };
    const auto cant = [&](double w) { return track.Cant(w); };
    const Variances is = Measured(Ride({quality}, 7, kPivots_m));
    const auto expect = [](double measured, double expected) {
      EXPECT_NEAR(measured, expected, 0.05 * expected);
    };
    expect(is.vertical, ExpectedVariance(vertical, MeanGain, Ride::kVertical));
    expect(is.pitch, ExpectedVariance(vertical, SlopeGain, Ride::kVertical));
    expect(is.lateral, ExpectedVariance(lateral, MeanGain, Ride::kLateral));
    expect(is.yaw, ExpectedVariance(lateral, SlopeGain, Ride::kLateral));
    expect(is.roll, ExpectedVariance(cant, MeanGain, Ride::kRoll));
  }
}

TEST(Ride, IsAFunctionOfThePlace) {
  const Ride ride({}, 7, kPivots_m);
  const Ride again({}, 7, kPivots_m);
  const Ride elsewhere({}, 8, kPivots_m);
  EXPECT_EQ(ride.At(512.5, 15.0, false).vertical_m, again.At(512.5, 15.0, false).vertical_m);
  EXPECT_NE(ride.At(512.5, 15.0, false).vertical_m, elsewhere.At(512.5, 15.0, false).vertical_m);
}

// A standing body leans and bends as the track below it: seen from the other end, it is as high,
// and everything sideways has the other sign.
TEST(Ride, StandsOnTheSameTrackInBothDirections) {
  const Ride ride({TrackQuality::kPoor}, 7, kPivots_m);
  const RideMotion forth = ride.At(300.0, 0.0, false);
  const RideMotion back = ride.At(300.0 - kPivots_m, 0.0, true);
  EXPECT_NEAR(back.vertical_m, forth.vertical_m, 1e-12);
  EXPECT_NEAR(back.lateral_m, -forth.lateral_m, 1e-12);
  EXPECT_NEAR(back.roll_rad, -forth.roll_rad, 1e-12);
  EXPECT_NEAR(back.pitch_rad, -forth.pitch_rad, 1e-12);
  EXPECT_NEAR(back.yaw_rad, forth.yaw_rad, 1e-12);
  EXPECT_GT(std::abs(forth.vertical_m), 1e-5);
}

// The springs at each pivot (those of the body and the bogies, one after the other) carry the
// moment of the inertia over the arm of half the pivots' distance.
TEST(Ride, PitchesAsTheSpringsOfPublishedVehiclesLetIt) {
  struct Published {
    double mass_kg, half_pivots_m, secondary_N_per_m, primary_N_per_m;
  };
  for (const Published& vehicle :
       {Published{32'000.0, 9.5, 0.86e6, 4.8e6}, Published{59'364.2, 5.73, 1.7716e6, 9.5984e6},
        Published{29'600.0, 9.0, 0.82e6, 3.492e6}}) {
    const double stiffness =
        1.0 / (1.0 / vehicle.secondary_N_per_m + 1.0 / vehicle.primary_N_per_m);
    const double expected_rad = vehicle.mass_kg * Ride::kAboveLinks_m /
                                (2.0 * stiffness * std::pow(vehicle.half_pivots_m, 2));
    const Ride ride({}, 7, 2.0 * vehicle.half_pivots_m);
    const auto pitch_rad = [&](double sprung_mps2, bool runs_back) {
      return ride.At(300.0, 20.0, runs_back, sprung_mps2).pitch_rad -
             ride.At(300.0, 20.0, runs_back).pitch_rad;
    };
    // Stiffer by (1.2 / 1.07)^2 and (1.2 / 1.13)^2: that of the ride is not each vehicle's.
    EXPECT_NEAR(pitch_rad(-1.0, false), expected_rad, 0.25 * expected_rad);
    EXPECT_NEAR(pitch_rad(1.3, true), -1.3 * pitch_rad(-1.0, false), 1e-15);
    const Transform pose = ride.PerfectFromVehicle({.pitch_rad = pitch_rad(-1.0, false)});
    EXPECT_LT(pose.linear().col(0).z(), 0.0) << "brakes lower the nose";
  }
}

// The front pivot rises by the mean and by half the pivots' distance times the slope.
TEST(Ride, TurnsTheVehicleAboutTheMiddleBetweenItsPivots) {
  const Ride ride({}, 7, kPivots_m);
  const Transform pose = ride.PerfectFromVehicle(
      {.lateral_m = 0.002, .vertical_m = 0.004, .yaw_rad = 0.001, .pitch_rad = -0.002});
  EXPECT_TRUE(pose.translation().isApprox(
      Vector3(0.0, 0.002 + 0.001 * kPivots_m / 2.0, 0.004 + 0.002 * kPivots_m / 2.0), 5e-3));
  EXPECT_TRUE((pose * Vector3(-kPivots_m / 2.0, 0, 0))
                  .isApprox(Vector3(-kPivots_m / 2.0, 0.002, 0.004), 1e-12));
}

// A wave of amplitude 1 m, at whose phases a derivative is sought.
RigidMotion OfWave(double rad_per_s, double phase_rad) {
  return Differentiated([=](double after_s) {
    return MakeTransform(Eigen::Matrix3d::Identity(),
                         {std::sin(rad_per_s * after_s + phase_rad), 0.0, 0.0});
  });
}

TEST(Differentiated, AWaveIsWrongByNoMoreThanItsHeaderSays) {
  for (const double rad_per_s : {1.0, 6.3, 20.0, 84.0}) {
    const double order = std::pow(rad_per_s * kDifference_s, 4);
    for (const double phase_rad : {0.0, 0.5, 1.57, 2.9}) {
      const RigidMotion motion = OfWave(rad_per_s, phase_rad);
      EXPECT_NEAR(motion.velocity_mps.x(), rad_per_s * std::cos(phase_rad),
                  rad_per_s * order / 30.0 + 1e-12);
      EXPECT_NEAR(motion.acceleration_mps2.x(), -rad_per_s * rad_per_s * std::sin(phase_rad),
                  rad_per_s * rad_per_s * order / 90.0 + 1e-10);
    }
  }
  // The bounds are those of the difference formulas, not of something worse.
  const double order = std::pow(84.0 * kDifference_s, 4);
  EXPECT_GT(std::abs(OfWave(84.0, 0.0).velocity_mps.x() - 84.0), 84.0 * order / 40.0);
}

TEST(Differentiated, RoundingFarFromTheOriginAddsNoMoreThanItsHeaderSays) {
  constexpr double kFar_m = 60'000.0;
  const double rounding_m = std::ldexp(1.0, -53) * 65'536.0;
  for (int i = 0; i < 200; ++i) {
    const double speed_mps = 20.0 + 0.1 * i;
    const RigidMotion motion = Differentiated([&](double after_s) {
      return MakeTransform(Eigen::Matrix3d::Identity(), {kFar_m + speed_mps * after_s, 0.0, 0.0});
    });
    EXPECT_NEAR(motion.acceleration_mps2.x(), 0.0,
                5.4 * rounding_m / (kDifference_s * kDifference_s));
    EXPECT_NEAR(motion.velocity_mps.x(), speed_mps, 1e-8);
  }
  EXPECT_LT(5.4 * rounding_m / (kDifference_s * kDifference_s), 3e-6);
}

// A body that turns about z at the rate a and meanwhile rolls about its own x at the rate b: its
// angular velocity is a z + b x, and its angular acceleration that of the turning x, a b (z cross
// x).
TEST(Differentiated, HasTheAngularVelocityAndAccelerationInWorldAxes) {
  constexpr double kTurn_radps = 0.8;
  constexpr double kRoll_radps = -1.7;
  for (const double time_s : {0.0, 1.3, 50.0}) {
    const RigidMotion motion = Differentiated([&](double after_s) {
      const double at_s = time_s + after_s;
      return MakeTransform(RotationFromYawPitchRoll(kTurn_radps * at_s, 0.0, kRoll_radps * at_s),
                           Vector3::Zero());
    });
    const Vector3 x(std::cos(kTurn_radps * time_s), std::sin(kTurn_radps * time_s), 0.0);
    const Vector3 z = Vector3::UnitZ();
    EXPECT_LT((motion.angular_velocity_radps - kTurn_radps * z - kRoll_radps * x).norm(), 1e-9);
    EXPECT_LT((motion.angular_acceleration_radps2 - kTurn_radps * kRoll_radps * z.cross(x)).norm(),
              1e-7);
  }
}

// Points of a turning body: a cross r, and w cross (w cross r).
TEST(RigidMotion, PointsMoveWithTheBody) {
  RigidMotion motion;
  motion.world_from_body =
      MakeTransform(RotationFromYawPitchRoll(std::acos(0.0), 0.0, 0.0), {5.0, 6.0, 7.0});
  motion.velocity_mps = {1.0, 2.0, 3.0};
  motion.acceleration_mps2 = {0.1, 0.2, 0.3};
  motion.angular_velocity_radps = {0.0, 0.0, 2.0};
  motion.angular_acceleration_radps2 = {0.0, 0.0, 0.5};
  // In world axes the point (4, 0, 1) is at (0, 4, 1) from the origin.
  EXPECT_TRUE(motion.VelocityOf_mps({4.0, 0.0, 1.0}).isApprox(Vector3(1.0 - 8.0, 2.0, 3.0), 1e-14));
  EXPECT_TRUE(motion.AccelerationOf_mps2({4.0, 0.0, 1.0})
                  .isApprox(Vector3(0.1 - 2.0, 0.2 - 16.0, 0.3), 1e-14));
}

}  // namespace
}  // namespace railcast
