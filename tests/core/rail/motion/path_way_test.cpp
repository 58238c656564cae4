#include "core/rail/motion/path_way.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

PathSpec PathOf(std::vector<PathPoint> points, double speed_mps) {
  PathSpec path;
  path.points = std::move(points);
  path.speed_mps = speed_mps;
  return path;
}

TEST(PathMotion, SpeedsUpTravelsAndStops) {
  // At 2 m/s^2 to 4 m/s: 4 m in 2 s; 12 m in 3 s; 4 m in 2 s.
  PathSpec path = PathOf({PathPoint{}}, 4.0);
  path.acceleration_mps2 = 2.0;
  const PathMotion motion(path, {0.0, 20.0});
  EXPECT_EQ(motion.At(-1.0).along_m, 0.0);
  EXPECT_DOUBLE_EQ(motion.At(1.0).along_m, 1.0);
  EXPECT_DOUBLE_EQ(motion.At(1.0).speed_mps, 2.0);
  EXPECT_DOUBLE_EQ(motion.At(2.0).along_m, 4.0);
  EXPECT_DOUBLE_EQ(motion.At(3.5).along_m, 10.0);
  EXPECT_DOUBLE_EQ(motion.At(3.5).speed_mps, 4.0);
  EXPECT_DOUBLE_EQ(motion.At(6.0).along_m, 19.0);
  EXPECT_DOUBLE_EQ(motion.At(7.0).along_m, 20.0);
  EXPECT_DOUBLE_EQ(motion.At(1e6).along_m, 20.0);
  EXPECT_EQ(motion.At(1e6).speed_mps, 0.0);
}

TEST(PathMotion, DoesNotReachItsSpeedOnAShortWay) {
  const PathMotion motion(PathOf({PathPoint{}}, 50.0), {0.0, 4.0});
  // At 1 m/s^2 for 2 m, then as much back to rest.
  EXPECT_DOUBLE_EQ(motion.At(2.0).along_m, 2.0);
  EXPECT_DOUBLE_EQ(motion.At(2.0).speed_mps, 2.0);
  EXPECT_DOUBLE_EQ(motion.At(4.0).along_m, 4.0);
}

TEST(PathMotion, WaitsWhereItIsTold) {
  PathPoint stop;
  stop.wait_s = 10.0;
  const PathMotion motion(PathOf({stop, PathPoint{}}, 1.0), {0.0, 4.0, 8.0});
  // 1 s and 0.5 m to speed up, 3 s for 3 m, 1 s to stop.
  EXPECT_DOUBLE_EQ(motion.At(5.0).along_m, 4.0);
  EXPECT_DOUBLE_EQ(motion.At(14.9).along_m, 4.0);
  EXPECT_EQ(motion.At(10.0).speed_mps, 0.0);
  EXPECT_DOUBLE_EQ(motion.At(16.0).along_m, 4.5);
  EXPECT_DOUBLE_EQ(motion.At(20.0).along_m, 8.0);
}

TEST(PathMotion, HasTheSpeedOfEachStretchAndSlowsDownBeforeASlowerOne) {
  PathPoint fast;
  fast.speed_mps = 5.0;
  PathPoint slow;
  slow.speed_mps = 1.0;
  const PathMotion motion(PathOf({fast, slow}, 2.0), {0.0, 50.0, 60.0});
  double greatest_slow_mps = 0.0;
  double greatest_fast_mps = 0.0;
  for (double time_s = 0.0; time_s < 60.0; time_s += 0.01) {
    const PathMotion::State state = motion.At(time_s);
    double& greatest_mps = state.along_m < 50.0 ? greatest_fast_mps : greatest_slow_mps;
    greatest_mps = std::max(greatest_mps, state.speed_mps);
  }
  EXPECT_NEAR(greatest_fast_mps, 5.0, 1e-12);
  EXPECT_NEAR(greatest_slow_mps, 1.0, 1e-12);
}

TEST(PathMotion, NeverJumpsNorExceedsItsAcceleration) {
  PathPoint stop;
  stop.wait_s = 0.4;
  PathPoint fast;
  fast.speed_mps = 7.0;
  PathSpec path = PathOf({fast, stop, PathPoint{}, PathPoint{}}, 3.0);
  path.acceleration_mps2 = 1.5;
  path.turns_back = true;
  const PathMotion motion(path, {0.0, 20.0, 21.0, 21.5, 40.0});
  constexpr double kStep_s = 1e-3;
  PathMotion::State before = motion.At(0.0);
  for (double time_s = kStep_s; time_s < 200.0; time_s += kStep_s) {
    const PathMotion::State now = motion.At(time_s);
    ASSERT_LE(std::abs(now.speed_mps - before.speed_mps), 1.5 * kStep_s + 1e-9) << time_s;
    ASSERT_NEAR(std::abs(now.along_m - before.along_m),
                0.5 * (now.speed_mps + before.speed_mps) * kStep_s, 2e-6)
        << time_s;
    ASSERT_NEAR(now.walked_m - before.walked_m, 0.5 * (now.speed_mps + before.speed_mps) * kStep_s,
                2e-6)
        << time_s;
    before = now;
  }
}

TEST(PathMotion, TurnsOnTheSpotAtEitherEnd) {
  PathSpec path = PathOf({PathPoint{}}, 1.0);
  path.turns_back = true;
  const PathMotion motion(path, {0.0, 4.0});
  EXPECT_DOUBLE_EQ(motion.At(5.0).along_m, 4.0);
  EXPECT_DOUBLE_EQ(motion.At(5.5).turned_rad, 0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(motion.At(5.5).along_m, 4.0);
  EXPECT_DOUBLE_EQ(motion.At(8.5).along_m, 2.0);
  EXPECT_DOUBLE_EQ(motion.At(8.5).turned_rad, std::numbers::pi);
  EXPECT_DOUBLE_EQ(motion.At(11.5).turned_rad, 1.5 * std::numbers::pi);
  EXPECT_NEAR(motion.At(14.5).along_m, 2.0, 1e-12);  // On the second round.
  EXPECT_NEAR(motion.At(14.5).walked_m, 10.0, 1e-12);
}

}  // namespace
}  // namespace railcast
