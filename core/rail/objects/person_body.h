#pragma once

#include <Eigen/Core>

#include "railcast/objects.h"

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

/// The outline of the sole, (x, z) in the foot's frame (person_pose.h), from the back of the heel
/// to the tip of the toes. All of the shoe lies above it. It is flat from the heel to the ball, and
/// both ends are bent upwards.
struct Sole {
  Eigen::Vector2d heel_back_m, heel_m, ball_m, tip_m;
};
[[nodiscard]] Sole SoleOf(const BodyMeasures& body);

/// @pre `height_m` > 0.
[[nodiscard]] BodyMeasures MeasuresOf(Physique physique, double height_m);

}  // namespace railcast
