#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "core/scenario/command.h"

namespace railcast {

/// A command and the time at which it took effect: it applies to frames with that stamp or a later
/// one.
struct TimedCommand {
  std::int64_t time_ns{};  ///< Simulation time.
  Command command;

  bool operator==(const TimedCommand&) const = default;
};

/// The commands of a live run that determine its frames.
///
/// The file consists of JSON lines. The first line names the scenario,
/// {"railcast_commands": 2, "scenario_xxh3": "..."}, every further line holds a command,
/// {"number": 1, "time_ns": 1500000000, "command": {"command": "brake", ...}}, in order of time and
/// counted from 1, and the last one says how many there are, {"num_commands": 1}, so that none is
/// missing unnoticed. Files of version 1 have neither count. After a reset, time starts at 0 again
/// and the commands before it have no effect. Step is left out, since it changes nothing.
struct CommandLog {
  std::string scenario_xxh3;           ///< ScenarioIdentity::scenario_hash of the whole scenario.
  std::vector<TimedCommand> commands;  ///< Since the last reset.

  bool operator==(const CommandLog&) const = default;
};

/// The first line of a log, with its end.
[[nodiscard]] std::string CommandLogHeader(const std::string& scenario_xxh3);
/// The line of one command, with its end.
/// @param number Counted from 1.
[[nodiscard]] std::string CommandLogLine(const TimedCommand& command, std::size_t number);
/// The last line, with its end.
[[nodiscard]] std::string CommandLogEnd(std::size_t num_commands);
/// The log in its shortest form.
[[nodiscard]] std::string CommandLogText(const CommandLog& log);

/// Reads a log as strictly as scenarios are read. An incomplete last line, which a killed run may
/// leave behind, is a fault like any other, and so is a line that is missing.
/// @throws InputError "file: line 3: /command/speed_mps: rule (got value)".
/// @param models Those of the scenario that was run, as for ReadCommand().
[[nodiscard]] CommandLog ReadCommandLog(const std::filesystem::path& file,
                                        const std::vector<ModelSpec>& models = {});
/// As ReadCommandLog(), from a stream; messages call the file `shown`.
[[nodiscard]] CommandLog ParseCommandLog(std::istream& stream,
                                         const std::string& shown,
                                         const std::vector<ModelSpec>& models = {});

}  // namespace railcast
