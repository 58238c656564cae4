#include "core/rail/motion/speed_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/rail/motion/ride.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

SpeedPoint AtTime(double time_s, double speed_mps) {
  return {time_s, std::nullopt, speed_mps};
}
SpeedPoint AtChainage(double s_m, double speed_mps) {
  return {std::nullopt, s_m, speed_mps};
}

std::string ProfileFaultOf(const MotionSpec& motion, double start_s_m = 0.0) {
  return MessageOf([&] { const SpeedProfile profile(motion, start_s_m); });
}

TEST(SpeedProfile, StandsWithoutPoints) {
  const SpeedProfile profile({}, 120.0);
  EXPECT_FALSE(profile.moves());
  EXPECT_EQ(profile.At(1000.0).s_m, 120.0);
  EXPECT_EQ(profile.At(1000.0).speed_mps, 0.0);
}

TEST(SpeedProfile, AcceleratesConstantlyBetweenTimes) {
  const SpeedProfile profile({{AtTime(0, 2), AtTime(10, 12), AtTime(20, 12)}}, 100.0);
  EXPECT_TRUE(profile.moves());
  // s = 100 + 2 t + t^2 / 2
  EXPECT_DOUBLE_EQ(profile.At(4.0).s_m, 100.0 + 8.0 + 8.0);
  EXPECT_DOUBLE_EQ(profile.At(4.0).speed_mps, 6.0);
  EXPECT_DOUBLE_EQ(profile.At(10.0).s_m, 170.0);
  EXPECT_DOUBLE_EQ(profile.At(15.0).s_m, 230.0);
}

TEST(SpeedProfile, KeepsItsSpeedAfterTheLastPoint) {
  const SpeedProfile profile({{AtTime(0, 0), AtTime(10, 8)}}, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(30.0).s_m, 40.0 + 160.0);
  EXPECT_DOUBLE_EQ(profile.At(30.0).speed_mps, 8.0);
}

TEST(SpeedProfile, KeepsTheFirstSpeedUntilTheFirstPoint) {
  const SpeedProfile by_time({{AtTime(5, 10), AtTime(15, 0)}}, 0.0);
  EXPECT_DOUBLE_EQ(by_time.At(3.0).s_m, 30.0);
  EXPECT_DOUBLE_EQ(by_time.At(15.0).s_m, 50.0 + 50.0);
  const SpeedProfile by_chainage({{AtChainage(50, 10), AtChainage(100, 0)}}, 0.0);
  EXPECT_DOUBLE_EQ(by_chainage.At(3.0).s_m, 30.0);
  EXPECT_DOUBLE_EQ(by_chainage.At(15.0).s_m, 100.0);
}

TEST(SpeedProfile, BrakesToAStopAtTheGivenChainage) {
  const SpeedProfile profile({{AtChainage(1000, 20), AtChainage(1200, 0)}}, 1000.0);
  // v^2 = 2 a s: a deceleration of 1 m/s^2 for 20 s.
  EXPECT_DOUBLE_EQ(profile.At(5.0).speed_mps, 15.0);
  EXPECT_DOUBLE_EQ(profile.At(5.0).s_m, 1000.0 + 100.0 - 12.5);
  EXPECT_DOUBLE_EQ(profile.At(20.0).s_m, 1200.0);
  EXPECT_DOUBLE_EQ(profile.At(500.0).s_m, 1200.0);
  EXPECT_DOUBLE_EQ(profile.At(500.0).speed_mps, 0.0);
}

TEST(SpeedProfile, StartsFromRestTowardsAChainage) {
  const SpeedProfile profile({{AtChainage(0, 0), AtChainage(50, 10), AtChainage(150, 10)}}, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(5.0).speed_mps, 5.0);
  EXPECT_DOUBLE_EQ(profile.At(10.0).s_m, 50.0);
  EXPECT_DOUBLE_EQ(profile.At(12.0).s_m, 70.0);
}

TEST(SpeedProfile, RunsAgainstTheChainageInReverse) {
  const SpeedProfile profile({{AtChainage(500, 10), AtChainage(400, 0)}, true}, 500.0);
  EXPECT_TRUE(profile.reverse());
  EXPECT_DOUBLE_EQ(profile.At(10.0).s_m, 425.0);
  EXPECT_DOUBLE_EQ(profile.At(10.0).speed_mps, 5.0);
  EXPECT_DOUBLE_EQ(profile.At(20.0).s_m, 400.0);
}

