#pragma once

#include <cstdint>
#include <string>

#include "core/base/transform.h"
#include "core/detect/echo_tiles.h"
#include "core/frame/output_spec.h"
#include "core/simulate/frame_poses.h"

namespace railcast {

/// Puts measured points into the axes that the scenario asks for.
class OutputAxes {
 public:
  /// @param origin_place What faults call its origin.
  /// @param world_from_sensor At the stamp.
  /// @throws InputError if the output is in world coordinates so far from its origin that float32
  ///   would lose millimetres.
  OutputAxes(const OutputSpec& spec,
             const std::string& origin_place,
             const Transform& vehicle_from_sensor,
             const Transform& window_from_world,
             const Transform& world_from_sensor);

  /// Rewrites x, y, z of all echoes from the sensor's axes. World coordinates take the pose at each
  /// firing's own time, `time_ns` since the stamp, so that motion does not distort them.
  void Apply(const FramePoses& poses, const std::uint32_t* time_ns, EchoTiles& echoes) const;

 private:
  void Apply(const FramePoses& poses, std::uint32_t time_ns, const EchoTiles::Place& echo) const;

  enum class Target { kSensor, kVehicle, kWorld };

  Target target_ = Target::kSensor;
  bool is_left_handed_;
  Transform vehicle_from_sensor_;
  Transform output_from_window_;  ///< World axes about the output's origin.
};

}  // namespace railcast
