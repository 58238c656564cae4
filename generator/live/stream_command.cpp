#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

#include "core/base/error.h"
#include "core/base/inputs.h"
#include "core/base/text.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/stream/stream_encoder.h"
#include "core/io/write_file.h"
#include "core/program/stop_signals.h"
#include "core/scenario/sensors.h"
#include "core/trace/trace_program.h"
#include "generator/commands.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_control.h"
#include "generator/live/live_extras.h"
#include "generator/live/live_options.h"
#include "generator/live/live_streams.h"
#include "generator/live/live_summary.h"
#include "generator/run/run_options.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

ScenarioSpec ReadForStream(const StreamOptions& options) {
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.sensor) scenario = PickSensor(scenario, options.sensor);
  if (options.seed) scenario.seed = *options.seed;
  if (options.fidelity) scenario.fidelity = ValueNamed<Fidelity>(*options.fidelity).value();
  return scenario;
}

std::vector<Endpoint> EndpointsOf(const StreamOptions& options,
                                  const InterfacesSpec& interfaces,
                                  Protocol protocol) {
  const bool is_told = !options.to.empty();
  const std::string place = is_told ? "--to: " : "/interfaces/udp: ";
  const SensorInterface interface { {}, protocol, is_told ? options.to : interfaces.udp };
  std::vector<Endpoint> receivers;
  for (const std::string& to : ReceiversOf(interface)) {
    receivers.push_back(AtPlace(place, [&] { return ParseEndpoint(to, DefaultPort(protocol)); }));
  }
  return receivers;
}

bool IsIn(const std::vector<Endpoint>& receivers, const Endpoint& to) {
  return std::find(receivers.begin(), receivers.end(), to) != receivers.end();
}

/// Where a sensor's position packets go.
std::vector<Endpoint> PositionReceivers(const SensorStreamSpec& stream) {
  std::vector<Endpoint> receivers;
  const auto port = PositionPort(stream.protocol);
  if (!port) return receivers;
  for (const Endpoint& to : stream.to) receivers.push_back({to.address, *port});
  return receivers;
}

/// Checks that no receiver of frames or images gets position packets, too.
void CheckPositionsAreApart(const std::vector<SensorStreamSpec>& streams,
                            const ScenarioSpec& scenario) {
  for (const SensorStreamSpec& positions : streams) {
    const std::vector<Endpoint> taken = PositionReceivers(positions);
    const auto check = [&](const std::string& name, const std::vector<Endpoint>& receivers) {
      for (const Endpoint& to : receivers) {
        if (!IsIn(taken, to)) continue;
        throw InputError("receivers of " + name + ": must not be where " + positions.name +
                         " sends position packets (got " + EndpointText(to) + ")");
      }
    };
    for (const SensorStreamSpec& stream : streams) check(stream.name, stream.to);
    if (scenario.camera) check(scenario.camera->name, ImageReceivers(scenario));
  }
}

/// Checks that no receiver gets datagrams of two sensors, or of a sensor and the camera.
void CheckPortsDiffer(const std::vector<SensorStreamSpec>& streams, const ScenarioSpec& scenario) {
  CheckPositionsAreApart(streams, scenario);
  for (const Endpoint& to : ImageReceivers(scenario)) {
    for (const SensorStreamSpec& stream : streams) {
      if (!IsIn(stream.to, to)) continue;
      throw InputError("/camera/udp: must be other receivers than those of the sensors (got " +
                       EndpointText(to) + ")");
    }
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const Endpoint& to : streams[i].to) {
        if (!IsIn(streams[j].to, to)) continue;
        throw InputError("/interfaces/sensors: each sensor must have receivers of its own (got " +
                         EndpointText(to) + " for " + streams[j].name + " and " + streams[i].name +
                         ")");
      }
    }
  }
}

/// What the stamps of a protocol state.
StampClock ClockOf(const StreamOptions& options, Protocol protocol) {
  const StampClock clock = ValueNamed<StampClock>(options.clock).value();
  return clock == StampClock::kTai && !FollowsPtp(protocol) ? StampClock::kUtc : clock;
}

