#pragma once

#include <cstdint>
#include <string>

#include "core/detect/base/echo_tiles.h"
#include "core/simulate/frame_poses.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// Where a sensor is said to be.
struct ReportedMount {
  Transform vehicle_from_sensor = Transform::Identity();
  /// From the sensor that is reported to the one from which rays leave.
  Transform true_from_reported = Transform::Identity();
};

/// Transforms measured points into the axes that OutputSpec asks for.
class OutputAxes {
 public:
  /// @param origin_place Name of the output origin in error messages.
  /// @param world_from_sensor Pose at the stamp.
  /// @throws InputError if the output is in world coordinates and the sensor is so far from the
  ///   output origin that float32 would lose millimetres.
  OutputAxes(const OutputSpec& spec,
             const std::string& origin_place,
             const ReportedMount& mount,
             const Transform& window_from_world,
             const Transform& world_from_sensor);

  /// Transforms x, y, z of all echoes from the sensor's axes. World coordinates use the pose at
  /// each firing's own time (`time_ns` since the stamp), so that motion does not distort them.
  void Apply(const FramePoses& poses, const std::uint32_t* time_ns, EchoTiles& echoes) const;

 private:
  void Apply(const FramePoses& poses, std::uint32_t time_ns, const EchoTiles::Place& echo) const;

  enum class Target { kSensor, kVehicle, kWorld };

  Target target_ = Target::kSensor;
  bool is_left_handed_;
  ReportedMount mount_;
  Transform output_from_window_;  ///< To world axes, relative to the output origin.
};

}  // namespace railcast
