#include "core/rail/objects/person_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"

namespace railcast {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kToeOff = 0.62;  ///< Phase at which the foot leaves the ground.
/// Phase at which the ankle passes below the hip, times the stride: the ankle's mean place.
constexpr double kBelowHip = 0.235;
constexpr double kHighestHip = 0.28;  ///< Phase of the foot on which the pelvis is highest.
constexpr double kClearanceToHeight = 0.012;
/// As much of the leg's length as may be used, so that the knee stays visibly bent.
constexpr double kReach = 0.9993;

struct FootAngle {
  double phase{};
  double pitch_deg{};
};
/// The foot against the ground in one cycle, toes up positive.
constexpr std::array<FootAngle, 12> kFootAngles = {{{0.00, 18.0},
                                                    {0.08, 0.0},
                                                    {0.36, 0.0},
                                                    {0.44, -6.0},
                                                    {0.50, -16.0},
                                                    {0.56, -33.0},
                                                    {0.62, -55.0},
                                                    {0.67, -62.0},
                                                    {0.74, -50.0},
                                                    {0.82, -20.0},
                                                    {0.90, 6.0},
                                                    {0.96, 17.0}}};

/// The cubic from 0 to 1 with these values and slopes at the ends.
double Hermite(double t, double begin, double begin_slope, double end, double end_slope) {
  const double rest = 1.0 - t;
  return rest * rest * ((1.0 + 2.0 * t) * begin + t * begin_slope) +
         t * t * ((3.0 - 2.0 * t) * end - rest * end_slope);
}

FootAngle FootAngleAt(int index) {
  constexpr int kCount = static_cast<int>(kFootAngles.size());
  const int cycle = index < 0 ? -1 : index / kCount;
  FootAngle angle = kFootAngles[static_cast<std::size_t>(index - cycle * kCount)];
  angle.phase += cycle;
  return angle;
}

/// Slope that keeps a cubic through neighbouring points free of overshoots (Fritsch and Butland,
/// 1984: the harmonic mean of the slopes to both sides).
double GaitSlopeAt(int index) {
  const FootAngle before = FootAngleAt(index - 1);
  const FootAngle at = FootAngleAt(index);
  const FootAngle after = FootAngleAt(index + 1);
  const double slope_before = (at.pitch_deg - before.pitch_deg) / (at.phase - before.phase);
  const double slope_after = (after.pitch_deg - at.pitch_deg) / (after.phase - at.phase);
  if (slope_before * slope_after <= 0.0) return 0.0;
  return 2.0 * slope_before * slope_after / (slope_before + slope_after);
}

double FootPitch_rad(double phase) {
  const double in_cycle = phase - std::floor(phase);
  int index = static_cast<int>(kFootAngles.size()) - 1;
  while (FootAngleAt(index).phase > in_cycle) --index;
  const FootAngle begin = FootAngleAt(index);
  const FootAngle end = FootAngleAt(index + 1);
  const double width = end.phase - begin.phase;
  return Radians(Hermite((in_cycle - begin.phase) / width, begin.pitch_deg,
                         GaitSlopeAt(index) * width, end.pitch_deg,
                         GaitSlopeAt(index + 1) * width));
}

/// A point (x, z) of the foot relative to the ankle, with the toes turned up.
Eigen::Vector2d Turned(const Eigen::Vector2d& point_m, double pitch_rad) {
  return Eigen::Rotation2Dd(pitch_rad) * point_m;
}

double StrideLength_m(double height_m, double speed_mps) {
  constexpr double kWalkingRatio_m_min = 0.0065;
  const double walking_ratio_m_min = kWalkingRatio_m_min * std::pow(height_m / 1.70, 1.5);
  const double step_m = std::sqrt(60.0 * walking_ratio_m_min * speed_mps);
  return std::min(2.0 * step_m, 0.9 * height_m);
}

/// Angles of the arm on the side whose foot is at `phase`.
ArmAngles ArmAt(double phase, double share) {
  const double forwards = -std::cos(kTwoPi * phase);
  return {Radians(-3.0 + share * (-1.0 + 20.0 * forwards)), Radians(7.0),
          Radians(14.0 + share * (8.0 + 10.0 * forwards))};
}

}  // namespace

