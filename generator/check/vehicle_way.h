#pragma once

#include <optional>

#include "core/rail/line/track_course.h"
#include "railcast/rail_world.h"

namespace railcast {

/// A moment of a vehicle's journey.
struct WayPoint {
  double time_s{};
  double s_m{};        ///< Chainage.
  double speed_mps{};  ///< Speed from this moment on.
};

/// When and where a vehicle's journey begins and ends.
struct VehicleWay {
  WayPoint start;
  /// The last point of the speed profile, if there is a profile and the point is reached.
  std::optional<WayPoint> profile_end;
  std::optional<WayPoint> track_end;  ///< Absent if the vehicle never leaves its track.
};

/// @pre The vehicle follows `track`, and its start lies on it.
[[nodiscard]] VehicleWay FindVehicleWay(const VehicleSpec& vehicle, const TrackCourse& track);

}  // namespace railcast
