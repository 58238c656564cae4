#include "core/rail/objects/person_body.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

/// The measures of a body, all as shares of its height, apart from the girths.
constexpr BodyMeasures kAdult{.height_m = 1.0,
                              .ankle_m = 0.039,
                              .knee_m = 0.285,
                              .hip_m = 0.530,
                              .waist_m = 0.615,
                              .shoulder_m = 0.818,
                              .neck_m = 0.845,
                              .chin_m = 0.870,
                              .upper_arm_m = 0.186,
                              .forearm_m = 0.146,
                              .hand_m = 0.108,
                              .hip_offset_m = 0.052,
                              .shoulder_offset_m = 0.105,
                              .shoe_length_m = 0.160,
                              .trunk_girth = 1.0,
                              .limb_girth = 1.0,
                              .head_girth = 1.0};

constexpr BodyMeasures kChild{.height_m = 1.0,
                              .ankle_m = 0.042,
                              .knee_m = 0.270,
                              .hip_m = 0.500,
                              .waist_m = 0.590,
                              .shoulder_m = 0.780,
                              .neck_m = 0.808,
                              .chin_m = 0.832,
                              .upper_arm_m = 0.183,
                              .forearm_m = 0.143,
                              .hand_m = 0.108,
                              .hip_offset_m = 0.047,
                              .shoulder_offset_m = 0.098,
                              .shoe_length_m = 0.165,
                              .trunk_girth = 0.93,
                              .limb_girth = 0.95,
                              .head_girth = 1.34};

BodyMeasures Shares(Physique physique) {
  if (physique == Physique::kChild) return kChild;
  BodyMeasures shares = kAdult;
  if (physique == Physique::kWoman) {
    shares.shoulder_offset_m = 0.099;
    shares.limb_girth = 0.95;
  }
  return shares;
}

Transform AtJoint(double x_m, double y_m, double z_m) {
  return MakeTransform(Eigen::Matrix3d::Identity(), Vector3(x_m, y_m, z_m));
}

struct TwoBones {
  double upper_m{};
  double lower_m{};
  bool bends_forwards{};  ///< As knees do; otherwise backwards, as elbows do.
};

struct PlacedBones {
  Transform upper, lower;
};

/// Places two bones from `root_m` towards `target_m`, with the joint between them pointing in the
/// direction `bend`.
PlacedBones Reach(const TwoBones& bones,
                  const Vector3& root_m,
                  const Vector3& target_m,
                  const Vector3& bend) {
  const Vector3 whole_m = target_m - root_m;
  const double shortest_m = std::abs(bones.upper_m - bones.lower_m) + 1e-6;
  const double length_m =
      std::clamp(whole_m.norm(), shortest_m, bones.upper_m + bones.lower_m - 1e-9);
  const Vector3 along = whole_m.normalized();
  const Vector3 aside = (bend - along * along.dot(bend)).normalized();
  const double to_joint_m =
      0.5 * (length_m + (bones.upper_m * bones.upper_m - bones.lower_m * bones.lower_m) / length_m);
  const double out_m =
      std::sqrt(std::max(0.0, bones.upper_m * bones.upper_m - to_joint_m * to_joint_m));
  const Vector3 joint_m = root_m + to_joint_m * along + out_m * aside;
  const Vector3 end_m = root_m + length_m * along;

  const Vector3 left = (bones.bends_forwards ? -1.0 : 1.0) * along.cross(aside);
  const auto frame = [&](const Vector3& begin_m, const Vector3& finish_m) {
    const Vector3 up = (begin_m - finish_m).normalized();
    Eigen::Matrix3d axes;
    axes << left.cross(up), left, up;
    return MakeTransform(axes, begin_m);
  };
  return {frame(root_m, joint_m), frame(joint_m, end_m)};
}

Vector3 Shoulder(const BodyMeasures& body, std::size_t side) {
  return {-0.003 * body.height_m, kSideSigns[side] * body.shoulder_offset_m,
          body.shoulder_m - body.waist_m};
}