WalkingGait::WalkingGait(const BodyMeasures& body, double steady_speed_mps)
    : body_(body),
      sole_(SoleOf(body)),
      stride_length_m_(StrideLength_m(body.height_m, steady_speed_mps)),
      full_stride_speed_mps_(std::min(0.5, 0.5 * steady_speed_mps)) {
  Check(steady_speed_mps > 0.0, "a walking person has a speed");
  // The pelvis of a man of 1.75 m rises and sinks by some 50 mm at 1.3 m/s, as in Winter's figures.
  const double stride_to_height = stride_length_m_ / body.height_m;
  hip_amplitude_m_ = 0.0137 * body.height_m * std::pow(stride_to_height / 0.811, 2.0);
  const double leg_m = kReach * (body.thigh_m() + body.shank_m());
  constexpr int kNumPhases = 400;
  double mean_hip_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kNumPhases; ++i) {
    const double phase = static_cast<double>(i) / kNumPhases;
    const FootPlace foot = FootAt(phase, 1.0);
    const double highest_m = foot.z_m + std::sqrt(leg_m * leg_m - foot.x_m * foot.x_m);
    mean_hip_m = std::min(
        mean_hip_m, highest_m - hip_amplitude_m_ * std::cos(2.0 * kTwoPi * (phase - kHighestHip)));
  }
  mean_hip_m_ = mean_hip_m;
}

WalkingGait::FootPlace WalkingGait::Rolled(double pitch_rad) const {
  const Eigen::Vector2d tip_m = sole_.tip_m - sole_.ball_m;
  const bool is_on_tip = pitch_rad < -std::atan2(tip_m.y(), tip_m.x());
  const Eigen::Vector2d pivot_m =
      pitch_rad >= 0.0 ? sole_.heel_m : (is_on_tip ? sole_.tip_m : sole_.ball_m);
  const double on_ground_m = is_on_tip ? sole_.ball_m.x() + tip_m.norm() : pivot_m.x();
  const Eigen::Vector2d turned_m = Turned(pivot_m, pitch_rad);
  return {on_ground_m - turned_m.x(), -turned_m.y(), pitch_rad};
}

double WalkingGait::AnkleHeightOnGround_m(double pitch_rad) const {
  double lowest_m = 0.0;
  for (const Eigen::Vector2d& point_m :
       {sole_.heel_back_m, sole_.heel_m, sole_.ball_m, sole_.tip_m}) {
    lowest_m = std::min(lowest_m, Turned(point_m, pitch_rad).y());
  }
  return -lowest_m;
}

WalkingGait::FootPlace WalkingGait::FootAt(double phase, double share) const {
  const double in_cycle = phase - std::floor(phase);
  const double pitch_rad = FootPitch_rad(in_cycle);
  FootPlace foot = Rolled(pitch_rad);
  if (in_cycle > kToeOff) {
    // Where it swings, it leaves and meets the ground at the speed of the rolling ankle.
    constexpr double kStep = 1e-4;
    constexpr double kSwing = 1.0 - kToeOff;
    const double begin_x_m = Rolled(FootPitch_rad(kToeOff)).x_m;
    const double end_x_m = Rolled(FootPitch_rad(0.0)).x_m;
    const double begin_slope_m =
        (begin_x_m - Rolled(FootPitch_rad(kToeOff - kStep)).x_m) / kStep * kSwing;
    const double end_slope_m = (Rolled(FootPitch_rad(kStep)).x_m - end_x_m) / kStep * kSwing;
    const double t = (in_cycle - kToeOff) / kSwing;
    foot.x_m = Hermite(t, begin_x_m, begin_slope_m, end_x_m + stride_length_m_, end_slope_m);
    foot.z_m = AnkleHeightOnGround_m(pitch_rad) +
               16.0 * t * t * (1.0 - t) * (1.0 - t) * kClearanceToHeight * body_.height_m;
  }
  foot.x_m += (kBelowHip - in_cycle) * stride_length_m_;
  if (share < 1.0) {
    const double lift_m = foot.z_m - AnkleHeightOnGround_m(foot.pitch_rad);
    foot.x_m *= share;
    foot.pitch_rad *= share;
    foot.z_m = AnkleHeightOnGround_m(foot.pitch_rad) + share * lift_m;
  }
  return foot;
}

