#pragma once

#include <memory>

#include "core/extras/packets/spinning/spinning_model.h"
#include "core/io/datagrams.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"

namespace railcast {

/// Makes an encoder that turns the frames of a scan into the packets of a spinning sensor. Where
/// packets have no date, there is a position packet for every whole second of simulation time.
///
/// Ranges are rounded to the model's unit; a range beyond 65535 of these is encoded as no return.
/// Where the least distances say why there is no point, they are filled from the outcomes: code 1
/// if something is nearer than 0.3 m or covers the window, 2 if it is too near for its laser, 3 in
/// all other cases. Azimuths are those of the rotor when the sensor takes them: the time from there
/// to the firing of a laser is what a decoder adds. A sensor that has already accounted for that
/// time has the azimuth in the middle of a cycle's firings. Dual modes take frames of two returns,
/// or of one return, which they repeat. Packets without a date hold the blocks of an azimuth window
/// one after the other; of others those in which nothing is fired are not sent.
/// @param model Must outlive the encoder.
/// @param scan The frames' scan; @param return_mode their ReceiverSpec::return_mode.
/// @throws InputError with the first rule of ScanFit::CheckPattern() that is broken, if the scan is
///   no table of an AT128's file where the model is AT128, or if the packets cannot say the return
///   mode:
///   "--protocol vlp16: /lidar/scan/pattern/rotation: must be ...".
[[nodiscard]] std::unique_ptr<FrameEncoder> MakeSpinningEncoder(const SpinningModel& model,
                                                                const ScanSpec& scan,
                                                                ReturnMode return_mode);

}  // namespace railcast
