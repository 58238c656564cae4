#pragma once

#include <functional>

#include "generator/live/live_clock.h"
#include "generator/live/live_run.h"
#include "generator/replay/replay_feed.h"
#include "generator/replay/step_loop.h"

namespace railcast {

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
