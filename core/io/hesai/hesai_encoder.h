#pragma once

#include <memory>

#include "core/io/datagrams.h"
#include "core/io/hesai/hesai_model.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"

namespace railcast {

/// Makes an encoder that turns the frames of a scan into the packets of a Hesai sensor.
///
/// Ranges are rounded to 4 mm; a range beyond 65535 of these is encoded as no return. Where the
/// least distances say why there is no point, they are filled from the outcomes: code 1 if
/// something is nearer than 0.3 m or covers the window, 2 if it is too near for its laser, 3 in all
/// other cases. Azimuths are those of the rotor when the sensor takes them: the time from there to
/// the firing of a laser is what a decoder adds. A sensor that has already accounted for that time
/// has the azimuth in the middle of a cycle's firings.
/// @param model Must outlive the encoder.
/// @param scan The frames' scan; @param return_mode their ReceiverSpec::return_mode, "strongest",
///   "first", "last" or "dual".
/// @throws InputError with the first rule of ScanFit::CheckPattern() that is broken, or if the
///   packets cannot say the return mode.
[[nodiscard]] std::unique_ptr<FrameEncoder> MakeHesaiEncoder(const HesaiModel& model,
                                                             const ScanSpec& scan,
                                                             ReturnMode return_mode);

}  // namespace railcast
