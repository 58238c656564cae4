#include "generator/live/lag_report.h"

#include <iomanip>
#include <sstream>

#include "core/base/units.h"

namespace railcast {

std::optional<std::string> LagReport::After(const RunState& state) {
  std::uint64_t num_made = 0;
  std::uint64_t num_late = 0;
  std::uint64_t num_dropped = 0;
  for (const LiveRecord& record : state.records) {
    num_made += record.frames;
    num_late += record.late_frames;
    num_dropped += record.dropped_frames;
  }
  const bool keeps_up = drops_late_ ? num_dropped == num_dropped_ : state.behind_ns < kLag_ns;
  if (keeps_up) return std::nullopt;
  if (said_ns_ && state.now_ns - *said_ns_ < kPause_ns) return std::nullopt;
  said_ns_ = state.now_ns;
  num_dropped_ = num_dropped;
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "cannot keep up: ";
  if (drops_late_) {
    text << num_dropped << " of " << num_made + num_dropped << " frames dropped after "
         << SecondsFromNs(state.stamp_ns) << " s";
  } else {
    text << SecondsFromNs(state.behind_ns) << " s behind after " << SecondsFromNs(state.stamp_ns)
         << " s, " << num_late << " of " << num_made
         << " frames late; --drop-late drops frames instead";
  }
  return text.str();
}

}  // namespace railcast
