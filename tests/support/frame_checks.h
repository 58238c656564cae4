#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railcast/frame.h"

namespace railcast {

/// Expects what holds for every slot, whatever the scene: a point has a finite range inside the
/// gate and finite coordinates, a slot without a point has NaN, and an incidence angle is within
/// its limits.
inline void ExpectSoundSlots(const Frame& frame, float range_min_m, float range_max_m) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const Outcome outcome = frame.outcome[slot];
    const bool has_point = HasPoint(outcome);
    ASSERT_EQ(std::isfinite(frame.range_m[slot]), has_point) << OutcomeName(outcome);
    ASSERT_EQ(std::isfinite(frame.x[slot] + frame.y[slot] + frame.z[slot]), has_point);
    if (has_point) {
      ASSERT_GE(frame.range_m[slot], range_min_m);
      ASSERT_LE(frame.range_m[slot], range_max_m);
    }
    if (outcome == Outcome::kNoSurface) {
      ASSERT_TRUE(std::isnan(frame.incidence_rad[slot]));
      ASSERT_EQ(frame.label[slot], 0U);
    } else if (outcome == Outcome::kReturned || outcome == Outcome::kNearRange) {
      ASSERT_GE(frame.incidence_rad[slot], 0.0F);
      ASSERT_LE(frame.incidence_rad[slot], std::numbers::pi_v<float> / 2.0F);
      ASSERT_TRUE(std::isfinite(frame.true_range_m[slot]));
    }
  }
}

}  // namespace railcast
