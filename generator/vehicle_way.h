#pragma once

#include <optional>

#include "core/rail/world_spec.h"

namespace railcast {

/// A moment on a vehicle's way.
struct WayPoint {
  double time_s{};
  double s_m{};        ///< Chainage.
  double speed_mps{};  ///< From here on.
};

/// Where and when a vehicle's way comes to an end.
struct VehicleWay {
  WayPoint start;
  std::optional<WayPoint> profile_end;  ///< The last point of its speed profile, if it has any.
  std::optional<WayPoint> track_end;    ///< Absent if it stays on its track for good.
};

/// @pre The vehicle's track is `track`, and its start lies on it.
[[nodiscard]] VehicleWay FindVehicleWay(const VehicleSpec& vehicle,
                                        const TrackSpec& track,
                                        double line_length_m);

}  // namespace railcast