void CheckClock(const StreamOptions& options, const std::vector<SensorStreamSpec>& streams) {
  if (!StatesTimeOfDay(options)) return;
  const std::string got = " (got " + std::string(NameOf(streams.front().protocol)) + ")";
  const auto follows_ptp = [](const auto& stream) { return FollowsPtp(stream.protocol); };
  const bool is_tai = options.clock == NameOf(StampClock::kTai);
  if (is_tai && std::ranges::none_of(streams, follows_ptp)) {
    throw InputError(
        "--clock: tai is for packets of sensors that PTP synchronises, Hesai's and Ouster's" + got);
  }
}

void CheckIsBuilt(Protocol protocol) {
  const LiveExtras& extras = LiveExtras::Get();
  const bool is_for_ros = protocol == Protocol::kRos2;
  const bool has_packets = extras.packets.has_value();
  if (protocol == Protocol::kRailcast || (is_for_ros ? extras.ros.has_value() : has_packets))
    return;
  throw LacksExtra("protocol " + std::string(NameOf(protocol)), is_for_ros ? "dds" : "packets");
}

std::vector<SensorStreamSpec> PlanStreams(const StreamOptions& options,
                                          const ScenarioSpec& scenario) {
  std::vector<SensorStreamSpec> streams;
  for (const std::string& name : SensorNames(scenario)) {
    const ScenarioSpec sensor = PickSensor(scenario, name);
    const InterfacesSpec& interfaces = sensor.interfaces;
    const bool has_velocity = sensor.lidar.velocity.has_value();
    const Protocol protocol =
        options.protocol ? ValueNamed<Protocol>(*options.protocol).value() : interfaces.protocol;
    CheckIsBuilt(protocol);
    streams.push_back({.name = name,
                       .sensor = static_cast<std::uint16_t>(streams.size()),
                       .protocol = protocol,
                       .to = IsOffline(options) ? std::vector<Endpoint>{}
                                                : EndpointsOf(options, interfaces, protocol),
                       .sending = {.has_offload = !options.sends_singly,
                                   .multicast_hops = options.multicast_hops},
                       .clock = ClockOf(options, protocol),
                       .pcap = options.pcap,
                       .fields = options.fields && protocol != Protocol::kRos2
                                     ? FieldSelection(*options.fields, has_velocity)
                                     : UsualFields(has_velocity),
                       .has_all_slots = options.has_all_slots});
  }
  CheckPortsDiffer(streams, scenario);
  const auto has_packets = [](const auto& stream) {
    return stream.protocol != Protocol::kRailcast && stream.protocol != Protocol::kRos2;
  };
  CheckClock(options, streams);
  const bool has_fields = !std::all_of(streams.begin(), streams.end(), has_packets);
  if (!has_fields && (options.fields || options.has_all_slots)) {
    throw InputError(std::string(options.fields ? "--fields" : "--all-slots") +
                     ": is for protocol railcast (got " +
                     std::string(NameOf(streams.front().protocol)) + ")");
  }
  return streams;
}

/// Returns a number that distinguishes this start from earlier ones. A run that is only captured
/// always gets 0, so that it is reproducible.
std::uint32_t RunNumber(const StreamOptions& options) {
  return IsOffline(options) ? 0 : NextRunNumber();
}

std::string Describe(const std::vector<SensorStreamSpec>& streams,
                     const std::optional<TopicsPlan>& topics,
                     const ScenarioSpec& scenario) {
  std::string text;
  for (const SensorStreamSpec& stream : streams) {
    const bool is_for_ros = stream.protocol == Protocol::kRos2;
    text += stream.name + ": " + std::string(NameOf(stream.protocol));
    for (const Endpoint& to : stream.to) text += " to " + EndpointText(to);
    if (is_for_ros) text += " in " + topics->place;
    if (!is_for_ros && stream.to.empty()) text += " to no receiver";
    if (stream.pcap) text += ", into " + ShownPath(*stream.pcap);
    text += "\n";
  }
  const std::vector<Endpoint> receivers = ImageReceivers(scenario);
  if (receivers.empty() || !HasReaders(streams.front())) return text;
  text += scenario.camera->name + ": images";
  for (const Endpoint& to : receivers) text += " to " + EndpointText(to);
  text += "\n";
  return text;
}

