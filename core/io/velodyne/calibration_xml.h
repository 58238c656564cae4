#pragma once

#include <string>

#include "railcast/lidar.h"

namespace railcast {

/// One laser's entry in a sensor's own calibration.
struct LaserCalibration {
  double elevation_deg{};
  double azimuth_deg{};          ///< Added to the block's, clockwise positive: -rotCorrection_.
  double range_offset_m{};       ///< Added to the distance in the packet.
  double vertical_offset_m{};    ///< Upward, from the sensor's origin to the laser.
  double horizontal_offset_m{};  ///< To the left of the laser's direction.

  bool operator==(const LaserCalibration&) const = default;
};

/// Returns the file (db.xml) that tells decoders of HDL-64E, such as pcl::HDLGrabber, the angles of
/// a scan's channels, which are free for this sensor. Offsets are 0: simulated lasers are at the
/// sensor's origin.
[[nodiscard]] std::string CalibrationXml(const SpinningSpec& pattern);

}  // namespace railcast
