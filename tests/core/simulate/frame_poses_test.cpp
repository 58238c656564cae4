#include "core/simulate/frame_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace railcast {
namespace {

constexpr std::uint32_t kDuration_ns = 99'583'333;

// A vehicle at 40 m/s, braking at 2 m/s^2 in a curve of 300 m radius, 60 m from the origin.
Transform BrakingInACurve(std::uint32_t time_ns) {
  const double t = time_ns * 1e-9;
  const double arc_m = 40.0 * t - t * t;
  const double heading_rad = arc_m / 300.0;
  return MakeTransform(
      RotationFromYawPitchRoll(heading_rad, 0.01, 0.05),
      {60.0 + 300.0 * std::sin(heading_rad), 300.0 * (1.0 - std::cos(heading_rad)), 2.5});
}

TEST(FramePoses, StayWithinATenthOfAMillimetreBetweenKnots) {
  const FramePoses poses(kDuration_ns, &BrakingInACurve);
  double worst_m = 0.0;
  double worst_rotation = 0.0;
  for (std::uint32_t time_ns = 0; time_ns <= kDuration_ns; time_ns += 333'333) {
    PoseF change{};
    const PoseF pose = poses.At(time_ns, change);
    const Transform truth = BrakingInACurve(time_ns);
    for (int i = 0; i < 3; ++i) {
      worst_m =
          std::max(worst_m, std::abs(static_cast<double>(pose.t[i]) - truth.translation()(i)));
      for (int j = 0; j < 3; ++j) {
        worst_rotation = std::max(worst_rotation, std::abs(static_cast<double>(pose.r[3 * i + j]) -
                                                           truth.linear()(i, j)));
      }
    }
  }
  // a dt^2 / 8 with a = v^2/R = 5.3 m/s^2 and dt = 10 ms is 0.067 mm, plus float32 rounding at 64
  // m.
  EXPECT_LE(worst_m, 1e-4);
  EXPECT_LE(worst_rotation, 4e-7);
}

TEST(FramePoses, SlopeIsTheVelocity) {
  const FramePoses poses(kDuration_ns, [](std::uint32_t time_ns) {
    return MakeTransform(Eigen::Matrix3d::Identity(), {20.0 * time_ns * 1e-9, 0.0, 0.0});
  });
  PoseF change{};
  const PoseF pose = poses.At(50'000'000, change);
  EXPECT_NEAR(static_cast<double>(pose.t[0]), 1.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(change.t[0]) * 1e9, 20.0, 1e-3);
}

TEST(FramePoses, PatternsOfSecondsKeepTheirKnots) {
  constexpr std::uint32_t kLongest_ns = 4'290'000'000U;
  const FramePoses poses(kLongest_ns, [](std::uint32_t time_ns) {
    const double t = time_ns * 1e-9;
    return MakeTransform(Eigen::Matrix3d::Identity(), {t * t, 0.0, 0.0});
  });
  EXPECT_LE(poses.knot_spacing_ns(), 10'000'000U);
  PoseF change{};
  EXPECT_NEAR(static_cast<double>(poses.At(2'145'000'000U, change).t[0]), 2.145 * 2.145, 1e-4);
  EXPECT_NEAR(static_cast<double>(poses.At(kLongest_ns, change).t[0]), 4.29 * 4.29, 1e-4);
}

TEST(PosesBetween, AreAtMostTwentyMillisecondsApart) {
  struct Case {
    std::uint32_t duration_ns;
    std::size_t num;
  };
  for (const auto& [duration_ns, num] : {Case{0, 0}, Case{20'000'000, 0}, Case{20'000'001, 1},
                                         Case{kDuration_ns, 4}, Case{4'290'000'000U, 214}}) {
    const std::vector<ScanPose> poses = PosesBetween(duration_ns, [](std::uint32_t time_ns) {
      return MakeTransform(Eigen::Matrix3d::Identity(), {time_ns * 1e-9, 0.0, 0.0});
    });
    EXPECT_EQ(poses.size(), num) << duration_ns;
    std::uint32_t before_ns = 0;
    for (const ScanPose& pose : poses) {
      EXPECT_EQ(pose.world_from_sensor.translation().x(), pose.time_ns * 1e-9);
      EXPECT_GT(pose.time_ns, before_ns);
      EXPECT_LE(pose.time_ns - before_ns, 20'000'000U);
      before_ns = pose.time_ns;
    }
    EXPECT_LE(duration_ns - before_ns, 20'000'000U);
  }
}

TEST(FramePoses, AFlashHasOnePose) {
  const FramePoses poses(0, [](std::uint32_t) {
    return MakeTransform(Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0});
  });
  PoseF change{};
  EXPECT_EQ(poses.At(0, change).t[2], 3.0F);
}

}  // namespace
}  // namespace railcast
