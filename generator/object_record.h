#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/frame.h"

namespace railcast {

/// What one frame shows of one object.
struct ObjectInFrame {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();                  ///< Of its oriented box.
  Transform world_from_box = Transform::Identity();  ///< Box centre and axes at the stamp.
  /// The same in the axes that the frame's points have. Where those are left-handed it is the
  /// mirrored box, which a proper rotation turns as well.
  Transform output_from_box = Transform::Identity();
  Vector3 velocity_world_mps = Vector3::Zero();  ///< Of the box's centre, mean over the scan.
  std::uint32_t points{};                        ///< Slots with a point on the object.
  std::uint32_t firings_visible{};  ///< Firings that met it first, whether or not it was detected.
  std::uint32_t firings_alone{};    ///< Firings that would meet it if nothing else stood there.
};

/// A line of objects.jsonl: stamp and, for every object, what it is, its box at the stamp in world
/// coordinates, in the sensor's axes (right-handed whatever `output` says) and in those of the
/// frame's points, velocity, points, firings, and occlusion = 1 - firings_visible / firings_alone
/// (null where it is out of sight even alone).
[[nodiscard]] std::string ObjectsLine(const Frame& frame,
                                      const std::vector<ObjectInFrame>& objects);

}  // namespace railcast
