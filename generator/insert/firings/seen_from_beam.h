#pragma once

#include <array>
#include <cstddef>

#include "railcast/frame.h"

namespace railcast {

/// A point as its beam sees it, from where it leaves.
struct SeenPoint {
  double azimuth_rad{};  ///< Of the beam.
  double rotor_rad{};
  double elevation_rad{};
  double range_m{};
};

/// Returns the point of a slot as its beam sees it. Beams leave `origin_m[0]` outwards of the axis,
/// at the rotor's azimuth, and `origin_m[1]` above the origin.
/// @param channel_azimuth_rad Of the beam, added to the rotor's.
[[nodiscard]] SeenPoint SeenFromBeam(const std::array<double, 2>& origin_m,
                                     double channel_azimuth_rad,
                                     const Frame& frame,
                                     std::size_t slot);

/// Returns the frame's points as beams see them whose channels are not known yet.
[[nodiscard]] Frame SeenFromBeams(const std::array<double, 2>& origin_m, const Frame& frame);

}  // namespace railcast
