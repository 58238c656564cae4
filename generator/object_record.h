#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/frame/labels.h"
#include "core/scene/world.h"

namespace railcast {

/// What one frame shows of one object.
struct ObjectInFrame {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();                  ///< Of its oriented box.
  Transform world_from_box = Transform::Identity();  ///< Box centre and axes at the stamp.
  std::uint32_t points{};                            ///< Slots with a point on the object.
  std::uint32_t firings_visible{};  ///< Firings that met it first, whether or not it was detected.
  std::uint32_t firings_alone{};    ///< Firings that would meet it if nothing else stood there.
};

/// Every object of the world but the sensor's own vehicle, in the world's order.
/// @param firings_alone Of each of world.objects(), as Simulator::FiringsOnObjectAlone gives them.
[[nodiscard]] std::vector<ObjectInFrame> DescribeObjects(
    const World& world,
    const LabelTable& labels,
    const Frame& frame,
    const std::vector<std::uint32_t>& firings_alone);

/// A line of objects.jsonl: stamp and, for every object, what it is, its box in world and in sensor
/// coordinates (the sensor's at the stamp, right-handed whatever `output` says), points, firings,
/// and occlusion = 1 - firings_visible / firings_alone (null where it is out of sight even alone).
[[nodiscard]] std::string ObjectsLine(const Frame& frame,
                                      const std::vector<ObjectInFrame>& objects);

}  // namespace railcast
