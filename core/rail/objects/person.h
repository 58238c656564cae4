#pragma once

#include <cstdint>
#include <vector>

#include "core/rail/objects/object_surfaces.h"
#include "core/rail/objects/person_body.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

inline constexpr double kPersonHeight_m = 1.75;

/// Height unless the scenario gives one: man 1.75 m and woman 1.65 m, near the medians of DIN
/// 33402-2 with shoes; child of 6 to 7 years 1.20 m.
[[nodiscard]] double StandardHeight_m(Physique physique);

/// The pace of people who walk by themselves, 1.3 m/s for a man of 1.75 m, as the root of the
/// height (Winter, 1991: natural cadence).
[[nodiscard]] double NaturalPace_mps(double height_m);

/// A person, and how tall and fast it is.
struct PersonBuild {
  PersonSpec look;
  double height_m{};          ///< With shoes and helmet.
  double steady_speed_mps{};  ///< At which it walks; for its stride if it walks.
};

/// A person as one model of 4000 to 8000 triangles. Frame: z = 0 is the lowest point; x in the
/// direction of view, y left, z up; metres.
///
/// Standing and walking persons have their origin on the ground below the pelvis, and their height
/// is exactly `height_m`: a body in mid-stride, which is lower, is enlarged to it. All others have
/// it in the middle of their footprint and are as tall as the body of that height is in their
/// posture; a lying person's head is at -x. What the person pulls or pushes is part of the model,
/// but does not move its origin: a suitcase behind, a pram ahead, a bicycle to the right.
[[nodiscard]] Model MakePerson(const PersonSurfaces& surfaces, const PersonBuild& build);

/// The rigid pieces of a walking person: trunk with head; upper arm, forearm, thigh, shank and foot
/// of the left, then of the right side; and what it pulls or pushes. Each in its own frame.
[[nodiscard]] std::vector<Model> MakePersonPieces(const PersonSurfaces& surfaces,
                                                  const PersonBuild& build);

/// Moves the pieces of a walking person. Thread-safe.
class WalkingPerson {
 public:
  /// How far apart in time poses may be between which pieces move linearly: at 2 m/s, 98 % of all
  /// points are 2 mm off at most, and a knee at the moment in which it is stretched 14 mm (tested).
  static constexpr std::int64_t kPoseStep_ns = 10'000'000;

  explicit WalkingPerson(const PersonBuild& build);

  [[nodiscard]] double stride_length_m() const { return gait_.stride_length_m(); }

  /// The poses of the pieces in MakePersonPieces()'s order, after a distance walked and at a speed
  /// >= 0. The bounds of MakePerson()'s model contain them.
  [[nodiscard]] std::vector<Transform> ObjectFromPieces(double distance_m, double speed_mps) const;

 private:
  PersonSpec look_;
  BodyMeasures body_;
  WalkingGait gait_;
};

}  // namespace railcast