PersonPose CrouchingPose(const BodyMeasures& body) {
  const double unit_m = body.height_m;
  PersonPose pose;
  PlaceTrunk(body, AtJoint(-0.11 * unit_m, 0.0, 0.20 * unit_m) * Pitched(Radians(24.0)),
             {Radians(22.0), Radians(-28.0)}, pose);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = kSideSigns[side];
    const Eigen::Matrix3d turned = RotationFromYawPitchRoll(sign * Radians(15.0), 0.0, 0.0);
    StandOn(body, side, MakeTransform(turned, Vector3(0.0, sign * 0.065 * unit_m, body.ankle_m)),
            Vector3(1.0, sign * 0.35, 0.0), pose);
    ReachFor(body, side, Vector3(0.16 * unit_m, sign * 0.035 * unit_m, 0.20 * unit_m),
             Vector3(-0.3, sign, -0.3), pose);
  }
  return pose;
}

PersonPose SittingPose(const BodyMeasures& body) {
  const double unit_m = body.height_m;
  PersonPose pose;
  PlaceTrunk(body, AtJoint(0.0, 0.0, 0.060 * unit_m) * Pitched(Radians(-22.0)),
             {Radians(40.0), Radians(-8.0)}, pose);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = kSideSigns[side];
    const Eigen::Matrix3d turned = RotationFromYawPitchRoll(sign * Radians(10.0), 0.0, 0.0);
    StandOn(body, side,
            MakeTransform(turned, Vector3(0.29 * unit_m, sign * 0.055 * unit_m, body.ankle_m)),
            Vector3(0.2, sign * 0.12, 1.0), pose);
    ReachFor(body, side, Vector3(0.235 * unit_m, sign * 0.035 * unit_m, 0.20 * unit_m),
             Vector3(-0.3, sign, -0.6), pose);
  }
  return pose;
}

PersonPose LyingPose(const BodyMeasures& body) {
  const double unit_m = body.height_m;
  PersonPose pose;
  const Transform upright = AtJoint(0.0, 0.0, body.hip_m);
  PlaceTrunk(body, upright, {0.0, Radians(-12.0)}, pose);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = kSideSigns[side];
    const Eigen::Matrix3d limp = RotationFromYawPitchRoll(sign * Radians(35.0), Radians(30.0), 0.0);
    StandOn(body, side,
            MakeTransform(limp, Vector3(-0.042 * unit_m, sign * 0.08 * unit_m,
                                        body.ankle_m + 0.005 * unit_m)),
            Vector3(1.0, sign * 0.3, 0.0), pose);
    SwingArm(body, side, {Radians(-9.0), Radians(20.0), Radians(6.0)}, pose);
  }
  const Transform lying = Pitched(Radians(-90.0));
  for (Transform* bone : {&pose.pelvis, &pose.chest, &pose.head}) *bone = lying * *bone;
  for (PersonPose::Limbs& limbs : pose.sides) {
    for (Transform* bone :
         {&limbs.upper_arm, &limbs.forearm, &limbs.thigh, &limbs.shank, &limbs.foot}) {
      *bone = lying * *bone;
    }
  }
  return pose;
}

}  // namespace

Sole SoleOf(const BodyMeasures& body) {
  const double ends_z_m = 0.05 * body.shoe_length_m - body.ankle_m;
  return {.heel_back_m = {-0.27 * body.shoe_length_m, ends_z_m},
          .heel_m = {-0.21 * body.shoe_length_m, -body.ankle_m},
          .ball_m = {0.40 * body.shoe_length_m, -body.ankle_m},
          .tip_m = {0.73 * body.shoe_length_m, ends_z_m}};
}

BodyMeasures MeasuresOf(Physique physique, double height_m) {
  constexpr double kManHeight_m = 1.75;
  BodyMeasures body = Shares(physique);
  for (double BodyMeasures::*length :
       {&BodyMeasures::height_m, &BodyMeasures::ankle_m, &BodyMeasures::knee_m,
        &BodyMeasures::hip_m, &BodyMeasures::waist_m, &BodyMeasures::shoulder_m,
        &BodyMeasures::neck_m, &BodyMeasures::chin_m, &BodyMeasures::upper_arm_m,
        &BodyMeasures::forearm_m, &BodyMeasures::hand_m, &BodyMeasures::hip_offset_m,
        &BodyMeasures::shoulder_offset_m, &BodyMeasures::shoe_length_m}) {
    body.*length *= height_m;
  }
  for (double BodyMeasures::*girth :
       {&BodyMeasures::trunk_girth, &BodyMeasures::limb_girth, &BodyMeasures::head_girth}) {
    body.*girth *= height_m / kManHeight_m;
  }
  return body;
}

