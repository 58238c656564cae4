#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/http_server.h"
#include "core/program/options.h"
#include "railcast/scenario.h"

namespace railcast {

struct SensorStreamSpec;
struct StreamOptions;

/// The packets of real sensors, and captures.
struct LivePackets {
  /// Adds the options `--pcap`, `--calibration` and `--http`.
  void (*add_options)(ProgramOptions& stream, StreamOptions& options);
  /// Makes the encoder of a real sensor's packets.
  /// @param protocol Neither railcast nor ros2.
  /// @throws InputError if the sensor does not fit the protocol.
  std::unique_ptr<FrameEncoder> (*make_encoder)(Protocol protocol, const LidarSpec& lidar);
  /// Creates a capture of what a protocol sends.
  /// @throws InputError if it cannot be created.
  std::unique_ptr<DatagramFile> (*open_capture)(const std::filesystem::path& file,
                                                Protocol protocol,
                                                bool is_ipv6);
  /// Writes the files that readers of packets and captures need, as far as the options ask for
  /// packets and captures, and answers drivers over HTTP for as long as the result lives; null if
  /// they are not to be answered.
  /// @throws InputError if an option does not go with the streams, if there is another file of such
  ///   a name, or if the system refuses.
  std::unique_ptr<HttpServer> (*accompany)(const StreamOptions& options,
                                           const ScenarioSpec& scenario,
                                           const std::vector<SensorStreamSpec>& streams);
};

/// What extras add to live runs.
struct LiveExtras {
  std::optional<LivePackets> packets;

  /// All that this build has.
  [[nodiscard]] static const LiveExtras& Get();
};

}  // namespace railcast
