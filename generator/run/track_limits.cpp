#include "generator/run/track_limits.h"

#include <vector>

namespace railcast {

void CheckStaysOnTracks(const CommandedRun& run,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame) {
  // Includes the frame after the last one.
  const auto first_at = [&](std::int64_t time_ns) {
    return FirstStampedAt(pattern, time_ns, first_frame, last_frame + 1);
  };
  const std::vector<CommandedRun::State>& states = run.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::uint32_t begin = i == 0 ? first_frame : first_at(states[i].time_ns);
    const std::uint32_t end =
        i + 1 < states.size() ? first_at(states[i + 1].time_ns) : last_frame + 1;
    if (begin >= end) continue;
    CheckStaysOnTracks(run.scenario(), *states[i].world, pattern, begin, end - 1);
  }
}

}  // namespace railcast
