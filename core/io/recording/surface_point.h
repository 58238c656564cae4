#pragma once

#include <cmath>
#include <cstddef>

#include "railcast/io/recording.h"
#include "railcast/outcome.h"

namespace railcast {

/// Whether a slot holds a point that counts as measured on a surface. Where the outcome is
/// recorded, echoes of fog, drops and flakes and false alarms are known not to be; elsewhere every
/// point counts.
[[nodiscard]] inline bool HasSurfacePoint(const RecordedFrame& recorded, std::size_t slot) {
  const Frame& frame = recorded.frame;
  if (!std::isfinite(frame.range_m[slot])) return false;
  return !recorded.Has("outcome") || frame.outcome[slot] == Outcome::kReturned;
}

}  // namespace railcast
