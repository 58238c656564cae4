#pragma once

#include <cstdint>
#include <map>

#include "analysis/preset/seen_planes.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"

namespace railcast {

/// Simulates a scenario's sensor before the planes that a real sensor has seen: the beams of its
/// own pattern, with the effects of its own rung and weather, meet a plane where the recorded
/// firings of that direction did, and nothing elsewhere. Planes below the sensor that are level are
/// made of `asphalt`, all others of `concrete`, with the reflectivities given for their cells.
class Replay {
 public:
  /// @param scenario One sensor whose channels have the recording's elevations; materials `asphalt`
  ///   and `concrete`.
  /// @throws InputError if it lacks these materials.
  explicit Replay(const ScenarioSpec& scenario);

  /// @param reflectivities Of cells; those not named have that of the nearest cell before them.
  /// @pre There is at least one.
  /// @returns The frame; `instance` is the index of the plane + 1.
  [[nodiscard]] Frame Scan(const SeenPlanes& seen,
                           const std::map<PlaneCell, double>& reflectivities,
                           std::uint32_t frame_index) const;

  /// The directions of the firings.
  [[nodiscard]] const ScanTable& scan() const { return scan_; }

 private:
  const ScenarioSpec scenario_;
  ScanTable scan_;
};

}  // namespace railcast
