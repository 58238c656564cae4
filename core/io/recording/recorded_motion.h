#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "core/io/cloud/scan_motion.h"
#include "railcast/enum_names.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// Which motion during a scan is undone, so that its points are where they were at the stamp.
enum class Compensation : std::uint8_t {
  kNone,    ///< Points are where they were measured.
  kSensor,  ///< The sensor's, as a vehicle can that knows its own motion.
  kAll,     ///< The objects' own as well, which only a simulation knows.
};

template <>
inline constexpr auto kEnumNames<Compensation> =
    std::to_array<EnumName<Compensation>>({{Compensation::kAll, "all"},
                                           {Compensation::kSensor, "sensor"},
                                           {Compensation::kNone, "none"}});

/// Whether points can be moved to where they would have been measured at the stamp: their times and
/// the sensor's poses are known.
[[nodiscard]] bool KnowsMotion(const RecordedFrame& recorded);

/// The motion of sensor and objects during a frame's scan, for pairing points with boxes: a point
/// is where its firing met a surface, a box where its object was at the stamp. The sensor's motion
/// is that of ScanMotion. Objects move at the velocity of their boxes' centres; that they turn is
/// left out, which at 30 m/s on a curve of 900 m moves the ends of a wagon by 2 cm in 0.1 s.
class RecordedMotion {
 public:
  /// @param recorded Must outlive this.
  /// @param wanted What is undone as far as the frame knows it: without times or poses, nothing.
  RecordedMotion(const RecordedFrame& recorded, Compensation wanted);

  /// Returns the position of a slot's point in the sensor's axes at the stamp or, where nothing is
  /// undone, as it was measured.
  [[nodiscard]] Eigen::Vector3f PointOf(std::size_t slot) const;

  /// Returns the pose of an object's box where its points are. If the motion of objects is undone,
  /// that is the box at the stamp. If not, the points of a moving object are spread over its way
  /// while it was scanned, and the box is where it was at their mean time
  /// (RecordedObject::points_time_ns); without that, at the stamp.
  [[nodiscard]] Transform BoxOf(const RecordedObject& object) const;

 private:
  [[nodiscard]] Transform AtFiring(const Transform& stamp_from_box, std::uint32_t time_ns) const;

  const RecordedFrame& recorded_;
  bool is_sensor_undone_;
  bool are_objects_undone_;
  ScanMotion motion_;
  /// Velocities of the objects that move, by instance, in the sensor's axes at the stamp. Empty if
  /// their motion is not undone.
  std::unordered_map<std::uint32_t, Vector3> velocities_mps_;
};

}  // namespace railcast
