#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <vector>

#include "railcast/objects.h"
#include "railcast/transform.h"

namespace railcast {

/// Lengths of a body that stands upright in shoes.
///
/// Adults: the segment lengths as shares of the height of Drillis and Contini (1966, "Body Segment
/// Parameters", as in Winter, "Biomechanics and Motor Control of Human Movement", fig. 4.1).
/// Children of 6 to 7 years: working values near the means of Snyder et al. (1977, "Anthropometry
/// of Infants, Children, and Youths to Age 18"), with a larger head and shorter legs.
struct BodyMeasures {
  double height_m{};
  // Heights of joints above the ground.
  double ankle_m{};
  double knee_m{};
  double hip_m{};
  double waist_m{};  ///< Where the chest bends on the pelvis.
  double shoulder_m{};
  double neck_m{};  ///< Where the head bends on the chest.
  double chin_m{};
  // Lengths of the arm between its joints, and of the hand.
  double upper_arm_m{};
  double forearm_m{};
  double hand_m{};
  // Distances of joints from the middle plane.
  double hip_offset_m{};
  double shoulder_offset_m{};
  double shoe_length_m{};
  /// How thick trunk, limbs and head are, as multiples of those of a man of 1.75 m.
  double trunk_girth{};
  double limb_girth{};
  double head_girth{};

  [[nodiscard]] double thigh_m() const { return hip_m - knee_m; }
  [[nodiscard]] double shank_m() const { return knee_m - ankle_m; }
};

/// The outline of the sole, (x, z) in the foot's frame (PersonPose), from the back of the heel
/// to the tip of the toes. All of the shoe lies above it. It is flat from the heel to the ball, and
/// both ends are bent upwards.
struct Sole {
  Eigen::Vector2d heel_back_m, heel_m, ball_m, tip_m;
};
[[nodiscard]] Sole SoleOf(const BodyMeasures& body);

/// @pre `height_m` > 0.
[[nodiscard]] BodyMeasures MeasuresOf(Physique physique, double height_m);

/// The bones of a person and where they are.
///
/// Every bone has a frame: of a person who stands upright with the arms hanging, all frames are
/// parallel to the person's, x forward, y left, z up. Origins: pelvis in the middle between the
/// hips, chest at the waist, head at the neck, all others at the joint nearer to the trunk; the
/// hand belongs to the forearm.
struct PersonPose {
  struct Limbs {
    Transform upper_arm, forearm, thigh, shank, foot;
  };
  Transform pelvis, chest, head;
  std::array<Limbs, 2> sides;  ///< Left, right.
};

/// Of the left and of the right side: the sign of y.
inline constexpr std::array<double, 2> kSideSigns = {1.0, -1.0};

[[nodiscard]] constexpr double Radians(double angle_deg) {
  return angle_deg * std::numbers::pi / 180.0;
}

/// A rotation in the sagittal plane: positive leans forwards, or swings a hanging limb backwards.
[[nodiscard]] Transform Pitched(double angle_rad);

/// Where the trunk is and how it bends: `chest_rad` at the waist, `head_rad` at the neck, both
/// positive forwards.
struct TrunkBend {
  double chest_rad{};
  double head_rad{};
};
void PlaceTrunk(const BodyMeasures& body,
                const Transform& person_from_pelvis,
                const TrunkBend& bend,
                PersonPose& pose);

/// Angles of a hanging arm, positive forwards and outwards.
struct ArmAngles {
  double shoulder_rad{};
  double spread_rad{};
  double elbow_rad{};
};
/// @pre The trunk is placed.
void SwingArm(const BodyMeasures& body,
              std::size_t side,
              const ArmAngles& angles,
              PersonPose& pose);

/// Puts the palm of the hand on `palm_m`, or as near as the arm's length lets it. The elbow points
/// in the direction `elbow`.
/// @pre The trunk is placed.
void ReachFor(const BodyMeasures& body,
              std::size_t side,
              const Vector3& palm_m,
              const Vector3& elbow,
              PersonPose& pose);

/// Puts the ankle on the origin of `person_from_foot`, or as near as the leg's length lets it. The
/// knee points in the direction `knee`.
/// @pre The trunk is placed.
void StandOn(const BodyMeasures& body,
             std::size_t side,
             const Transform& person_from_foot,
             const Vector3& knee,
             PersonPose& pose);

/// Arms hanging beside a trunk that is upright, and legs stretched.
[[nodiscard]] PersonPose StandingPose(const BodyMeasures& body);

/// Any posture but walking (person_gait.h). The ground is somewhere near z = 0: the caller shifts
/// the lowest point there.
/// - crouching: on both flat feet with the hands between the knees;
/// - sitting: on the ground with the knees drawn up and the hands on them;
/// - lying: on the back, the head towards -x.
[[nodiscard]] PersonPose PoseOf(Posture posture, const BodyMeasures& body);

}  // namespace railcast
