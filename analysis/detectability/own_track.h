#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/rail/clearance/structure_gauge.h"
#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// The track that the vehicle is on: an object ahead is in the way if it reaches into the structure
/// gauge.
class OwnTrack {
 public:
  /// @throws InputError as MakeWorld() does.
  explicit OwnTrack(const ScenarioSpec& scenario);

  /// Position of a box relative to the gauge of the track ahead, where it comes nearest to it. A
  /// box behind the vehicle or beyond the ends of the track is not inside, at an infinite distance
  /// from the axis.
  [[nodiscard]] GaugeClearance ClearanceAhead(const Transform& world_from_vehicle,
                                              const Transform& world_from_box,
                                              const Vector3& size_m) const;

 private:
  OwnTrack(const ScenarioSpec& scenario, const RailWorld& world);

  /// Chainage of the point of the axis that is nearest to this point.
  [[nodiscard]] double ChainageNear_m(const Vector3& world_m) const;
  /// As above, but starts from a nearby chainage.
  [[nodiscard]] double Refined_m(double s_m, const Vector3& world_m) const;

  Alignment alignment_;
  TrackCourse track_;
  std::vector<GaugePart> gauge_;
  /// One point every kAxisStep_m of chainage from the start of the track.
  std::vector<Vector3> axis_m_;
};

}  // namespace railcast
