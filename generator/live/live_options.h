#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/ros/dds/participant.h"
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

/// Adds the options `--domain`, `--interface` and `--receive-buffers`.
void AddRosOptions(ProgramOptions& command, RosOptions& options);

/// Opens the port of the commands; null if there is none.
/// @param models As CommandChannel takes them.
/// @throws InputError "--commands-port: ..." if it cannot be listened at.
[[nodiscard]] std::unique_ptr<CommandChannel> OpenChannel(
    const CommandOptions& options, const std::vector<ModelSpec>& models = {});

/// How the options, the scenario's interfaces and the environment say to take part in a domain.
/// @throws InputError if the environment names no domain.
[[nodiscard]] dds::ParticipantSpec ParticipantOf(const RosOptions& options, const Ros2Spec& spec);

/// Joins a domain.
/// @throws InputError "protocol ros2: ..." as dds::Join() does.
[[nodiscard]] std::unique_ptr<dds::Participant> JoinDomain(const dds::ParticipantSpec& spec);

/// Returns "domain 42, on loopback".
[[nodiscard]] std::string PlaceText(const dds::ParticipantSpec& spec);

/// Returns a number that distinguishes this start from earlier ones, in protocol railcast.
[[nodiscard]] std::uint32_t NextRunNumber();

}  // namespace railcast
