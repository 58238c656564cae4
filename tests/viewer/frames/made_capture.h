#pragma once

#include <cstdint>
#include <filesystem>

#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scenario/sensors.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/support/sensor_file.h"

namespace railcast {

/// Writes a capture of `num_frames` turns of a VLP-16.
inline void WriteCapture(const std::filesystem::path& file, std::uint32_t num_frames) {
  const MadeScan scan(ReadSensor("vlp16"));
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("vlp16"), scan.spec(), ReturnMode::kStrongest);
  PcapWriter writer(file, kVelodyneDataPort, kVelodynePositionPort);
  Datagrams datagrams;
  for (std::uint32_t i = 0; i < num_frames; ++i) {
    datagrams.Clear();
    encoder->Encode(scan.MakeFrame(i), datagrams);
    writer.Write(datagrams, datagrams.items);
  }
  writer.Finish();
}

}  // namespace railcast