// The shortest period of the sensors. Images come at most as often.
std::int64_t ShortestPeriodNs(const ScenarioSpec& scenario) {
  double rate_hz = scenario.lidar.scan.rate_hz;
  for (const LidarSpec& lidar : scenario.lidars) rate_hz = std::max(rate_hz, lidar.scan.rate_hz);
  return std::llround(1e9 / rate_hz);
}

LiveRunSpec RunSpecOf(const StreamOptions& options, const ScenarioSpec& scenario) {
  LiveRunSpec spec;
  // Without commands, what a frame will show is known before.
  const bool is_known = !HearsCommands(options) && !options.lockstep && !IsOffline(options);
  if (is_known) spec.lead_ns = ShortestPeriodNs(scenario);
  spec.pacing = options.pacing == "burst" ? Pacing::kBurst : Pacing::kSpread;
  spec.lockstep = options.lockstep;
  spec.drops_late = options.drops_late;
  if (options.duration_s) spec.duration_ns = std::llround(1e9 * *options.duration_s);
  return spec;
}

/// The sources that there are.
std::vector<CommandSource*> SourcesOf(std::initializer_list<CommandSource*> all) {
  std::vector<CommandSource*> sources;
  std::ranges::copy_if(all, std::back_inserter(sources),
                       [](auto* each) { return each != nullptr; });
  return sources;
}

/// Answers those who watch over the run.
std::unique_ptr<HttpServer> OpenHealth(const StreamOptions& options, const LiveHealth& health) {
  if (!options.health_port) return nullptr;
  auto server = AtPlace("--health-port: ", [&] {
    return std::make_unique<HttpServer>(
        ParseEndpoint("127.0.0.1", *options.health_port),
        [&health](const HttpRequest& request) { return health.Answer(request); });
  });
  std::cout << "health at " << EndpointText(server->at()) << "\n";
  return server;
}

/// Opens the topics of the sensors of protocol ros2 and tells what holds for the run; null if there
/// are none.
std::unique_ptr<LiveTopics> BeginTopics(const StreamOptions& options,
                                        const std::optional<TopicsPlan>& plan,
                                        FrameMaker& maker) {
  if (!plan) return nullptr;
  auto topics = plan->open(maker);
  if (StatesTimeOfDay(options)) topics->SetClockAhead(UtcNow_ns());
  topics->Begin();
  return topics;
}

void ReportCommands(const CommandChannel* channel, const LiveTopics* topics) {
  if (channel != nullptr && channel->num_strangers() > 0) {
    std::cout << "commands from others than the peer: " << channel->num_strangers()
              << ", dropped\n";
  }
  if (channel != nullptr && channel->num_answers() > 0) {
    std::cout << "answers that came back as commands: " << channel->num_answers() << ", dropped\n";
  }
  if (topics != nullptr) std::cout << topics->CommandsText();
}

/// Prints the outcome of the run, writes its summary and returns the exit status.
int ReportRun(const LiveResult& result, const LiveStreams& streams, const StreamOptions& options) {
  const bool has_times = !IsOffline(options);
  std::cout << ShownLines(LiveSummary(result.records, streams.Delivered(), has_times));
  const std::vector<std::string> capture_faults = streams.CaptureFaults();
  for (const std::string& fault : capture_faults)
    std::cout << "capture: " << ShownLines(fault) << "\n";
  if (result.log_fault) std::cout << "log: " << ShownLines(*result.log_fault) << "\n";
  if (options.summary) {
    WriteNamedFile(*options.summary, LiveSummaryJson("stream", result, streams.Delivered(),
                                                     capture_faults, has_times));
  }
  if (result.fault) std::cerr << ShownLines(*result.fault) << "\n";
  const std::string late = options.fails_late ? LateText(result.records) : "";
  if (!late.empty()) std::cerr << "--fail-late: " << late << "\n";
  const bool is_failed =
      result.fault || result.log_fault || !capture_faults.empty() || !late.empty();
  return is_failed ? kExitFailure : kExitSuccess;
}

