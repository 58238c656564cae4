#pragma once

#include <memory>
#include <string_view>

#include "core/io/datagrams.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// Makes the packets of a Velodyne sensor out of the frames of a scan, and a position packet for
/// every whole second of simulation time.
///
/// Ranges are rounded to the model's unit (2 mm; VLP-32C 4 mm); what lies beyond 65535 of them is
/// no return. Azimuths are the rotor's at the first firing of a block, rounded to 0.01 deg. Dual
/// formats take frames of two returns, or of one, which they repeat.
/// @param format One of vlp16, vlp16-dual, hdl32e, vlp32c, hdl64e.
/// @param scan The frames' scan; @param return_mode their ReceiverSpec::return_mode.
/// @throws InputError if there is no such format or the scan does not fit it: CheckFits().
[[nodiscard]] std::unique_ptr<FrameEncoder> MakeVelodyneEncoder(std::string_view format,
                                                                const ScanSpec& scan,
                                                                std::string_view return_mode);

}  // namespace railcast
