#pragma once

#include "core/program/program.h"

namespace railcast {

/// The commands of extras that work on recordings.
struct RecordingCommands {
  ExtraCommands commands;

  /// All that this build has.
  [[nodiscard]] static const RecordingCommands& Get();
};

}  // namespace railcast
