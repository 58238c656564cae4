#pragma once

#include <cmath>
#include <cstddef>

#include "core/frame/frame.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// Whether a recording says what became of each firing: then dropout is counted, not estimated.
[[nodiscard]] inline bool HasOutcomes(const RecordedFrame& recorded) {
  return recorded.is_grid && recorded.Has("outcome");
}

/// Whether the first slot of a firing says which surface of the scene the beam met: not where
/// clutter answered, nor where the vehicle itself was in the way.
[[nodiscard]] inline bool KnowsSurface(const Frame& frame, std::size_t slot) {
  const Outcome outcome = frame.outcome[slot];
  return outcome != Outcome::kClutter && outcome != Outcome::kEgo &&
         std::isfinite(frame.true_range_m[slot]);
}

/// Whether it is known that the vehicle itself was in a firing's way: it brought nothing back, and
/// the scene has lost nothing. @param slot The firing's first.
[[nodiscard]] inline bool IsOnOwnVehicle(const RecordedFrame& recorded, std::size_t slot) {
  return HasOutcomes(recorded) && recorded.frame.outcome[slot] == Outcome::kEgo;
}

}  // namespace railcast
