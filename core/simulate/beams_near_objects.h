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

/// Where the beams of a frame come from, and how far they reach.
struct BeamReach {
  std::int64_t stamp_ns{};
  Transform vehicle_from_sensor = Transform::Identity();
  double range_max_m{};
};

/// Half the width of a sensor's beam, and by how much it may be aimed wrong.
[[nodiscard]] double BesideBeam_rad(const DetectorSpec& detector);

/// A sphere around an object in the sensor's axes, at every step of a frame.
struct MovingSphere {
  double radius_m{};
  std::vector<Vector3> centers_m{};
};

/// Some objects of a world, as the beams of one frame may meet them. Those of the vehicle itself
/// are left out.
///
///     const NearObjects near(world, objects, pattern, reach);
///     const std::vector<std::uint32_t> may_meet = near.Beams(BesideBeam_rad(detector));
class NearObjects {
 public:
  /// @param objects Indices into world.objects().
  /// @param pattern Must outlive this.
  NearObjects(const World& world,
              std::span<const std::size_t> objects,
              const ScanPattern& pattern,
              const BeamReach& reach);

  /// The firings of the pattern, rising, whose beams may meet one of the objects: all that do are
  /// among them, and some that do not.
  /// @param beside_rad As BesideBeam_rad().
  /// @param among Those of a wider beam, beside which there are none; absent if they are not known.
  [[nodiscard]] std::vector<std::uint32_t> Beams(
      double beside_rad, std::optional<std::span<const std::uint32_t>> among = {}) const;

 private:
  [[nodiscard]] bool MayMeet(std::size_t firing, double beside_rad) const;

  const ScanPattern& pattern_;
  std::vector<MovingSphere> spheres_;
};

}  // namespace railcast
