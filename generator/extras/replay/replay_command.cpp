#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/packet_recording.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"
#include "generator/commands.h"
#include "generator/extras/dds/ros_options.h"
#include "generator/extras/insert/packets/insertion.h"
#include "generator/extras/recording_commands.h"
#include "generator/extras/replay/frame_feeds.h"
#include "generator/extras/replay/message_feed.h"
#include "generator/extras/replay/packet_feed.h"
#include "generator/extras/replay/replay_options.h"
#include "generator/extras/replay/replay_run.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_summary.h"

namespace railcast {
namespace {

/// @param default_port Of receivers without one.
std::vector<Endpoint> ReplayReceivers(const ReplayOptions& options, std::uint16_t default_port) {
  const std::vector<std::string> this_machine = {"127.0.0.1"};
  std::vector<Endpoint> receivers;
  for (const std::string& to : options.to.empty() ? this_machine : options.to) {
    receivers.push_back(AtPlace("--to: ", [&] { return ParseEndpoint(to, default_port); }));
  }
  return receivers;
}

/// The recording as OpenRecording() takes it.
std::filesystem::path SourceOf(const ReplayOptions& options) {
  SourceChoice choice = options.choice;
  choice.sensor = options.sensor.value_or("");
  if (!choice.sensor.empty() && IsBagOfTopics(options.recording)) {
    throw InputError("--sensor: is for captures, since bags do not say who sent packets");
  }
  return WithChoice({options.recording}, choice).front();
}

/// Where the recorded packets are.
DatagramPlace FindPackets(const ReplayOptions& options) {
  if (auto capture = FindCapture(SourceOf(options))) return std::move(*capture);
  if (IsBagOfTopics(options.recording)) {
    const SourceChoice& choice = options.choice;
    if (auto packets = FindBagPackets({options.recording, choice.topic, choice.frame_id})) {
      return std::move(*packets);
    }
  }
  throw InputError(
      ShownPath(options.recording) +
      ": must be a capture or a bag with a sensor's packets if --protocol is packets (got "
      "neither); --protocol railcast and ros2 send frames");
}

std::unique_ptr<ReplayFeed> OpenPackets(const ReplayOptions& options) {
  constexpr std::uint16_t kAsRecorded = 0;
  DatagramPlace packets = FindPackets(options);
  if (options.insert) {
    packets = PlaceOfInserted(packets, MakeInsertion(*options.insert, SourceOf(options)));
  }
  return std::make_unique<PacketFeed>(PacketRecording(std::move(packets)),
                                      ReplayReceivers(options, kAsRecorded), options.pace,
                                      options.frames);
}

std::unique_ptr<ReplayFeed> OpenMessages(const ReplayOptions& options) {
  auto feed = std::make_unique<MessageFeed>(options.recording, options.choice.topic, options.pace,
                                            options.frames);
  const dds::ParticipantSpec spec = ParticipantOf(options, {});
  feed->Join(JoinDomain(spec), PlaceText(spec));
  return feed;
}

FrameSource OpenFrames(const ReplayOptions& options) {
  const std::filesystem::path source = SourceOf(options);
  auto recording = OpenRecording(source);
  if (options.insert) {
    recording = WithInsertion(std::move(recording), *options.insert, source);
  }
  return {std::move(recording),
          {.pace = options.pace, .rate_hz = options.rate_hz, .frames = options.frames}};
}

std::unique_ptr<ReplayFeed> OpenTopics(const ReplayOptions& options) {
  FrameSource source = OpenFrames(options);
  ros::CloudSpec clouds;
  if (options.fields) clouds = ros::ParseCloudSpec(*options.fields, true);
  if (clouds.layout == ros::PointLayout::kRailcast) {
    const auto wanted = options.fields ? std::optional(clouds.fields) : std::nullopt;
    clouds.fields = FieldsOf(source.first(), wanted);
  }
  const auto scenario = source.info().scenario;
  const dds::ParticipantSpec spec = ParticipantOf(
      options, scenario ? scenario->interfaces.ros2.value_or(Ros2Spec{}) : Ros2Spec{});
  auto feed = std::make_unique<TopicFrameFeed>(std::move(source), std::move(clouds));
  feed->Join(JoinDomain(spec), PlaceText(spec));
  return feed;
}

std::unique_ptr<ReplayFeed> OpenUdp(const ReplayOptions& options) {
  const Protocol protocol =
      options.protocol ? ValueNamed<Protocol>(*options.protocol).value() : Protocol::kRailcast;
  std::optional<FieldSelection> fields;
  if (options.fields) fields.emplace(*options.fields);
  if (fields && protocol != Protocol::kRailcast) {
    throw InputError("--fields: is for protocols railcast and ros2 (got " + *options.protocol +
                     ")");
  }
  return std::make_unique<UdpFrameFeed>(OpenFrames(options), protocol,
                                        ReplayReceivers(options, DefaultPort(protocol)), fields,
                                        NextRunNumber());
}

std::unique_ptr<ReplayFeed> OpenFeed(const ReplayOptions& options) {
  static_cast<void>(SourceOf(options));  // Refuses what was chosen of another kind of recording.
  switch (KindOf(options)) {
    case ReplayKind::kPackets:
      return OpenPackets(options);
    case ReplayKind::kMessages:
      return OpenMessages(options);
    case ReplayKind::kTopics:
      return OpenTopics(options);
    case ReplayKind::kUdp:
      break;
  }
  return OpenUdp(options);
}

/// Prints the outcome, writes the summary and returns the exit status.
int ReportReplay(const LiveResult& result, const ReplayFeed& feed, const ReplayOptions& options) {
  constexpr bool kHasTimes = true;
  std::cout << ShownLines(LiveSummary(result.records, {feed.delivered()}, kHasTimes));
  if (!feed.LeftOut().empty()) std::cout << "left out: " << ShownLines(feed.LeftOut()) << "\n";
  if (options.summary) {
    WriteNamedFile(*options.summary,
                   LiveSummaryJson("replay", result, {feed.delivered()}, {}, kHasTimes));
  }
  if (!result.fault) return kExitSuccess;
  std::cerr << ShownLines(*result.fault) << "\n";
  return kExitFailure;
}

int RunReplayCommand(const ReplayOptions& options) {
  CheckOutputFiles({{"RECORDING", options.recording}, {"--insert", options.insert.value_or("")}},
                   {{"--summary", options.summary.value_or("")}});
  const auto feed = OpenFeed(options);
  const auto channel = OpenChannel(options);
  std::optional<StepLoop> steps;
  if (channel) steps.emplace(*channel);
  CatchStopSignals();
  std::cout << ShownLines(feed->Description()) << "\n" << std::flush;

  const TerminalLine line;
  MonotonicClock clock;
  const LiveResult result =
      RunReplay(*feed,
                {.pacing = options.pacing == "burst" ? Pacing::kBurst : Pacing::kSpread,
                 .steps = steps ? &*steps : nullptr,
                 .states_utc = options.clock == "utc",
                 .is_stopped = StopRequested,
                 .show = [&](const RunState& state) { line.Show(LiveProgress(state)); }},
                clock);
  if (steps) steps->End(result.fault.value_or("the replay has ended"));
  feed->Finish();
  line.End();
  return ReportReplay(result, *feed, options);
}

void AddReplay(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<ReplayOptions>();
  ProgramOptions replay = app.AddCommand("replay", OwnProgramOf("replay").description);
  AddReplayOptions(replay, *options);
  replay.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunReplayCommand(*options); };
  });
}

}  // namespace

void AddReplay(RecordingCommands& extras) {
  extras.commands["replay"] = AddReplay;
}

}  // namespace railcast
