#pragma once

#include <cstdint>
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

}  // namespace railcast