Transform Pitched(double angle_rad) {
  return Transform(Eigen::AngleAxisd(angle_rad, Vector3::UnitY()));
}

void PlaceTrunk(const BodyMeasures& body,
                const Transform& person_from_pelvis,
                const TrunkBend& bend,
                PersonPose& pose) {
  pose.pelvis = person_from_pelvis;
  pose.chest = pose.pelvis * AtJoint(0.0, 0.0, body.waist_m - body.hip_m) * Pitched(bend.chest_rad);
  pose.head = pose.chest * AtJoint(0.0, 0.0, body.neck_m - body.waist_m) * Pitched(bend.head_rad);
}

void SwingArm(const BodyMeasures& body,
              std::size_t side,
              const ArmAngles& angles,
              PersonPose& pose) {
  PersonPose::Limbs& limbs = pose.sides[side];
  const Vector3 shoulder_m = Shoulder(body, side);
  const Transform spread(Eigen::AngleAxisd(kSideSigns[side] * angles.spread_rad, Vector3::UnitX()));
  limbs.upper_arm = pose.chest * AtJoint(shoulder_m.x(), shoulder_m.y(), shoulder_m.z()) * spread *
                    Pitched(-angles.shoulder_rad);
  limbs.forearm =
      limbs.upper_arm * AtJoint(0.0, 0.0, -body.upper_arm_m) * Pitched(-angles.elbow_rad);
}

void ReachFor(const BodyMeasures& body,
              std::size_t side,
              const Vector3& palm_m,
              const Vector3& elbow,
              PersonPose& pose) {
  const TwoBones arm{body.upper_arm_m, body.forearm_m + 0.45 * body.hand_m, false};
  const auto [upper, lower] = Reach(arm, pose.chest * Shoulder(body, side), palm_m, elbow);
  pose.sides[side].upper_arm = upper;
  pose.sides[side].forearm = lower;
}

void StandOn(const BodyMeasures& body,
             std::size_t side,
             const Transform& person_from_foot,
             const Vector3& knee,
             PersonPose& pose) {
  const Vector3 hip_m = pose.pelvis * Vector3(0.0, kSideSigns[side] * body.hip_offset_m, 0.0);
  const auto [thigh, shank] =
      Reach({body.thigh_m(), body.shank_m(), true}, hip_m, person_from_foot.translation(), knee);
  pose.sides[side].thigh = thigh;
  pose.sides[side].shank = shank;
  pose.sides[side].foot = person_from_foot;
}

PersonPose StandingPose(const BodyMeasures& body) {
  PersonPose pose;
  PlaceTrunk(body, AtJoint(0.0, 0.0, body.hip_m), {}, pose);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = kSideSigns[side];
    const Eigen::Matrix3d turned = RotationFromYawPitchRoll(sign * Radians(8.0), 0.0, 0.0);
    StandOn(body, side, MakeTransform(turned, Vector3(0.0, sign * body.hip_offset_m, body.ankle_m)),
            Vector3::UnitX(), pose);
    SwingArm(body, side, {Radians(-3.0), Radians(7.0), Radians(14.0)}, pose);
  }
  return pose;
}

PersonPose PoseOf(Posture posture, const BodyMeasures& body) {
  switch (posture) {
    case Posture::kCrouching:
      return CrouchingPose(body);
    case Posture::kSitting:
      return SittingPose(body);
    case Posture::kLying:
      return LyingPose(body);
    case Posture::kStanding:
      break;
    case Posture::kWalking:
      Check(false, "a walking person's pose is that of its gait");
  }
  return StandingPose(body);
}

}  // namespace railcast
