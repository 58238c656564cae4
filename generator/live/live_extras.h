#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/http_server.h"
#include "core/io/net/udp.h"
#include "core/program/options.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"
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

/// The topics of ROS 2 on which the sensors of protocol ros2 publish, and nodes give commands.
class LiveTopics {
 public:
  virtual ~LiveTopics() = default;

  /// Sets how far the stamps of all messages are ahead of simulation time: time 0 since 1970 where
  /// they state the time of day. They are not ahead unless set.
  virtual void SetClockAhead(std::int64_t ahead_ns) = 0;
  /// Tells the name of the node and what holds for the whole run, once all topics are there.
  virtual void Begin() = 0;
  /// Returns the sensors for RunLive(), valid as long as this object.
  [[nodiscard]] virtual std::vector<LiveSensor> Sensors() = 0;
  /// Waits a second at most for readers that have not received everything.
  virtual void Finish() = 0;
  /// Numbers of messages, in the order of Sensors().
  /// @pre Nothing is being sent.
  [[nodiscard]] virtual std::vector<UdpSender::Counts> Delivered() const = 0;

  /// Where nodes give steps; null where they give none.
  [[nodiscard]] virtual CommandSource* steps() = 0;
  /// Where nodes give other commands; null where they give none.
  [[nodiscard]] virtual CommandSource* commands() = 0;
  /// Returns lines on what nodes gave, for the end of a run.
  [[nodiscard]] virtual std::string CommandsText() const = 0;
};

/// How the sensors of protocol ros2 will publish, in a domain that was joined.
struct TopicsPlan {
  std::string place;  ///< "domain 42, on loopback"
  /// Opens the topics. To be called once; the maker must outlive the result.
  /// @throws InputError if a topic cannot be opened.
  std::function<std::unique_ptr<LiveTopics>(FrameMaker& maker)> open;
};

/// Protocol ros2.
struct LiveRos {
  /// Adds the options `--domain`, `--interface`, `--receive-buffers`, `--commands-topic` and
  /// `--step-topic`.
  void (*add_options)(ProgramOptions& stream, StreamOptions& options);
  /// Whether `--fields` names something that only protocol ros2 has: the fields of a sensor's
  /// driver.
  bool (*has_fields)(const std::string& fields);
  /// Returns nothing if there are no sensors of protocol ros2.
  /// @throws InputError if the domain is none or cannot be joined, or if options do not go with the
  ///   sensors' protocols.
  std::optional<TopicsPlan> (*plan)(const StreamOptions& options,
                                    const ScenarioSpec& scenario,
                                    const std::vector<SensorStreamSpec>& streams);
};

/// What extras add to live runs.
struct LiveExtras {
  std::optional<LivePackets> packets;
  std::optional<LiveRos> ros;

  /// All that this build has.
  [[nodiscard]] static const LiveExtras& Get();
};

}  // namespace railcast
