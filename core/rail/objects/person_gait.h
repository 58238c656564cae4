#pragma once

#include "core/rail/objects/person_body.h"

namespace railcast {

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
    double x_m{}, z_m{};  ///< Of the ankle.
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

}  // namespace railcast
