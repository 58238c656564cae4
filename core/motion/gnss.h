#pragma once

#include <cstdint>
#include <optional>

#include "railcast/alignment.h"
#include "railcast/motion_sensors.h"
#include "railcast/rigid_motion.h"

namespace railcast {

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
