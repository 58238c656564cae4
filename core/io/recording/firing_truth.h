#pragma once

#include <cmath>
#include <cstddef>

#include "railcast/frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Whether the outcomes of all slots are known. Files of points alone have those of points; slots
/// without a point then have 0.
[[nodiscard]] inline bool HasAllOutcomes(const RecordedFrame& recorded) {
  const std::size_t num_entries = recorded.slot_of_entry.size();
  return recorded.Has("outcome") && (num_entries == 0 || num_entries >= recorded.frame.num_slots());
}

/// Whether a recording says what became of each firing; dropout is then counted instead of
/// estimated.
[[nodiscard]] inline bool HasOutcomes(const RecordedFrame& recorded) {
  return recorded.is_grid && HasAllOutcomes(recorded);
}

/// Whether the first slot of a firing says which surface of the scene the beam met. It does not
/// where the return came from clutter or where the vehicle itself blocked the beam.
[[nodiscard]] inline bool KnowsSurface(const Frame& frame, std::size_t slot) {
  const Outcome outcome = frame.outcome[slot];
  return outcome != Outcome::kClutter && outcome != Outcome::kEgo &&
         std::isfinite(frame.true_range_m[slot]);
}

/// Whether it is known that the vehicle itself blocked a firing. Such a firing has no return, but
/// the scene has not lost one.
/// @param slot The first slot of the firing.
[[nodiscard]] inline bool IsOnOwnVehicle(const RecordedFrame& recorded, std::size_t slot) {
  return HasOutcomes(recorded) && recorded.frame.outcome[slot] == Outcome::kEgo;
}

}  // namespace railcast