/// A clock that jumps where nobody waits for frames.
LiveResult RunBy(const StreamOptions& options,
                 const LiveRunSpec& spec,
                 LiveStreams& streams,
                 LiveControl& control) {
  MonotonicClock monotonic;
  JumpingClock jumping;
  LiveClock& clock = IsOffline(options) ? static_cast<LiveClock&>(jumping) : monotonic;
  return RunLive(spec, streams.Sensors(), control.Hooks(), clock);
}

int RunStream(const StreamOptions& options) {
  const ScenarioSpec scenario = ReadForStream(options);
  CheckOptionsTogether(options, SensorNames(scenario).size());
  const std::optional<double> certified_share = CertifiedShareOf(options.certify);
  // It reads all that the scenario names, over which nothing must be written.
  const std::string scenario_hash = IdentityOf(scenario).scenario_hash;
  CheckOutputFiles(
      {{"SCENARIO", options.scenario}, {"--calibration", options.calibration.value_or("")}},
      {{"--pcap", options.pcap.value_or("")},
       {"--commands-log", options.commands_log.value_or("")},
       {"--summary", options.summary.value_or("")}});
  const std::vector<SensorStreamSpec> plan = PlanStreams(options, scenario);
  const LiveExtras& extras = LiveExtras::Get();
  const auto topics_plan = extras.ros ? extras.ros->plan(options, scenario, plan) : std::nullopt;
  const LiveRunSpec spec = RunSpecOf(options, scenario);
  const std::string isa = AtPlace("--", [&] { return IsaInUse(options.isa); });
  // With commands, the journeys of moving objects are not known in advance, so they are not
  // checked.
  LiveStreams streams(scenario, plan, options.num_threads, RunNumber(options), isa,
                      HearsCommands(options) ? std::nullopt : spec.duration_ns);
  if (certified_share) streams.Certify(*certified_share);
  const auto http = extras.packets ? extras.packets->accompany(options, scenario, plan) : nullptr;
  LiveHealth health;
  const auto health_server = OpenHealth(options, health);
  const auto channel = OpenChannel(options, scenario.models);
  const auto topics = BeginTopics(options, topics_plan, streams.maker());
  streams.Publish(topics.get());
  std::optional<CommandLoop> commands;
  if (HearsCommands(options)) {
    commands.emplace(streams.maker(),
                     SourcesOf({topics ? topics->steps() : nullptr, channel.get(),
                                topics ? topics->commands() : nullptr}),
                     options.lockstep, options.commands_log, scenario_hash);
  }
  Inputs::Release();
  CatchStopSignals();
  streams.WarmUp(StopRequested);
  std::cout << ShownLines(Describe(plan, topics_plan, scenario)) << std::flush;

  LiveControl control(streams, commands ? &*commands : nullptr, options, health);
  SetClocks(streams, options, spec.lead_ns);
  control.Begin();
  LiveResult result = RunBy(options, spec, streams, control);
  if (commands) {
    commands->End(result.fault.value_or("the run has ended"));
    result.log_fault = commands->log_fault();
  }
  streams.Finish();
  control.End();
  streams.AddCertificates(result.records);
  ReportCommands(channel.get(), topics.get());
  return ReportRun(result, streams, options);
}

}  // namespace

void AddStream(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<StreamOptions>();
  ProgramOptions stream =
      app.AddCommand("stream", "Send frames over UDP at the pace of real sensors until Ctrl-C");
  AddStreamOptions(stream, *options);
  stream.WhenParsed([&command, options] {
    const auto& ros = LiveExtras::Get().ros;
    const bool is_for_ros = options->fields && ros && ros->has_fields(*options->fields);
    if (options->fields && !is_for_ros) CheckFields(*options->fields);
    command = [options](const std::string&) { return RunStream(*options); };
  });
}

}  // namespace railcast
