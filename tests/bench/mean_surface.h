#pragma once

#include <cstdint>
#include <optional>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/network/network.h"
#include "railcast/alignment.h"
#include "railcast/scenario.h"

namespace railcast {

/// Ballast and ground of a scenario's line without grain and roughness.
class MeanSurface {
 public:
  explicit MeanSurface(const ScenarioSpec& scenario);

  /// Vertical height above the surface with a label, near a chainage of the line; absent for other
  /// labels.
  [[nodiscard]] std::optional<double> HeightAbove_m(const Vector3& place_world_m,
                                                    std::uint32_t label,
                                                    double near_s_m) const;

 private:
  WorldSpec spec_;
  std::uint64_t seed_;
  Alignment alignment_;
  Network network_;
  RailSurfaces surfaces_;
};

}  // namespace railcast
