#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/extras/packets/ouster/ouster_encoder.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/decoded_turns.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {

/// A sensor of made metadata, and its frames.
class MadeOuster {
 public:
  explicit MadeOuster(const std::string& text)
      : metadata_(ParseOusterMetadata(text)), scan_(ScanOf(text, lidar_)) {
    std::ofstream(folder_.path() / "os.json") << text;
    lidar_.ouster_metadata = (folder_.path() / "os.json").string();
  }

  [[nodiscard]] const LidarSpec& lidar() const { return lidar_; }
  [[nodiscard]] const OusterMetadata& metadata() const { return metadata_; }
  [[nodiscard]] std::uint32_t returns() const { return IsDualProfile(metadata_.profile) ? 2 : 1; }
  [[nodiscard]] Frame MakeFrame(std::uint32_t index) const {
    Frame frame = scan_.MakeFrame(index, returns());
    std::ranges::fill(frame.power_ratio, 12.0F);
    return frame;
  }
  [[nodiscard]] Datagrams Encode(const std::vector<std::uint32_t>& indices) const {
    const auto encoder = MakeOusterEncoder(lidar_);
    Datagrams datagrams;
    for (const std::uint32_t index : indices) encoder->Encode(MakeFrame(index), datagrams);
    return datagrams;
  }
  [[nodiscard]] std::vector<SensorTurn> Decode(const Datagrams& datagrams) const {
    OusterDecoder decoder(metadata_);
    return TurnsOfPackets(decoder, DataPackets(datagrams));
  }

 private:
  static ScanSpec ScanOf(const std::string& text, LidarSpec& lidar) {
    UseOusterMetadata(text, lidar);
    return lidar.scan;
  }

  TemporaryDirectory folder_;
  LidarSpec lidar_;
  OusterMetadata metadata_;
  MadeScan scan_;
};

}  // namespace railcast
