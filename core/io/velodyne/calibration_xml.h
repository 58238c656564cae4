#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scan/scan_spec.h"

namespace railcast {

/// What a sensor's own calibration says of one laser.
struct LaserCalibration {
  double elevation_deg{};
  double azimuth_deg{};          ///< Added to the block's, clockwise positive: -rotCorrection_.
  double range_offset_m{};       ///< Added to the distance in the packet.
  double vertical_offset_m{};    ///< Upward, of the laser from the sensor's origin.
  double horizontal_offset_m{};  ///< To the left of its direction.

  bool operator==(const LaserCalibration&) const = default;
};

/// The file (db.xml) that tells decoders of HDL-64E, pcl::HDLGrabber for one, the angles of a
/// scan's channels, which may be any. Offsets are 0: simulated lasers stand in the sensor's origin.
[[nodiscard]] std::string CalibrationXml(const SpinningSpec& pattern);

/// Reads such a file: ours, and those that came with sensors, of which these five figures are used.
/// @param name What faults call the file.
/// @returns One entry for each of the 64 lasers.
/// @throws InputError "name: rule (got value)" if it is no XML, a laser is missing or twice there,
///   a figure is none, or its distances are in another unit than 0.2 cm.
[[nodiscard]] std::vector<LaserCalibration> ReadCalibrationXml(std::string_view xml,
                                                               const std::string& name);

}  // namespace railcast
