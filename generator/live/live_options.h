#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/program/options.h"
#include "generator/live/command_channel.h"
#include "railcast/scenario.h"

namespace railcast {

// What the commands that send frames share.

/// Where commands are heard, and whether frames wait for them.
struct CommandOptions {
  bool lockstep = false;
  std::optional<std::uint16_t> commands_port;
  std::optional<std::string> commands_from;  ///< HOST or HOST:PORT; absent = this machine.
};

/// How to take part in a domain of ROS 2, for protocol ros2.
struct RosOptions {
  std::optional<std::uint32_t> domain;
  std::optional<std::string> interface;        ///< Name or address; absent: the scenario's.
  std::optional<std::string> receive_buffers;  ///< Name of a ReceiveBuffers.
};

/// Adds the options `--commands-port`, `--commands-from` and `--lockstep`.
void AddCommandOptions(ProgramOptions& command, CommandOptions& options);

/// Opens the port of the commands; null if there is none.
/// @param models As CommandChannel takes them.
/// @throws InputError "--commands-port: ..." if it cannot be listened at.
[[nodiscard]] std::unique_ptr<CommandChannel> OpenChannel(
    const CommandOptions& options, const std::vector<ModelSpec>& models = {});

/// Returns a number that distinguishes this start from earlier ones, in protocol railcast.
[[nodiscard]] std::uint32_t NextRunNumber();

/// The options of `railcast-generate stream`.
struct StreamOptions : CommandOptions, RosOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;    ///< Absent = all sensors.
  std::vector<std::string> to;          ///< HOST:PORT of each receiver, instead of the scenario's.
  std::optional<std::string> protocol;  ///< Protocol instead of the scenario's.
  /// Fields for protocols railcast and ros2, instead of their defaults.
  std::optional<std::string> fields;
  bool has_all_slots = false;  ///< For protocol railcast.
  std::string pacing = "spread";
  std::string certify = "off";  ///< As CertifiedShareOf() reads it.
  bool drops_late = false;
  bool fails_late = false;          ///< A late or dropped frame makes the exit status 1.
  bool sends_singly = false;        ///< Without UDP segmentation offload.
  std::string clock = "simulated";  ///< Name of a StampClock.
  int multicast_hops = 1;           ///< As SendOptions::multicast_hops.
  std::optional<std::filesystem::path> pcap;
  std::optional<std::filesystem::path> calibration;  ///< For protocol hdl64e.
  std::optional<std::string> http;           ///< HOST:PORT to answer at; for protocol ouster.
  std::optional<std::uint16_t> health_port;  ///< On loopback, for those who watch over the run.
  std::optional<std::filesystem::path> commands_log;
  /// On which ROS 2's nodes give commands, for protocol ros2.
  std::optional<std::string> commands_topic;
  std::optional<std::string> step_topic;         ///< On which one of them gives steps.
  std::optional<std::filesystem::path> summary;  ///< JSON file on the run.
  std::optional<double> duration_s;              ///< Simulation time; absent = until stopped.
  std::optional<std::uint64_t> seed;             ///< Overrides the scenario's.
  std::optional<std::string> fidelity;           ///< Overrides the scenario's.
  /// Instruction set of the trace; empty = the machine's best.
  std::string isa;
  int num_threads = 0;  ///< 0 = all cores.
};

/// Adds the options of the command `stream`.
void AddStreamOptions(ProgramOptions& stream, StreamOptions& options);

/// Whether there are no receivers, so that frames need not wait for their time.
[[nodiscard]] bool IsOffline(const StreamOptions& options);

/// Whether stamps state anything but simulation time.
[[nodiscard]] bool StatesTimeOfDay(const StreamOptions& options);

/// Whether commands change what frames show.
[[nodiscard]] bool HearsCommands(const StreamOptions& options);

/// @throws InputError if options cannot be combined.
void CheckOptionsTogether(const StreamOptions& options, std::size_t num_sensors);

}  // namespace railcast
