#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "railcast/frame.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// Something that an object touches or overlaps.
struct ContactInFrame {
  std::string with;  ///< Name of the other object.
  bool is_overlap{};
  double gap_m{};  ///< As ObjectContact::gap_m.
};

/// One object as seen in one frame.
struct ObjectInFrame {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();                  ///< Size of its oriented box.
  Transform world_from_box = Transform::Identity();  ///< Centre and axes of its box at the stamp.
  /// As above, relative to the axes of the frame's points. Where those are left-handed it is the
  /// pose of the mirrored box, which is again a proper rotation.
  Transform output_from_box = Transform::Identity();
  /// Velocity of the box's centre, mean over the scan.
  Vector3 velocity_world_mps = Vector3::Zero();
  std::uint32_t points{};          ///< Slots with a point on the object.
  std::uint32_t points_time_ns{};  ///< Mean time of those points since the stamp.
  ObjectView view{};
  std::vector<ContactInFrame> contacts{};  ///< At the stamp, in the world's order.
};

/// Returns a line of objects.jsonl: the stamp and, for every object, its identity, its box at the
/// stamp in world coordinates, in the sensor's axes (right-handed whatever `output` says) and in
/// those of the frame's points, velocity, points and their mean time, firings, occlusion (null
/// where it would not be visible even alone), and what it touches or overlaps.
[[nodiscard]] std::string ObjectsLine(const Frame& frame,
                                      const std::vector<ObjectInFrame>& objects);

}  // namespace railcast
