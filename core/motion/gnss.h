#pragma once

#include <cstdint>
#include <optional>

#include "railcast/alignment.h"
#include "railcast/motion_sensors.h"
#include "railcast/rigid_motion.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// How far away things hide the sky. Farther ones stand low, or are as high as hills.
inline constexpr double kSkyReach_m = 100.0;

/// The share of the sky above an elevation mask that nothing hides, by kTileSize rays that are
/// spread evenly over it in solid angle. Wires hide nothing, nor does the vehicle itself.
/// What moves is where it is at the frame's stamp.
[[nodiscard]] double FreeSkyShare(const SceneOfFrame& scene,
                                  const Vector3& place_world_m,
                                  double elevation_mask_rad,
                                  double range_m);

/// The place of a receiver's antenna on the vehicle.
[[nodiscard]] Vector3 AntennaOf_m(const GnssSpec& spec);

/// What a receiver measures.
struct GnssReceiver {
  const GnssSpec& spec;
  std::uint64_t seed{};
  const std::optional<MapSpec>& map;

  /// @param sky_share Of the sky above the mask, as seen by the antenna.
  [[nodiscard]] GnssSample Measure(const RigidMotion& vehicle,
                                   double sky_share,
                                   std::uint64_t sample) const;
};

}  // namespace railcast
