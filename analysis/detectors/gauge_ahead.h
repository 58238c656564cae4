#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "core/rail/world/own_track.h"
#include "railcast/transform.h"

namespace railcast {

/// A rectangular gauge of a train's own, in place of the vehicle's outline.
struct TrainGauge {
  double width_m{};
  double height_m{};  ///< Over top of rail, from which on it is.

  bool operator==(const TrainGauge&) const = default;
};

/// The parts of a gauge for OwnTrack; none if it has none of its own.
[[nodiscard]] std::vector<GaugePart> PartsOf(const std::optional<TrainGauge>& gauge);

/// The gauge of the own track ahead of a sensor, in which points are looked for.
class GaugeAhead {
 public:
  /// @param track Must outlive this.
  /// @param reach_m How far ahead of the sensor it goes; it ends where the track does.
  GaugeAhead(const OwnTrack& track,
             const Transform& world_from_vehicle,
             const Vector3& sensor_world_m,
             double reach_m);

  /// The place of a point; nothing if that is not in the gauge ahead.
  [[nodiscard]] std::optional<PlaceByTrack> PlaceInside(const Vector3& world_m) const;
  /// How far ahead of the sensor, along the track.
  [[nodiscard]] double Ahead_m(const PlaceByTrack& place) const {
    return std::abs(place.chainage_m - sensor_s_m_);
  }

 private:
  const OwnTrack& track_;
  double sensor_s_m_{};
  double reach_m_{};
  bool is_along_{};  ///< Whether the vehicle looks towards rising chainage.
};

/// The place of a point, beyond the ends of the track by its tangent there.
[[nodiscard]] PlaceByTrack PlaceOnTrack(const OwnTrack& track, const Vector3& world_m);

}  // namespace railcast
