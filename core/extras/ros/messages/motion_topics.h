#pragma once

#include <string>
#include <string_view>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "railcast/motion_sensors.h"

namespace railcast::ros {

/// A sample of an IMU in its own axes: without an orientation, and with the variances of its noise.
[[nodiscard]] Imu ImuMessage(const ImuSample& sample, const ImuSpec& spec);

/// A sample of a receiver of satellite navigation. Without a fix all numbers are NaN, as they are
/// where the alignment is on no map. The altitude is in the heights of the alignment.
[[nodiscard]] NavSatFix FixMessage(const GnssSample& sample, const GnssSpec& spec);

/// The speed that an odometer measures, along x of the vehicle.
[[nodiscard]] TwistStamped SpeedMessage(const OdometerSample& sample);

}  // namespace railcast::ros