TEST(SpeedProfile, DoesNotMoveWhenAllSpeedsAreZero) {
  EXPECT_FALSE(SpeedProfile({{AtTime(0, 0), AtTime(9, 0)}}, 7.0).moves());
}

TEST(SpeedProfile, RefusesTimesThatDoNotIncrease) {
  EXPECT_EQ(ProfileFaultOf({{AtTime(0, 1), AtTime(5, 2), AtTime(5, 3)}}),
            "/profile/2/time_s: must be greater than 5 of the point before it (got 5)");
  EXPECT_EQ(ProfileFaultOf({{AtTime(-1, 1)}}), "/profile/0/time_s: must be >= 0 (got -1)");
}

TEST(SpeedProfile, RefusesChainagesAgainstTheDirectionOfTravel) {
  EXPECT_EQ(ProfileFaultOf({{AtChainage(10, 1), AtChainage(9.5, 2)}}),
            "/profile/1/s_m: must be greater than 10 of the point before it (got 9.5)");
  EXPECT_EQ(ProfileFaultOf({{AtChainage(10, 1), AtChainage(11, 2)}, true}, 10.0),
            "/profile/1/s_m: must be less than 10 of the point before it (got 11)");
  EXPECT_EQ(ProfileFaultOf({{AtChainage(10, 1)}}, 20.0),
            "/profile/0/s_m: must not be behind the start at 20 m (got 10)");
}

TEST(SpeedProfile, RefusesAChainageThatIsNeverReached) {
  EXPECT_EQ(ProfileFaultOf({{AtChainage(0, 5), AtChainage(50, 0), AtChainage(60, 0)}}),
            "/profile/2/s_m: is never reached, the speed being 0 up to it and at it (got 60)");
  EXPECT_EQ(ProfileFaultOf({{AtChainage(10, 0), AtChainage(20, 4)}}),
            "/profile/0/s_m: is never reached, the speed being 0 up to it and at it (got 10)");
}

TEST(SpeedProfile, RefusesAMixOfTimesAndChainages) {
  EXPECT_EQ(ProfileFaultOf({{AtTime(0, 1), AtChainage(50, 2), {}}}),
            "/profile/1: must be at a time_s like the first point (got s_m)\n"
            "/profile/2: must have exactly one of time_s and s_m (got none)");
  EXPECT_EQ(ProfileFaultOf({{{1.0, 2.0, 3.0}}}),
            "/profile/0: must have exactly one of time_s and s_m (got both)");
}

TEST(SpeedProfile, RefusesANegativeSpeed) {
  EXPECT_EQ(ProfileFaultOf({{AtTime(0, -2)}}), "/profile/0/speed_mps: must be >= 0 (got -2)");
}

TEST(SpeedProfile, ChangesToAnotherSpeedAtAConstantRateAndKeepsIt) {
  const SpeedProfile profile({{AtTime(0, 10)}}, 100.0);
  const SpeedProfile faster = profile.WithSpeedFrom(4.0, 16.0, 2.0);
  // 40 m at 10 m/s, then 10 t + t^2 for 3 s, then 16 m/s.
  EXPECT_DOUBLE_EQ(faster.At(4.0).s_m, profile.At(4.0).s_m);
  EXPECT_DOUBLE_EQ(faster.At(5.0).s_m, 140.0 + 10.0 + 1.0);
  EXPECT_DOUBLE_EQ(faster.At(5.0).speed_mps, 12.0);
  EXPECT_DOUBLE_EQ(faster.At(7.0).s_m, 140.0 + 30.0 + 9.0);
  EXPECT_DOUBLE_EQ(faster.At(9.0).s_m, 179.0 + 32.0);
  EXPECT_DOUBLE_EQ(faster.At(9.0).speed_mps, 16.0);
}

TEST(SpeedProfile, BrakesToAStandstillAfterItsBrakingDistanceInEitherDirection) {
  for (const bool reverse : {false, true}) {
    const SpeedProfile profile({{AtTime(0, 12)}, reverse}, 500.0);
    const SpeedProfile braked = profile.WithSpeedFrom(1.0, 0.0, 0.8);
    // v^2 / (2 a) = 90 m in 15 s.
    const double sign = reverse ? -1.0 : 1.0;
    EXPECT_DOUBLE_EQ(braked.At(16.0).s_m, 500.0 + sign * (12.0 + 90.0));
    EXPECT_DOUBLE_EQ(braked.At(1000.0).s_m, 500.0 + sign * 102.0);
    EXPECT_EQ(braked.At(1000.0).speed_mps, 0.0);
    EXPECT_EQ(braked.reverse(), reverse);
  }
}

