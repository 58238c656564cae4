#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "generator/live/command_source.h"
#include "generator/live/live_run.h"

namespace railcast {

/// Lets each frame of a replay wait for the command `step`, which is answered when the frame has
/// been sent. All other commands are refused: they would change a simulation.
class StepLoop {
 public:
  /// @param source Must outlive this object.
  explicit StepLoop(CommandSource& source) : source_(source) {}

  [[nodiscard]] NextFrames AwaitStep(const std::function<bool()>& is_stopped);
  /// Answers the step.
  /// @param time_ns Time of the replay at which its frame begins.
  void EndStep(std::int64_t time_ns);
  /// Refuses what waits when the replay has ended.
  void End(const std::string& reason);

 private:
  CommandSource& source_;
  std::optional<CommandRequest> step_;  ///< The one under way.
};

}  // namespace railcast
