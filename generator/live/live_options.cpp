#include "generator/live/live_options.h"

#include <chrono>
#include <iostream>
#include <utility>

#include "core/base/error.h"
#include "core/program/command_line.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_extras.h"
#include "generator/run/run_options.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {

void AddCommandOptions(ProgramOptions& command, CommandOptions& options) {
  command
      .AddOption("--commands-port", options.commands_port,
                 "UDP port on which to receive commands as lines of JSON; default: none")
      .Check(Whole({1, 65535}));
  command.AddOption("--commands-from", options.commands_from,
                    "HOST or HOST:PORT whose commands are accepted; default: this machine only");
  command.AddFlag("--lockstep", options.lockstep, "Wait for the command `step` before each frame");
}

std::unique_ptr<CommandChannel> OpenChannel(const CommandOptions& options,
                                            const std::vector<ModelSpec>& models) {
  if (!options.commands_port) return nullptr;
  Endpoint peer = AtPlace("--commands-from: ", [&] {
    return ParseEndpoint(options.commands_from.value_or("127.0.0.1"), 0);
  });
  // A socket on the loopback address cannot be reached from other machines.
  const bool is_ipv4 = peer.address.is_ipv4();
  const Endpoint at = ParseEndpoint(
      peer.is_loopback() ? (is_ipv4 ? "127.0.0.1" : "::1") : (is_ipv4 ? "0.0.0.0" : "::"),
      *options.commands_port);
  auto channel = AtPlace("--commands-port: ",
                         [&] { return std::make_unique<CommandChannel>(at, peer, models); });
  std::cout << "commands at " << EndpointText(channel->at()) << "\n";
  return channel;
}

