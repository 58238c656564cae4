#pragma once

#include <optional>
#include <vector>

#include "core/io/recording/recording.h"
#include "core/rail/rail_world.h"

namespace railcast {

/// A piece of the vehicle's track, as the sensor of one frame sees it.
struct TrackStretch {
  Alignment alignment;
  double offset_m{};  ///< Of the track, left of the line's axis.
  double from_s_m{};  ///< Chainages, from_s_m < to_s_m: the track is there between them.
  double to_s_m{};
  Transform sensor_from_world = Transform::Identity();  ///< At the stamp.

  /// The track frame at a chainage: x along, y left, z up, leaning with the cant; origin on the
  /// track's axis at top of rail.
  [[nodiscard]] Transform SensorFromTrack(double s_m) const;
  /// Chainages to draw lines through: the ends and every whole metre between. Chords of 1 m are
  /// within 1^2 / (8 R) of a curve: 5 mm down to a radius of 25 m, 0.9 mm at the 140 m of sidings.
  [[nodiscard]] std::vector<double> LineChainages_m() const;
  /// The multiples of `step_m` within.
  [[nodiscard]] std::vector<double> WholeChainages_m(double step_m) const;
};

/// From so far behind the vehicle's origin to so far ahead of it, whichever way along the chainage
/// it looks. Nothing where the frame has no pose or no such track is there.
[[nodiscard]] std::optional<TrackStretch> StretchAbout(const RailWorld& world,
                                                       const RecordedFrame& recorded,
                                                       double behind_m,
                                                       double ahead_m);

}  // namespace railcast
