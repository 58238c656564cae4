#pragma once

#include <map>
#include <string_view>

#include "core/program/options.h"
#include "core/program/program.h"

namespace railcast {

/// What extras add to railcast-analyze.
struct AnalysisExtras {
  /// By its name, what adds a command with its options, as the functions of commands.h do.
  std::map<std::string_view, void (*)(ProgramOptions& app, ProgramCommand& command)> commands;

  /// All that this build has.
  [[nodiscard]] static const AnalysisExtras& Get();
};

}  // namespace railcast
