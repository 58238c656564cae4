#pragma once

#include <filesystem>
#include <string>

#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/datagrams.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/made_datagrams.h"

namespace railcast {

/// A file of the data set of Hesai's sensors: packets as ROS recordings, decoded clouds, the
/// maker's tables.
[[nodiscard]] inline std::filesystem::path HesaiFile(const std::string& name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_hesai") / name;
}

/// The recording of a sensor, of ROS 2.
[[nodiscard]] inline std::filesystem::path HesaiBag(const std::string& sensor) {
  const std::filesystem::path more = RAILCAST_SHARED_DATA_DIR "/lidar_hesai_more";
  if (sensor == "pandar40p") return more / "40p.db3";
  if (sensor == "qt64") return more / "qt64.db3";
  return HesaiFile("captures/" + sensor + ".db3");
}

/// The cloud that another decoder made of a turn of that recording.
[[nodiscard]] inline std::filesystem::path HesaiCloud(const std::string& sensor) {
  const std::filesystem::path bag = HesaiBag(sensor);
  return bag.parent_path() / (bag.stem().string() + "_decoded.pcd");
}

/// Why the recording of a sensor cannot be read here; empty if it can.
[[nodiscard]] inline std::string WhyNoHesaiBag(const std::string& name) {
  return exists(HesaiBag(name)) ? "" : HesaiBag(name).string() + " is not there";
}

/// Makes a capture of the packets in a sensor's recording, for tests of single packets.
[[nodiscard]] inline std::filesystem::path CaptureOfHesaiBag(const std::string& name,
                                                             const TemporaryDirectory& folder) {
  Datagrams datagrams;
  const auto packets = FindBagPackets({HesaiBag(name)})->open();
  while (const auto packet = packets->Next()) AddDatagram(packet->payload, datagrams);
  return WriteDatagrams(folder.path() / (name + ".pcap"), datagrams);
}

}  // namespace railcast