TEST(SpeedProfile, MayBeChangedWhileItChanges) {
  const SpeedProfile profile({{AtTime(0, 0), AtTime(10, 10)}}, 0.0);
  const SpeedProfile braked = profile.WithSpeedFrom(4.0, 0.0, 2.0);
  // At 4 s it has travelled 8 m and moves at 4 m/s; it needs 4 m more to stop.
  EXPECT_DOUBLE_EQ(braked.At(6.0).s_m, 12.0);
  EXPECT_DOUBLE_EQ(braked.At(20.0).s_m, 12.0);
  const SpeedProfile again = braked.WithSpeedFrom(5.0, 3.0, 1.0);
  // At 5 s: 11 m and 2 m/s; 1 s later 3 m/s.
  EXPECT_DOUBLE_EQ(again.At(6.0).s_m, 13.5);
  EXPECT_DOUBLE_EQ(again.At(8.0).s_m, 19.5);
}

TEST(SpeedProfile, TellsWhenAChainageIsReached) {
  for (const bool reverse : {false, true}) {
    const double direction = reverse ? -1.0 : 1.0;
    MotionSpec motion;
    motion.reverse = reverse;
    motion.profile = {{0.0, {}, 0.0},  {10.0, {}, 8.0}, {20.0, {}, 8.0},
                      {30.0, {}, 0.0}, {40.0, {}, 0.0}, {50.0, {}, 5.0}};
    const SpeedProfile profile(motion, 1000.0);
    for (double time_s = 0.5; time_s < 80.0; time_s += 0.5) {
      if (time_s >= 29.5 && time_s <= 40.0) continue;  // It stands.
      const std::optional<double> reached_s = profile.TimeAt_s(profile.At(time_s).s_m);
      ASSERT_TRUE(reached_s.has_value()) << time_s;
      EXPECT_NEAR(*reached_s, time_s, 1e-6);
    }
    EXPECT_NEAR(profile.TimeAt_s(1000.0 + direction * 160.0).value_or(0.0), 30.0, 1e-9)
        << "when it comes to the place where it stands for a while";
    EXPECT_FALSE(profile.TimeAt_s(1000.0 - direction * 1.0).has_value()) << "behind it";
    const SpeedProfile stopped = profile.WithSpeedFrom(15.0, 0.0, 2.0);
    EXPECT_FALSE(stopped.TimeAt_s(1000.0 + direction * 120.0).has_value()) << "it stops before";
  }
}

TEST(SpeedProfile, TellsTheAccelerationThatBeginsWhereItChanges) {
  const SpeedProfile profile({{AtTime(0, 2), AtTime(10, 12), AtTime(20, 12), AtTime(24, 4)}}, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(0.0).acceleration_mps2, 1.0);
  EXPECT_DOUBLE_EQ(profile.At(10.0).acceleration_mps2, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(20.0).acceleration_mps2, -2.0);
  EXPECT_DOUBLE_EQ(profile.At(24.0).acceleration_mps2, 0.0);
}

TEST(SpeedProfile, CountsWhereTheSpeedRoseAndFellAlsoAcrossChanges) {
  const SpeedProfile profile({{AtTime(0, 2), AtTime(10, 12), AtTime(20, 12), AtTime(24, 4)}}, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(5.0).speeding_up_m, 10.0 + 12.5);
  EXPECT_DOUBLE_EQ(profile.At(15.0).speeding_up_m, 70.0);
  EXPECT_DOUBLE_EQ(profile.At(15.0).slowing_down_m, 0.0);
  EXPECT_DOUBLE_EQ(profile.At(30.0).slowing_down_m, 32.0);
  const SpeedProfile changed =
      profile.WithSpeedFrom(15.0, 10.0, 0.5).WithSpeedFrom(17.0, 14.0, 1.0);
  // 2 s from 12 to 11 m/s, then 3 s from 11 to 14.
  EXPECT_DOUBLE_EQ(changed.At(30.0).slowing_down_m, 23.0);
  EXPECT_DOUBLE_EQ(changed.At(30.0).speeding_up_m, 70.0 + 37.5);
}

