#pragma once

#include <optional>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/io/recording.h"
#include "railcast/rail_world.h"

namespace railcast {

/// A stretch of the vehicle's track, as the sensor of one frame sees it.
struct TrackStretch {
  Alignment alignment;
  TrackCourse track;
  double from_s_m{};  ///< Chainages between which the track exists: from_s_m < to_s_m.
  double to_s_m{};
  Transform sensor_from_world = Transform::Identity();  ///< At the stamp.

  /// Returns the track frame at a chainage: x along the track, y left, z up, leaning with the cant;
  /// its origin is on the track's axis at top of rail.
  [[nodiscard]] Transform SensorFromTrack(double s_m) const;
  /// Returns chainages to draw lines through: the ends and every whole metre between. Chords of 1 m
  /// are within 1^2 / (8 R) of a curve: 5 mm down to a radius of 25 m, 0.9 mm at the 140 m of
  /// sidings.
  [[nodiscard]] std::vector<double> LineChainages_m() const;
  /// Returns the multiples of `step_m` within the stretch.
  [[nodiscard]] std::vector<double> WholeChainages_m(double step_m) const;
};

/// Returns the stretch from `behind_m` behind the vehicle's origin to `ahead_m` ahead of it,
/// whichever way along the chainage the vehicle faces. Empty if the frame has no pose or the track
/// does not extend there.
[[nodiscard]] std::optional<TrackStretch> StretchAbout(const RailWorld& world,
                                                       const RecordedFrame& recorded,
                                                       double behind_m,
                                                       double ahead_m);

}  // namespace railcast
