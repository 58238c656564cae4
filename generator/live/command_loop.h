#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "generator/commanded_run.h"
#include "generator/line_file.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_run.h"

namespace railcast {

/// Lets what a channel hears take effect on a run, and keeps a log of it.
class CommandLoop {
 public:
  static constexpr int kMaxPerFrame = 16;

  /// @param lockstep Whether frames wait for steps.
  /// @param log_file Where the log goes that `sequence --commands` replays, if anywhere.
  /// @param scenario_xxh3 What the log says it belongs to.
  /// @throws InputError if the log is there already or cannot be written.
  CommandLoop(CommandedRun& run,
              CommandChannel& channel,
              bool lockstep,
              const std::optional<std::filesystem::path>& log_file,
              const std::string& scenario_xxh3);

  /// Applies what has come to the frames that begin at this time, at most kMaxPerFrame so that no
  /// flood of commands holds them up; in lockstep waits for a step.
  [[nodiscard]] NextFrames BeginFrames(std::int64_t stamp_ns,
                                       const std::function<bool()>& is_stopped);
  /// Answers the step that made these frames.
  void EndFrames(std::int64_t stamp_ns);
  /// Refuses what waits: the run is over.
  void End(const std::string& reason);

 private:
  /// @return Whether it was a reset.
  [[nodiscard]] bool Handle(const CommandRequest& request, std::int64_t stamp_ns);

  CommandedRun& run_;
  CommandChannel& channel_;
  bool lockstep_;
  std::optional<LineFile> log_;
  std::optional<CommandRequest> step_;  ///< Under way.
};

}  // namespace railcast
