#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "railcast/effects.h"
#include "railcast/lidar.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Where beams are during a frame, and how far beside their directions they reach.
struct BeamReach {
  std::int64_t stamp_ns{};
  Transform vehicle_from_sensor = Transform::Identity();
  double beside_rad{};  ///< Half the width of a beam, and by how much it may be aimed wrong.
  double range_max_m{};
};

/// BeamReach::beside_rad of a sensor.
[[nodiscard]] double BesideBeam_rad(const DetectorSpec& detector);

/// For each firing of a pattern, whether its beam may meet one of some objects: all that do are
/// among them, and some that do not. Those of the vehicle itself are left out.
/// @param objects Indices into world.objects().
/// @param among The firings of those of a wider reach, beside which there are none; absent if they
///   are not known.
[[nodiscard]] std::vector<bool> BeamsNearObjects(
    const World& world,
    std::span<const std::size_t> objects,
    const ScanPattern& pattern,
    const BeamReach& reach,
    std::optional<std::span<const std::uint32_t>> among = {});

}  // namespace railcast
