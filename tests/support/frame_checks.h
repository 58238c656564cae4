#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "railcast/frame.h"

namespace railcast {

/// What is wrong with a slot, whatever the scene; null if nothing is: a point has a finite range
/// inside the gate and finite coordinates, a slot without a point has NaN, and an incidence angle
/// is within its limits.
inline const char* FaultOfSlot(const Frame& frame,
                               std::size_t slot,
                               float range_min_m,
                               float range_max_m) {
  const Outcome outcome = frame.outcome[slot];
  const float range_m = frame.range_m[slot];
  const bool has_point = HasPoint(outcome);
  if (std::isfinite(range_m) != has_point) return "its range does not fit its outcome";
  if (std::isfinite(frame.x[slot] + frame.y[slot] + frame.z[slot]) != has_point) {
    return "its coordinates do not fit its outcome";
  }
  if (has_point && !(range_m >= range_min_m && range_m <= range_max_m)) {
    return "its range is outside the gate";
  }
  const float incidence_rad = frame.incidence_rad[slot];
  if (outcome == Outcome::kNoSurface) {
    if (!std::isnan(incidence_rad)) return "it has an incidence angle without a surface";
    if (frame.label[slot] != 0) return "it has a label without a surface";
  } else if (outcome == Outcome::kReturned || outcome == Outcome::kNearRange) {
    const bool is_angle =
        incidence_rad >= 0.0F && incidence_rad <= std::numbers::pi_v<float> / 2.0F;
    if (!is_angle) return "its incidence angle is outside its limits";
    if (!std::isfinite(frame.true_range_m[slot])) return "its true range is not finite";
  }
  return nullptr;
}

/// Expects every slot to be sound. Frames may have millions, so that an assertion is made of faults
/// alone.
inline void ExpectSoundSlots(const Frame& frame, float range_min_m, float range_max_m) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const char* const fault = FaultOfSlot(frame, slot, range_min_m, range_max_m);
    if (fault == nullptr) continue;
    FAIL() << "slot " << slot << " (" << OutcomeName(frame.outcome[slot]) << "): " << fault
           << ", range " << frame.range_m[slot] << " m";
  }
}

}  // namespace railcast
