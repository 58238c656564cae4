#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "core/scenario/command.h"

namespace railcast {

/// A command and when it took effect: for the frames stamped then or later.
struct TimedCommand {
  std::int64_t time_ns{};  ///< Simulation time.
  Command command;

  bool operator==(const TimedCommand&) const = default;
};

/// What a live run was told, and what of it shapes its frames.
///
/// As a file: JSON lines. The first names the scenario,
/// {"railcast_commands": 1, "scenario_xxh3": "..."}, every further one a command,
/// {"time_ns": 1500000000, "command": {"command": "brake", ...}}, by rising time. Reset begins anew
/// at time 0: what stands before it shapes nothing that comes after. Step is left out, since it
/// changes nothing.
struct CommandLog {
  std::string scenario_xxh3;           ///< ScenarioIdentity::scenario_hash of the whole scenario.
  std::vector<TimedCommand> commands;  ///< Since the last reset.

  bool operator==(const CommandLog&) const = default;
};

/// The first line of a log, with its end.
[[nodiscard]] std::string CommandLogHeader(const std::string& scenario_xxh3);
/// The line of one command, with its end; empty for Step.
[[nodiscard]] std::string CommandLogLine(const TimedCommand& command);
/// The log in its shortest form.
[[nodiscard]] std::string CommandLogText(const CommandLog& log);

/// Reads a log as strictly as scenarios are read. A last line without an end, which a run that was
/// killed may leave behind, is a fault like any other.
/// @throws InputError "file: line 3: /command/speed_mps: rule (got value)".
[[nodiscard]] CommandLog ReadCommandLog(const std::filesystem::path& file);
/// The same of what a file holds, which messages call `shown`.
[[nodiscard]] CommandLog ParseCommandLog(std::istream& stream, const std::string& shown);

}  // namespace railcast
