#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
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

/// A box anywhere in the world, turned in any way.
struct OrientedBox {
  Transform world_from_box = Transform::Identity();  ///< Its centre and axes.
  Vector3 size_m = Vector3::Zero();                  ///< Every side > 0.
};

/// The volume that two boxes share, as a share of the smaller one's: the overlap coefficient, 0 to
/// 1. Unlike the intersection over the union it does not fall where a sensor sees but the near face
/// of a long object. It counts the middles of 16 x 16 x 16 cells of the smaller box and so is exact
/// to 1/32 for each face of the other one that cuts it.
[[nodiscard]] double OverlapOf(const OrientedBox& one, const OrientedBox& other);

/// The same box with every face moved outwards.
[[nodiscard]] inline OrientedBox Grown(OrientedBox box, double by_m) {
  box.size_m.array() += 2.0 * by_m;
  return box;
}

[[nodiscard]] inline bool IsInside(const OrientedBox& box, const Vector3& world_m) {
  const Vector3 local_m = box.world_from_box.inverse() * world_m;
  return (local_m.cwiseAbs().array() <= 0.5 * box.size_m.array()).all();
}

/// A box that a detector reports, where it was at the frame's stamp.
struct DetectedBox {
  OrientedBox box;
  std::uint32_t label{};   ///< The label of most of its points; 0 without points or labels.
  std::string class_name;  ///< As the detector calls it; may be empty.
};

/// What a detector reports of one frame.
struct FrameDetections {
  std::vector<DetectedBox> boxes;
  double latency_s{};  ///< From the frame's stamp until it is known.
};

/// The box of a cluster of points, along the track. Every side is at least 0.1 m long: a scan line
/// has no height.
/// @pre `places` is not empty.
[[nodiscard]] OrientedBox BoxOfCluster(const OwnTrack& track,
                                       const std::vector<PlaceByTrack>& places);

/// The label that most of them have, the least of several; 0 if there is none.
[[nodiscard]] std::uint32_t MostFrequentLabel(const std::vector<std::uint32_t>& labels);

}  // namespace railcast
