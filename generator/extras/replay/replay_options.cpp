#include "generator/extras/replay/replay_options.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/program/command_line.h"
#include "generator/extras/dds/ros_options.h"

namespace railcast {
namespace {

std::vector<std::string> ProtocolNames() {
  std::vector<std::string> names = {kRecordedPackets};
  for (const std::string& name : NamesOf<Protocol>()) names.push_back(name);
  return names;
}

bool IsCapture(const ReplayOptions& options) {
  return FindCapture(options.recording).has_value();
}

ReplayKind KindWithoutCheck(const ReplayOptions& options) {
  const bool is_bag = IsBagOfTopics(options.recording);
  if (!options.protocol) {
    if (is_bag) return ReplayKind::kMessages;
    return IsCapture(options) ? ReplayKind::kPackets : ReplayKind::kUdp;
  }
  if (*options.protocol == kRecordedPackets) return ReplayKind::kPackets;
  if (*options.protocol != NameOf(Protocol::kRos2)) return ReplayKind::kUdp;
  // Fields are chosen of frames; messages are sent as they are.
  return is_bag && !options.fields ? ReplayKind::kMessages : ReplayKind::kTopics;
}

struct GivenOption {
  const char* name;
  bool is_given{};
};

/// Checks that none of these options is given.
void CheckNone(const std::vector<GivenOption>& options, const std::string& rule) {
  for (const auto& [name, is_given] : options) {
    if (is_given) throw InputError(std::string(name) + ": " + rule);
  }
}

void CheckFitsKind(const ReplayOptions& options, ReplayKind kind) {
  const bool is_as_recorded = kind == ReplayKind::kPackets || kind == ReplayKind::kMessages;
  const bool is_ros = kind == ReplayKind::kMessages || kind == ReplayKind::kTopics;
  const bool is_utc = options.clock == "utc";
  if (is_as_recorded) {
    CheckNone({{"--fields", options.fields.has_value()},
               {"--rate-hz", options.rate_hz.has_value()},
               {"--clock", is_utc}},
              "is for frames, with --protocol railcast or another that is not as recorded");
  }
  if (is_ros) {
    CheckNone({{"--to", !options.to.empty()}},
              "must be left out with protocol ros2, which sends messages to whoever reads their "
              "topics");
  } else {
    CheckNone({{"--domain", options.domain.has_value()},
               {"--interface", options.interface.has_value()},
               {"--receive-buffers", options.receive_buffers.has_value()}},
              "is for protocol ros2");
  }
  if (kind == ReplayKind::kMessages) {
    CheckNone({{"--insert", options.insert.has_value()},
               {"--frame-id", !options.choice.frame_id.empty()}},
              "is for packets and frames; a bag's are sent with --protocol packets, or as frames "
              "with --protocol railcast, or ros2 and --fields");
  }
  if (is_utc && (options.pace != 1.0 || options.lockstep)) {
    throw InputError(
        "--clock utc: must be left out where frames take another time than recorded, as with "
        "--rate and --lockstep");
  }
}

}  // namespace

void AddReplayOptions(ProgramOptions& replay, ReplayOptions& options) {
  replay
      .AddOption("RECORDING", options.recording,
                 "What to replay: a capture, a bag of ROS 2, a sequence, or clouds")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(replay, options.choice);
  replay.AddOption("--sensor", options.sensor,
                   "ADDRESS or ADDRESS:PORT of the sensor to replay, where a capture has several; "
                   "default: all of them, as packets");
  replay
      .AddOption("--to", options.to,
                 "HOST or HOST:PORT of a receiver; repeat the option for several, or use "
                 "255.255.255.255 to broadcast to the local network; default: this machine. "
                 "Recorded packets go to the ports to which they were sent; PORT replaces that "
                 "of the first sensor's packets")
      .TakesOneWord();
  replay
      .AddOption("--protocol", options.protocol,
                 "packets: a capture's packets as recorded; ros2: a bag's messages as recorded, "
                 "or frames of other recordings; railcast or the name of a sensor's protocol: "
                 "frames; default: packets for captures, ros2 for bags, otherwise railcast")
      .Check(Named(ProtocolNames()));
  replay.AddOption("--fields", options.fields,
                   "Fields to send in frames with protocols railcast and ros2, separated by "
                   "commas; default: those of `stream` that the recording has. With ros2 also "
                   "velodyne, ouster, hesai, livox");
  replay
      .AddOption("--pacing", options.pacing,
                 "spread: each datagram leaves when it was recorded or fired; burst: all "
                 "datagrams of a frame leave when it begins")
      .Check(Named({"spread", "burst"}))
      .ShowDefault();
  replay
      .AddOption("--insert", options.insert,
                 "Plan of objects and weather to put into the recording (docs/insert.md)")
      .ShowType("PLAN.json");
  replay.AddOption("--rate", options.pace, "How many times faster than recorded to send")
      .Check(Number({1e-3, 1e6}))
      .ShowDefault();
  replay
      .AddOption("--rate-hz", options.rate_hz,
                 "Frames a second of a recording, instead of their stamps")
      .Check(Number({1e-3, 1e6}));
  replay.AddOption("--start-frame", options.frames.start, "Frames to leave out before the first")
      .Check(Whole({}));
  replay.AddOption("--frames", options.frames.count, "Number of frames to send; default: all")
      .Check(Whole({1}));
  replay
      .AddOption("--clock", options.clock,
                 "Clock of the frames' stamps: the recorded times, or the time of day (utc)")
      .Check(Named({"recorded", "utc"}))
      .ShowDefault();
  AddCommandOptions(replay, options);
  AddRosOptions(replay, options);
  AddSummaryFile(replay, options.summary);
}

ReplayKind KindOf(const ReplayOptions& options) {
  const ReplayKind kind = KindWithoutCheck(options);
  CheckFitsKind(options, kind);
  for (const auto& [name, is_given] :
       {std::pair{"--lockstep", options.lockstep},
        std::pair{"--commands-from", options.commands_from.has_value()}}) {
    if (is_given && !options.commands_port) {
      throw InputError(std::string(name) +
                       ": needs --commands-port, where commands are heard (got none)");
    }
  }
  if (options.commands_port && !options.lockstep) {
    throw InputError("--commands-port: needs --lockstep, since a replay hears `step` alone");
  }
  return kind;
}

}  // namespace railcast
