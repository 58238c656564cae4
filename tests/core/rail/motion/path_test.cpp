#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/rail/motion/path_way.h"
#include "core/rail/motion/track_path.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

PathPoint InTrack(double s_m, double d_m) {
  PathPoint point;
  point.s_m = s_m;
  point.d_m = d_m;
  return point;
}

PathPoint InWorld(const Eigen::Vector2d& position_m) {
  PathPoint point;
  point.x_m = position_m.x();
  point.y_m = position_m.y();
  return point;
}

constexpr double kFacing_m = 0.5;

class PathCourses : public testing::Test {
 protected:
  [[nodiscard]] PathCourse CourseOf(const TestLine& line,
                                    double s_m,
                                    double d_m,
                                    std::vector<PathPoint> points) const {
    PathSpec path;
    path.points = std::move(points);
    path.is_smooth = is_smooth_;
    return {{line.alignment(), line.network().courses.front(), s_m, d_m}, path, kFacing_m};
  }

  bool is_smooth_ = false;
};

TEST_F(PathCourses, CrossesAStraightTrackAtRightAngles) {
  const TestLine line(StraightLine(400.0));
  const PathCourse course = CourseOf(line, 100.0, 8.0, {InTrack(100.0, -8.0)});
  EXPECT_NEAR(course.length_m(), 16.0, 1e-9);
  const PathPlace middle = course.At(8.0);
  EXPECT_NEAR(middle.s_m, 100.0, 1e-6);
  EXPECT_NEAR(middle.d_m, 0.0, 1e-9);
  const AxisPoint axis = line.alignment().At(100.0);
  EXPECT_NEAR(std::remainder(middle.heading_rad - axis.heading_rad, 2.0 * std::numbers::pi),
              -0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(course.At(99.0).d_m, -8.0, 1e-9);
}

TEST_F(PathCourses, FollowsTheCurveOfTheTrackBetweenTrackCoordinates) {
  const TestLine line(CantedArc(400.0, 200.0));
  const PathCourse course = CourseOf(line, 100.0, 3.0, {InTrack(200.0, 3.0)});
  // The centre of the arc is 200 m left of the axis: 3 m left of it, the way is shorter.
  EXPECT_NEAR(course.length_m(), 100.0 * 197.0 / 200.0, 0.01);
  for (double along_m = 0.0; along_m < course.length_m(); along_m += 7.0) {
    EXPECT_NEAR(course.At(along_m).d_m, 3.0, 1e-3);
  }
}

TEST_F(PathCourses, IsStraightBetweenPointsOfTheWorld) {
  const TestLine line(CantedArc(400.0, 200.0));
  const auto in_plan = [&](double s_m, double d_m) -> Eigen::Vector2d {
    return line.alignment().WorldFromTrack(s_m, d_m).translation().head<2>();
  };
  const Eigen::Vector2d from_m = in_plan(100.0, -5.0);
  const Eigen::Vector2d to_m = in_plan(180.0, -5.0);
  const PathCourse course = CourseOf(line, 100.0, -5.0, {InWorld(to_m)});
  EXPECT_NEAR(course.length_m(), (to_m - from_m).norm(), 1e-9);
  const PathPlace middle = course.At(0.5 * course.length_m());
  EXPECT_LT((middle.position_m - 0.5 * (from_m + to_m)).norm(), 1e-9);
  // The sagitta of 80 m of the line 5 m outside the axis.
  const double half_angle_rad = 0.2;
  EXPECT_NEAR(middle.d_m, -5.0 + 205.0 * (1.0 - std::cos(half_angle_rad)), 1e-3);
  EXPECT_NEAR(middle.s_m, 140.0, 1e-3);
}

TEST_F(PathCourses, TurnsAtACornerWithinItsFacingLength) {
  const TestLine line(StraightLine(400.0));
  const PathCourse course = CourseOf(line, 100.0, 0.0, {InTrack(110.0, 0.0), InTrack(110.0, 10.0)});
  const double begin_rad = course.At(5.0).heading_rad;
  const auto turned_rad = [&](double along_m) {
    return std::remainder(course.At(along_m).heading_rad - begin_rad, 2.0 * std::numbers::pi);
  };
  EXPECT_NEAR(turned_rad(10.0 - 0.51 * kFacing_m), 0.0, 1e-9);
  EXPECT_NEAR(turned_rad(10.0), 0.25 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(turned_rad(10.0 + 0.51 * kFacing_m), 0.5 * std::numbers::pi, 1e-9);
}

TEST_F(PathCourses, ASmoothOneGoesThroughItsPointsWithoutCorners) {
  is_smooth_ = true;
  const TestLine line(StraightLine(400.0));
  const std::vector<PathPoint> points = {InTrack(110.0, 5.0), InTrack(125.0, -5.0),
                                         InTrack(140.0, 0.0)};
  const PathCourse course = CourseOf(line, 100.0, 0.0, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPlace place = course.At(course.points_along_m()[i + 1]);
    EXPECT_NEAR(place.s_m, *points[i].s_m, 1e-6);
    EXPECT_NEAR(place.d_m, *points[i].d_m, 1e-6);
  }
  constexpr double kStep_m = 0.1;
  for (double along_m = 0.0; along_m + kStep_m < course.length_m(); along_m += kStep_m) {
    const double turn_rad =
        std::remainder(course.At(along_m + kStep_m).heading_rad - course.At(along_m).heading_rad,
                       2.0 * std::numbers::pi);
    ASSERT_LT(std::abs(turn_rad), 0.1) << along_m;
  }
}

TEST_F(PathCourses, AStraightSmoothOneIsStraight) {
  is_smooth_ = true;
  const TestLine line(StraightLine(400.0));
  const PathCourse course = CourseOf(line, 100.0, 4.0, {InTrack(100.0, 2.0), InTrack(100.0, -4.0)});
  EXPECT_NEAR(course.length_m(), 8.0, 1e-9);
  EXPECT_NEAR(course.At(5.0).s_m, 100.0, 1e-9);
}

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
