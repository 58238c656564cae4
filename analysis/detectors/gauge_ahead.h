#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "analysis/detectability/approach.h"
#include "railcast/transform.h"

namespace railcast {

/// A rectangular gauge of a train's own, in place of the structure gauge.
struct TrainGauge {
  double width_m{};
  double height_m{};  ///< Over top of rail, from which on it is.

  bool operator==(const TrainGauge&) const = default;
};

/// The parts of a gauge for OwnTrack; none if it has none of its own.
[[nodiscard]] std::vector<GaugePart> PartsOf(const std::optional<TrainGauge>& gauge);

/// A place by the own track: chainage, left of the axis, above top of rail.
using PlaceByTrack = Vector3;

/// The gauge of the own track ahead of a sensor, in which points are looked for. It finds the
/// places of all points of a frame in little time.
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
    return std::abs(place.x() - sensor_s_m_);
  }

 private:
  /// A place on the axis.
  struct Station {
    double s_m{};
    Transform track_from_world;
  };
  const OwnTrack& track_;
  double sensor_s_m_{};
  bool is_along_{};  ///< Whether the vehicle looks towards rising chainage.
  double most_half_width_m_{};
  double top_m_{};
  std::vector<Station> stations_;
  std::vector<Vector3> axis_m_;  ///< Of the stations.
};

/// The place of a point by the whole of the track.
[[nodiscard]] PlaceByTrack PlaceOnTrack(const OwnTrack& track,
                                        double near_s_m,
                                        const Vector3& world_m);

}  // namespace railcast