constexpr Suspension kSpring{1.2, 0.2};

// x'' = w^2 (a - x) - 2 D w x', in steps so small that the classical Runge-Kutta method errs by far
// less than the test tells apart, from rest at the first acceleration.
class SpringInSteps {
 public:
  explicit SpringInSteps(double settled_mps2) : x_(settled_mps2) {}
  void Pass(double duration_s, double acceleration_mps2) {
    const int num_steps = static_cast<int>(std::ceil(duration_s / 1e-3));
    const double h = duration_s / num_steps;
    const double w = 2.0 * std::numbers::pi * kSpring.frequency_hz;
    const auto force = [&](double x, double v) {
      return w * w * (acceleration_mps2 - x) - 2.0 * kSpring.damping * w * v;
    };
    for (int i = 0; i < num_steps; ++i) {
      const double v1 = v_, f1 = force(x_, v1);
      const double v2 = v_ + 0.5 * h * f1, f2 = force(x_ + 0.5 * h * v1, v2);
      const double v3 = v_ + 0.5 * h * f2, f3 = force(x_ + 0.5 * h * v2, v3);
      const double v4 = v_ + h * f3, f4 = force(x_ + h * v3, v4);
      x_ += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
      v_ += h / 6.0 * (f1 + 2.0 * f2 + 2.0 * f3 + f4);
    }
  }
  [[nodiscard]] double x() const { return x_; }

 private:
  double x_;
  double v_ = 0.0;
};

TEST(SpeedProfile, TellsHowSomethingOnASpringFollowsItsAcceleration) {
  // Brakes, lets go, brakes harder and stands.
  const SpeedProfile profile(
      {{AtTime(0, 8), AtTime(2, 10), AtTime(5, 7), AtTime(5.6, 7), AtTime(9.1, 0)}}, 0.0);
  SpringInSteps spring(1.0);
  const double end_s[] = {2.0, 5.0, 5.6, 9.1, 40.0};
  double time_s = 0.0;
  for (const double corner_s : end_s) {
    const double acceleration_mps2 = profile.At(time_s).acceleration_mps2;
    for (int i = 0; i < 7; ++i) {
      const double step_s = (corner_s - time_s) / (7 - i);
      spring.Pass(step_s, acceleration_mps2);
      time_s = i == 6 ? corner_s : time_s + step_s;
      // What is older than 10 s is left out.
      EXPECT_NEAR(profile.SprungAcceleration_mps2(kSpring, time_s), spring.x(), 1e-6) << time_s;
    }
  }
  EXPECT_EQ(profile.SprungAcceleration_mps2(kSpring, -3.0), 1.0);
  EXPECT_EQ(profile.SprungAcceleration_mps2(kSpring, 100.0), 0.0);
  // If the stretch went on.
  SpringInSteps longer(1.0);
  longer.Pass(2.0, 1.0);
  longer.Pass(3.25, -1.0);
  EXPECT_NEAR(profile.SprungAcceleration_mps2(kSpring, 4.0, 1.25), longer.x(), 1e-6);
}

TEST(SpeedProfile, GoesOnSwingingAcrossChangesOfSpeed) {
  const SpeedProfile profile({{AtTime(0, 20), AtTime(1, 20), AtTime(11, 10)}}, 0.0);
  SpringInSteps spring(0.0);
  spring.Pass(1.0, 0.0);
  spring.Pass(0.3, -1.0);
  const SpeedProfile let_go = profile.WithSpeedFrom(1.3, 19.7, 2.0);
  EXPECT_NEAR(let_go.SprungAcceleration_mps2(kSpring, 1.3), spring.x(), 1e-6);
  spring.Pass(0.2, 0.0);
  const SpeedProfile twice = let_go.WithSpeedFrom(1.5, 0.0, 2.0).WithSpeedFrom(1.5, 30.0, 0.5);
  EXPECT_NEAR(twice.SprungAcceleration_mps2(kSpring, 1.5), spring.x(), 1e-6);
  spring.Pass(0.4, 0.5);
  EXPECT_NEAR(twice.SprungAcceleration_mps2(kSpring, 1.9), spring.x(), 1e-6);
}

}  // namespace
}  // namespace railcast
