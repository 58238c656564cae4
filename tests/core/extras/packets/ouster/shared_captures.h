#pragma once

#include <filesystem>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/packets/ouster/ouster_packet.h"
#include "core/scenario/ouster_metadata.h"
#include "tests/support/captures.h"

namespace railcast {

/// A real capture and its metadata, in the folder of shared data.
struct OusterCapture {
  const char* pcap;
  const char* json;
  OusterProfile profile;
  std::size_t num_packets;
  bool is_ours = false;  ///< Whether each byte is of a field that railcast knows.

  [[nodiscard]] static std::filesystem::path Path(const char* name) {
    return std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / name;
  }
  [[nodiscard]] bool is_there() const { return exists(Path(pcap)) && exists(Path(json)); }
  [[nodiscard]] OusterMetadata metadata() const {
    return ParseOusterMetadata(ReadFileWhole(Path(json)));
  }
};

inline void PrintTo(const OusterCapture& capture, std::ostream* out) {
  *out << capture.pcap;
}

inline const OusterCapture kOs2Capture = {"lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap",
                                          "lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.json",
                                          OusterProfile::kSingle, 64};

/// All of them.
inline const std::vector<OusterCapture> kOusterCaptures = {
    kOs2Capture,
    {"lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.pcap",
     "lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.json", OusterProfile::kFusaDual, 8},
    {"lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "lidar_ouster/OS-1-128_v2.3.0_1024x10.json",
     OusterProfile::kLowRate, 192},
    {"ouster_more/OS-0-128-U1_v2.3.0_1024x10.pcap", "ouster_more/OS-0-128-U1_v2.3.0_1024x10.json",
     OusterProfile::kLowRate, 64},
    {"ouster_more/OS-0-32-U1_v2.2.0_1024x10.pcap", "ouster_more/OS-0-32-U1_v2.2.0_1024x10.json",
     OusterProfile::kDual, 64},
    {"ouster_more/OS-2-32-U0_v2.0.0_1024x10.pcap", "ouster_more/OS-2-32-U0_v2.0.0_1024x10.json",
     OusterProfile::kLegacy, 64},
    {"ouster_more/crc_test.pcap", "ouster_more/crc_test.json", OusterProfile::kLowRate, 34, true},
    {"ouster_more/shot_limiting_test.pcap", "ouster_more/shot_limiting_test.json",
     OusterProfile::kSingle, 1},
    {"ouster_more/windowed_frame1.pcap", "ouster_more/windowed_frame1_0.json",
     OusterProfile::kLowRate, 17},
    {"ouster_more/windowed_frame2.pcap", "ouster_more/windowed_frame2_0.json",
     OusterProfile::kLowRate, 15}};

/// The payloads of one size in a capture.
[[nodiscard]] inline std::vector<std::vector<char>> PayloadsOf(const OusterCapture& capture,
                                                               std::size_t size) {
  std::vector<std::vector<char>> payloads = PacketsInCapture(OusterCapture::Path(capture.pcap));
  std::erase_if(payloads, [&](const auto& payload) { return payload.size() != size; });
  return payloads;
}

[[nodiscard]] inline std::vector<std::vector<char>> LidarPacketsOf(const OusterCapture& capture) {
  return PayloadsOf(capture, OusterPacketSize(capture.metadata()));
}

}  // namespace railcast