double WalkingGait::HipHeight_m(double phase) const {
  return mean_hip_m_ + hip_amplitude_m_ * std::cos(2.0 * kTwoPi * (phase - kHighestHip));
}

void WalkingGait::PlaceFoot(std::size_t side,
                            const FootPlace& foot,
                            double offset_m,
                            PersonPose& pose) const {
  Transform placed = Pitched(-foot.pitch_rad);
  placed.translation() = Vector3(foot.x_m, kSideSigns[side] * offset_m, foot.z_m);
  StandOn(body_, side, placed, Vector3::UnitX(), pose);
}

PersonPose WalkingGait::PoseAt(double distance_m, double speed_mps) const {
  const double ramp = std::clamp(speed_mps / full_stride_speed_mps_, 0.0, 1.0);
  const double share = ramp * ramp * (3.0 - 2.0 * ramp);
  const double phase = distance_m / stride_length_m_;
  PersonPose pose;
  const double hip_m = share * HipHeight_m(phase) + (1.0 - share) * body_.hip_m;
  Transform pelvis = Pitched(Radians(2.0 * share));
  pelvis.translation().z() = hip_m;
  PlaceTrunk(body_, pelvis, {}, pose);
  // Feet come nearer to the line of travel the faster a person walks.
  const double offset_m = (1.0 - 0.4 * share) * body_.hip_offset_m;
  for (std::size_t side = 0; side < 2; ++side) {
    const double side_phase = phase + 0.5 * static_cast<double>(side);
    PlaceFoot(side, FootAt(side_phase, share), offset_m, pose);
    SwingArm(body_, side, ArmAt(side_phase, share), pose);
  }
  return pose;
}

PersonPose WalkingGait::WidestPose() const {
  FootPlace front;
  FootPlace rear;
  double front_m = -std::numeric_limits<double>::infinity();
  double rear_m = std::numeric_limits<double>::infinity();
  constexpr int kNumPhases = 200;
  for (int i = 0; i < kNumPhases; ++i) {
    FootPlace foot = FootAt(static_cast<double>(i) / kNumPhases, 1.0);
    foot.z_m = AnkleHeightOnGround_m(foot.pitch_rad);
    const double tip_m = foot.x_m + Turned(sole_.tip_m, foot.pitch_rad).x();
    const double heel_m = foot.x_m + Turned(sole_.heel_back_m, foot.pitch_rad).x();
    if (tip_m > front_m) front = foot;
    front_m = std::max(front_m, tip_m);
    if (heel_m < rear_m) rear = foot;
    rear_m = std::min(rear_m, heel_m);
  }
  PersonPose pose = PoseAt(0.0, std::numeric_limits<double>::infinity());
  const double offset_m = 0.6 * body_.hip_offset_m;
  PlaceFoot(0, front, offset_m, pose);
  PlaceFoot(1, rear, offset_m, pose);
  // Hanging arms reach farther out than swinging ones.
  for (std::size_t side = 0; side < 2; ++side) {
    ArmAngles arm = ArmAt(0.5 * static_cast<double>(side), 1.0);
    arm.spread_rad += Radians(3.0);
    SwingArm(body_, side, arm, pose);
  }
  return pose;
}

}  // namespace railcast
