#pragma once

#include "core/program/program.h"

namespace railcast {

/// What extras add to railcast-analyze.
struct AnalysisExtras {
  ExtraCommands commands;

  /// All that this build has.
  [[nodiscard]] static const AnalysisExtras& Get();
};

}  // namespace railcast
