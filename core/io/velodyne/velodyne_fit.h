#pragma once

#include <string_view>

#include "core/io/velodyne/velodyne_model.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// Elevations and azimuths of a scan may differ so much from the model's: as much as a packet's
/// azimuth can tell.
inline constexpr double kMaxChannelOffset_deg = 0.01;
/// Firing times and cycles may differ so much: at 20 Hz the rotor turns 0.00007 deg meanwhile.
inline constexpr double kMaxTimeOffset_us = 0.01;

/// Checks that a sensor of this model could make the scan: clockwise, its channels in the vendor's
/// laser order, its firing cycle (both are free for HDL-64E), the cycles of a whole turn, since
/// packets continue into the next frame and have one time of their own. VLP-16 puts two cycles into
/// a block, so it needs an even number.
/// @param return_mode Of ReceiverSpec: "dual" for vlp16-dual, "strongest" or "last" for the others.
/// @throws InputError with the first rule that is broken:
///   "--protocol vlp16: /lidar/scan/pattern/rotation: must be ...".
void CheckFits(const VelodyneFormat& format, const ScanSpec& scan, std::string_view return_mode);

}  // namespace railcast
