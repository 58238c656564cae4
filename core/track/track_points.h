#pragma once

#include <limits>
#include <vector>

#include "core/track/found_track.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Where a point is by a found track. All are NaN and false without a point, and where the track is
/// not known to kMostTrackMargin_m.
struct PointByTrack {
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

  float ahead_m = kNone;     ///< Along the track, from beside the sensor.
  float lateral_m = kNone;   ///< From the track's middle, left positive.
  float height_m = kNone;    ///< Above the plane of the heads, square to it.
  bool is_in_gauge{};        ///< Inside VehicleOutline().
  bool is_in_clear_space{};  ///< Inside ClearSpace() of the regulation, without a contact line.
};

/// Points are placed as far as the track is known to this.
inline constexpr double kMostTrackMargin_m = 0.25;

/// Places the points of a frame by a track that was found in it: one value for each slot, with the
/// sensor's motion during the scan undone where it is known.
///
///     const std::vector<PointByTrack> places = PlacePoints(recorded, track, cant_m);
///
/// @param cant_m Of the track, which makes its clear space wider; 0 where it is not known.
[[nodiscard]] std::vector<PointByTrack> PlacePoints(const RecordedFrame& recorded,
                                                    const FoundTrack& track,
                                                    double cant_m);

}  // namespace railcast
