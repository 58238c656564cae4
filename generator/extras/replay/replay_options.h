#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/recording/source_choice.h"
#include "core/program/options.h"
#include "generator/extras/replay/replay_feed.h"
#include "generator/live/live_options.h"
#include "railcast/scenario.h"

namespace railcast {

/// What `--protocol` names beside the protocols of scenarios: packets as they were recorded.
inline constexpr const char* kRecordedPackets = "packets";

/// The options of `railcast-generate replay`.
struct ReplayOptions : CommandOptions, RosOptions {
  std::filesystem::path recording;
  SourceChoice choice{};  ///< For a bag without a topic: all, or the only one.
  /// Plan of what is put into the recording.
  std::optional<std::filesystem::path> insert;
  std::optional<std::string> sensor;    ///< Address in a capture; absent = all sensors.
  std::vector<std::string> to;          ///< HOST:PORT of each receiver; empty = this machine.
  std::optional<std::string> protocol;  ///< kRecordedPackets or a Protocol; absent = as recorded.
  std::optional<std::string> fields;    ///< For protocols railcast and ros2.
  std::string pacing = "spread";
  double pace = 1.0;              ///< How many times faster than recorded.
  std::optional<double> rate_hz;  ///< Frames a second, for recordings without times.
  ReplayedFrames frames;
  std::string clock = "recorded";  ///< Or "utc".
  std::optional<std::filesystem::path> summary;
};

/// Adds the options of the command `replay`.
void AddReplayOptions(ProgramOptions& replay, ReplayOptions& options);

/// How a recording is sent.
enum class ReplayKind {
  kPackets,   ///< Its sensors' datagrams.
  kMessages,  ///< The messages of a bag.
  kUdp,       ///< Its frames, over UDP.
  kTopics,    ///< Its frames, on topics of ROS 2.
};

/// Returns how a recording is sent, as the options say or by itself.
/// @throws InputError if options do not go together, or not with the recording.
[[nodiscard]] ReplayKind KindOf(const ReplayOptions& options);

}  // namespace railcast
