#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "generator/live/command_channel.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_folder.h"

namespace railcast {

/// Applies the commands of a channel to a run and logs them.
class CommandLoop {
 public:
  static constexpr int kMaxPerFrame = 16;

  /// @param lockstep Whether frames wait for the command `step`.
  /// @param log_file File for the log that `sequence --commands` replays, if any.
  /// @param scenario_xxh3 Hash of the scenario that the log is for.
  /// @throws InputError if the log already exists or cannot be written.
  CommandLoop(FrameMaker& maker,
              CommandChannel& channel,
              bool lockstep,
              const std::optional<std::filesystem::path>& log_file,
              const std::string& scenario_xxh3);

  /// Applies waiting commands to the frames that begin at this time, at most kMaxPerFrame so that a
  /// flood of commands cannot delay them; in lockstep, waits for a step.
  [[nodiscard]] NextFrames BeginFrames(std::int64_t stamp_ns,
                                       const std::function<bool()>& is_stopped);
  /// Answers the step that made these frames.
  void EndFrames(std::int64_t stamp_ns);
  /// Refuses all waiting commands when the run has ended.
  void End(const std::string& reason);

 private:
  /// @return Whether the command was a reset.
  [[nodiscard]] bool Handle(const CommandRequest& request, std::int64_t stamp_ns);

  FrameMaker& maker_;
  CommandChannel& channel_;
  bool lockstep_;
  std::optional<LineFile> log_;
  std::optional<CommandRequest> step_;  ///< The step under way.
};

}  // namespace railcast