std::uint32_t NextRunNumber() {
  // Counted in milliseconds, so that a later start has a larger number even after many resets.
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

// NOLINTNEXTLINE(readability-function-size): a table
void AddStreamOptions(ProgramOptions& stream, StreamOptions& options) {
  stream.AddOption("SCENARIO", options.scenario, "Scenario file").Required().Check(NonEmpty());
  stream.AddOption(
      "--sensor", options.sensor,
      "Name of the sensor to stream, where the scenario has several; default: all of them");
  stream
      .AddOption("--to", options.to,
                 "HOST:PORT of a receiver, [HOST]:PORT where HOST is an IPv6 address; repeat the "
                 "option for several, or use 255.255.255.255 to broadcast to the local network; "
                 "default: the scenario's receivers or, if it has none, this machine")
      .TakesOneWord();
  stream.AddOption("--protocol", options.protocol, "Protocol to use instead of the scenario's")
      .Check(Named(NamesOf<Protocol>()));
  stream.AddOption(
      "--fields", options.fields,
      "With protocols railcast and ros2: fields to send, separated by commas, or all; "
      "default: x,y,z,intensity,ring,time_ns,label,instance, and radial_velocity_mps where it is "
      "measured. With ros2 also the names of sensors' drivers, whose fields are sent then: "
      "velodyne, ouster, hesai, livox, aeva, autoware");
  stream.AddFlag("--all-slots", options.has_all_slots,
                 "With protocol railcast: also send firings without a return");
  stream
      .AddOption("--pacing", options.pacing,
                 "spread: each datagram leaves one period after its last firing, as from a sensor; "
                 "burst: all datagrams of a frame leave at once")
      .Check(Named({"spread", "burst"}))
      .ShowDefault();
  stream.AddFlag(
      "--drop-late", options.drops_late,
      "Leave out whole frames that would be late; default: send all frames, even if late");
  stream.AddFlag("--fail-late", options.fails_late,
                 "End with exit status 1 if a frame was late or dropped; the run goes on until "
                 "its end");
  stream.AddFlag("--no-offload", options.sends_singly,
                 "Send datagrams one by one, without UDP segmentation offload, so that captures on "
                 "this machine hold single datagrams");
  // Linux keeps datagrams of 0 hops on this machine only where a program on it has joined the
  // group; where none has, they go out.
  stream
      .AddOption("--multicast-hops", options.multicast_hops,
                 "How many networks multicast datagrams may cross: 1 = no router forwards them. "
                 "To keep them on this machine, send them by its interface lo")
      .Check(Whole({1, 255}))
      .ShowDefault();
  stream
      .AddOption(
          "--clock", options.clock,
          "Clock of the stamps. simulated: simulation time, which begins with the year 2000 in "
          "packets of real sensors, else with 0; utc: the time of day; tai: the same, but atomic "
          "time, 37 s ahead, for sensors that PTP synchronises")
      .Check(Named(NamesOf<StampClock>()))
      .ShowDefault();
  if (const auto& packets = LiveExtras::Get().packets) packets->add_options(stream, options);
  stream
      .AddOption("--health-port", options.health_port,
                 "TCP port of 127.0.0.1 at which to answer GET /health and GET /metrics; default: "
                 "none")
      .Check(Whole({1, 65535}));
  AddCommandOptions(stream, options);
  stream
      .AddOption("--commands-log", options.commands_log,
                 "File to log the commands to, which `sequence --commands` can replay")
      .Check(NonEmpty());
  if (const auto& ros = LiveExtras::Get().ros) ros->add_options(stream, options);
  stream
      .AddOption("--duration", options.duration_s,
                 "Seconds of simulation time after which to end; default: run until stopped")
      .Check(Number({1e-3, 1e9}));
  stream.AddOption("--seed", options.seed, "Seed to use instead of the scenario's")
      .Check(Whole({}));
  AddThreads(stream, options.num_threads);
  stream.AddOption("--fidelity", options.fidelity, "Fidelity to use instead of the scenario's")
      .Check(Named(NamesOf<Fidelity>()));
  AddCertify(stream, options.certify);
  AddSummaryFile(stream, options.summary);
  AddIsa(stream, options.isa);
}

bool IsOffline(const StreamOptions& options) {
  return options.pcap && options.to.empty();
}

bool StatesTimeOfDay(const StreamOptions& options) {
  return options.clock != NameOf(StampClock::kSimulated);
}

bool HearsCommands(const StreamOptions& options) {
  return options.commands_port || options.commands_topic || options.step_topic;
}

void CheckOptionsTogether(const StreamOptions& options, std::size_t num_sensors) {
  const auto needs_one_sensor = [&](const std::string& option, bool is_given) {
    if (!is_given || num_sensors == 1) return;
    throw InputError(option + ": is for one sensor, to be named by --sensor (got " +
                     std::to_string(num_sensors) + " sensors)");
  };
  needs_one_sensor("--to", !options.to.empty());
  needs_one_sensor("--protocol", options.protocol.has_value());
  needs_one_sensor("--pcap", options.pcap.has_value());
  const auto needs_commands_port = [&](const std::string& option, bool is_given) {
    if (is_given && !options.commands_port) {
      throw InputError(option + ": needs --commands-port, where commands are heard (got none)");
    }
  };
  if (options.lockstep && !options.commands_port && !options.step_topic) {
    throw InputError(
        "--lockstep: needs --commands-port or --step-topic, where steps are heard (got none)");
  }
  if (options.step_topic && !options.lockstep) {
    throw InputError("--step-topic: needs --lockstep, with which frames wait for steps (got none)");
  }
  needs_commands_port("--commands-log", options.commands_log && !options.commands_topic);
  needs_commands_port("--commands-from", options.commands_from.has_value());
  for (const auto& [option, is_given] : {std::pair{"--drop-late", options.drops_late},
                                         std::pair{"--fail-late", options.fails_late}}) {
    if (!is_given || !(options.lockstep || IsOffline(options))) continue;
    throw InputError(std::string(option) + ": must be left out where frames " +
                     (options.lockstep ? "wait for steps, as with --lockstep"
                                       : "are never late, as with --pcap without --to"));
  }
  if (options.http && IsOffline(options)) {
    throw InputError("--http: must be left out where nothing is sent, as with --pcap without --to");
  }
  for (const auto& [option, is_given] : {std::pair{"--no-offload", options.sends_singly},
                                         std::pair{"--clock", StatesTimeOfDay(options)}}) {
    if (!is_given || !IsOffline(options)) continue;
    throw InputError(std::string(option) +
                     ": must be left out where nothing is sent, as with --pcap without --to");
  }
  if (IsOffline(options) && !options.duration_s && !options.lockstep) {
    throw InputError("--pcap: needs --duration where no --to is given (got none)");
  }
}

}  // namespace railcast
