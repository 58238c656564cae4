#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "core/rail/objects/person_body.h"
#include "railcast/objects.h"
#include "railcast/transform.h"

namespace railcast {

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
