#pragma once

#include <map>
#include <string_view>

#include "core/program/options.h"
#include "core/program/program.h"

namespace railcast {

/// The commands of extras that work on recordings.
struct RecordingCommands {
  /// By its name, what adds a command with its options, as the functions of generator/commands.h
  /// do.
  std::map<std::string_view, void (*)(ProgramOptions& app, ProgramCommand& command)> commands;

  /// All that this build has.
  [[nodiscard]] static const RecordingCommands& Get();
};

}  // namespace railcast
