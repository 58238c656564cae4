#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "generator/extras/replay/replay_feed.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_clock.h"
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

struct ReplayRunSpec {
  /// How long a replay reads ahead, and hence after how long it begins.
  static constexpr std::int64_t kLead_ns = 200'000'000;

  Pacing pacing = Pacing::kSpread;
  StepLoop* steps = nullptr;  ///< Null: frames are sent at their times.
  bool states_utc = false;    ///< As ReplayFeed::SetClock() does.
  std::function<bool()> is_stopped = [] { return false; };
  std::function<void(const RunState&)> show = [](const RunState&) {};  ///< After each frame.
};

/// Sends the frames of a recording to its end, or until stopped. A frame is late if it has not been
/// read when it begins; what was sent before it is not delayed by that.
/// @throws InputError if the first frame cannot be read. What cannot be read later ends the run, as
///   its result says.
[[nodiscard]] LiveResult RunReplay(ReplayFeed& feed, const ReplayRunSpec& spec, LiveClock& clock);

}  // namespace railcast
