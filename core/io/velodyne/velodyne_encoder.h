#pragma once

#include <memory>
#include <string_view>

#include "core/io/datagrams.h"
#include "core/io/scan_fit.h"
#include "core/io/velodyne/velodyne_model.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"

namespace railcast {

/// Checks that a sensor of this model could make the scan. It must turn clockwise, have the model's
/// channels and firing cycle (both are free for HDL-64E), and a whole turn of cycles (ScanFit).
/// VLP-16 puts two cycles into a block, so it needs an even number of cycles.
/// @param return_mode ReceiverSpec::return_mode: "dual" for vlp16-dual, "strongest" or "last" for
///   the others.
/// @throws InputError with the first rule that is broken:
///   "--protocol vlp16: /lidar/scan/pattern/rotation: must be ...".
void CheckFits(const VelodyneFormat& format, const ScanSpec& scan, ReturnMode return_mode);

/// Makes an encoder that turns the frames of a scan into the packets of a Velodyne sensor, with a
/// position packet for every whole second of simulation time.
///
/// Ranges are rounded to the model's unit (2 mm; VLP-32C 4 mm); a range beyond 65535 units is
/// encoded as no return. Azimuths are those of the rotor at the first firing of a block, rounded to
/// 0.01 deg. Dual formats take frames of two returns, or of one return, which they repeat.
/// @param format One of vlp16, vlp16-dual, hdl32e, vlp32c, hdl64e.
/// @param scan The frames' scan; @param return_mode their ReceiverSpec::return_mode.
/// @throws InputError if there is no such format or the scan does not fit it: CheckFits().
[[nodiscard]] std::unique_ptr<FrameEncoder> MakeVelodyneEncoder(std::string_view format,
                                                                const ScanSpec& scan,
                                                                ReturnMode return_mode);

}  // namespace railcast
