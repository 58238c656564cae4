#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/objects.h"
#include "railcast/scene.h"
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

/// The sign of y for the left and the right side.
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

/// Any posture but walking (WalkingGait). The ground is somewhere near z = 0: the caller shifts
/// the lowest point there.
/// - crouching: on both flat feet with the hands between the knees;
/// - sitting: on the ground with the knees drawn up and the hands on them;
/// - lying: on the back, the head towards -x.
[[nodiscard]] PersonPose PoseOf(Posture posture, const BodyMeasures& body);

/// How a person walks at a steady speed on level ground.
///
/// Model: a foot stands on the ground during 62 % of the cycle, in which its sole rolls without
/// slipping, first about the heel, then flat, then about ball and tip; it then swings forwards just
/// above the ground. The angle of the foot against the ground is that of the mean of healthy adults
/// at their natural pace, less at the toes, which do not bend (Winter, "Biomechanics and Motor
/// Control of Human Gait", 1991: hip, knee and ankle angles; here as points of a smooth curve). The
/// pelvis rides on a vaulting arc as high as the stretched leg permits. Hip, knee and ankle follow:
/// their extremes differ from Winter's by up to 15 degrees (tested). The arms swing against the
/// legs (Murray et al., 1967, "Patterns of Sagittal Rotation of the Upper Limbs in Walking").
///
/// Parameters: the walking ratio, step length over cadence, is 0.0065 m per step a minute for
/// adults (Sekiya and Nagasaki, 1998), which with the cadence gives the stride at the speed. For
/// other heights H it is scaled by (H / 1.70 m)^1.5, by which steps grow as H and their rate as
/// H^-0.5. Strides are at most 0.9 H, above which the rate alone grows.
///
/// Validity: 0.5 to 2 m/s. Nobody runs. Below half its steady speed, and always below 0.5 m/s, the
/// strides shrink until the person stands at speed 0; then the feet slip.
class WalkingGait {
 public:
  /// @pre `steady_speed_mps` > 0.
  WalkingGait(const BodyMeasures& body, double steady_speed_mps);

  /// Distance in which the left foot comes to the ground twice.
  [[nodiscard]] double stride_length_m() const { return stride_length_m_; }

  /// The pose after `distance_m` at `speed_mps` >= 0. At distance 0 the left heel comes to the
  /// ground. Origin: on the ground below the pelvis, which moves at the person's speed.
  [[nodiscard]] PersonPose PoseAt(double distance_m, double speed_mps) const;

  /// A pose with every limb as far forward or backward as it ever gets.
  [[nodiscard]] PersonPose WidestPose() const;

 private:
  struct FootPlace {
    double x_m{}, z_m{};  ///< Position of the ankle.
    double pitch_rad{};   ///< Positive: toes up.
  };
  /// `phase` counts cycles from the foot's contact; `share` of a full stride.
  [[nodiscard]] FootPlace FootAt(double phase, double share) const;
  [[nodiscard]] double HipHeight_m(double phase) const;
  /// How far a stretch of ground the foot's ankle is from where it is with the sole flat.
  [[nodiscard]] FootPlace Rolled(double pitch_rad) const;
  [[nodiscard]] double AnkleHeightOnGround_m(double pitch_rad) const;
  void PlaceFoot(std::size_t side, const FootPlace& foot, double offset_m, PersonPose& pose) const;

  BodyMeasures body_;
  Sole sole_;
  double stride_length_m_{};
  double full_stride_speed_mps_{};  ///< From which on strides are full.
  double mean_hip_m_{};
  double hip_amplitude_m_{};
};

/// How the parts of a person are covered.
struct PersonDress {
  SurfaceClass skin;
  SurfaceClass clothing;      ///< Also of hair, sleeves and shoes.
  SurfaceClass outer;         ///< Surface of torso and legs.
  SurfaceClass band, helmet;  ///< Only if it wears them.
  /// Whether it has bands round and over the torso and round the legs (EN ISO 20471), and a helmet.
  bool is_hi_vis = false;
};

/// The solid of every bone, each in the bone's frame (person_body.h). Trunk, head and limbs are
/// lofts through superellipses whose half axes are working values near the medians of DIN 33402-2
/// (head 155 x 195 mm, hips 355 mm, shoulders over the arms 470 mm for a man of 1.75 m), scaled by
/// the body's girths; limbs end in domes about their joints.
struct PersonBones {
  struct Limbs {
    Model upper_arm, forearm, thigh, shank, foot;
  };
  Model pelvis, chest, head;
  Limbs limbs;  ///< The same on both sides.
};

/// Height of the top of the helmet as a multiple of the body's height.
[[nodiscard]] double HelmetHeight(Physique physique);

[[nodiscard]] PersonBones MakePersonBones(const BodyMeasures& body,
                                          Physique physique,
                                          const PersonDress& dress);

}  // namespace railcast
