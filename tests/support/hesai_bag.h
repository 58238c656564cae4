#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {

/// A file of the data set of Hesai's sensors: packets as ROS recordings, decoded clouds, the
/// maker's tables.
[[nodiscard]] inline std::filesystem::path HesaiFile(const std::string& name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_hesai") / name;
}

/// Why captures/NAME.db3 cannot be read here; empty if it can.
[[nodiscard]] inline std::string WhyNoHesaiBag(const std::string& name) {
  const std::filesystem::path bag = HesaiFile("captures/" + name + ".db3");
  if (!exists(bag)) return bag.string() + " is not there";
  if (RunCommand("/usr/bin/python3 -c 'import sqlite3'").status != 0) {
    return "/usr/bin/python3 with its module sqlite3 is not there";
  }
  return {};
}

/// Turns captures/NAME.db3 into a capture in this folder.
[[nodiscard]] inline std::filesystem::path CaptureOfHesaiBag(const std::string& name,
                                                             const TemporaryDirectory& folder) {
  std::filesystem::path capture = folder.path() / (name + ".pcap");
  const Ended run =
      RunCommand("/usr/bin/python3 " RAILCAST_SOURCE_DIR "/scripts/rosbag_to_pcap.py " +
                 HesaiFile("captures/" + name + ".db3").string() + " " + capture.string());
  if (run.status != 0) throw std::runtime_error(run.said);
  return capture;
}

}  // namespace railcast
