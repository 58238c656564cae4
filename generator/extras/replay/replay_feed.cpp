#include "generator/extras/replay/replay_feed.h"

#include <algorithm>
#include <cmath>

namespace railcast {

std::int64_t ReplayTimes::Of(std::int64_t recorded_ns) {
  constexpr double kMost_ns = 4e18;  // 127 years, and half of what fits.
  std::int64_t step_ns = 0;
  // Hostile files have any time.
  const bool is_far =
      __builtin_sub_overflow(recorded_ns, latest_ns_.value_or(recorded_ns), &step_ns);
  if (is_far || step_ns < -kOvertaken_ns) {
    latest_ns_ = recorded_ns;
  } else {
    latest_ns_ = std::max(recorded_ns, latest_ns_.value_or(recorded_ns));
    since_ns_ += static_cast<double>(std::max<std::int64_t>(step_ns, 0)) / pace_;
  }
  since_ns_ = std::min(since_ns_, kMost_ns);
  return std::llround(since_ns_);
}

std::int64_t ReplayTimes::Lasting(std::int64_t duration_ns) const {
  return std::llround(static_cast<double>(duration_ns) / pace_);
}

}  // namespace railcast
