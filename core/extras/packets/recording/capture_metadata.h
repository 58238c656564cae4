#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/scenario/ouster_metadata.h"

namespace railcast {

class At128Correction;

/// Returns the angles of the AT128 that was captured, or null if they are not at hand.
/// @throws InputError if they cannot be read.
using LoadAt128Correction = std::function<std::shared_ptr<const At128Correction>()>;

/// What stands beside a capture about the sensor whose packets it may hold.
struct CaptureMetadata {
  std::filesystem::path file{};              ///< Empty if there is none.
  std::optional<OusterMetadata> metadata{};  ///< Absent if the file is none of an Ouster sensor's.
  std::string fault{};                       ///< Why not: "file: /lidar_mode: missing".
  /// Called if a packet of an AT128 is seen; null if there is nothing to look for.
  LoadAt128Correction load_correction{};
  bool is_named = false;  ///< Whether the user says that it is the sensor's.
};

/// Reads the metadata of an Ouster sensor.
/// @throws InputError with a line for every fault: "file: /lidar_mode: missing".
[[nodiscard]] OusterMetadata ReadOusterMetadata(const std::filesystem::path& file);

/// Looks for an Ouster sensor's metadata under the names that its captures have: for
/// `drive_lb_n3.pcap` these are `drive_lb_n3_0.json` (of Ouster's own programs and of railcast),
/// `drive_lb_n3.json`, `drive_lb.json` and `drive.json`. The first that can be read is taken; if
/// none can, the fault is that of the first that is there.
[[nodiscard]] CaptureMetadata FindOusterMetadata(const std::filesystem::path& capture);

}  // namespace railcast
