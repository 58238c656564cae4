#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "generator/extras/insert/inserted_frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Expects a frame as read again to have the edits and to be as recorded in all other slots. Ranges
/// of new returns are rounded to units of at most 8 mm.
inline void ExpectEdits(const InsertedFrame& inserted, const RecordedFrame& read) {
  const auto is_same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const Frame& expected = inserted.recorded.frame;
  const Frame& got = read.frame;
  ASSERT_EQ(got.num_slots(), expected.num_slots());
  std::vector<const SlotEdit*> edits(expected.num_slots());
  for (const SlotEdit& edit : inserted.edits) edits[edit.slot] = &edit;
  std::size_t num_wrong = 0;
  for (std::size_t i = 0; i < got.num_slots(); ++i) {
    const SlotEdit* const edit = edits[i];
    const bool has_range = edit != nullptr && edit->is_added
                               ? std::abs(got.range_m[i] - expected.range_m[i]) <= 0.0041F
                               : is_same(got.range_m[i], expected.range_m[i]);
    // A byte of no known scale is none.
    const bool has_intensity = read.Has("intensity")
                                   ? is_same(got.intensity[i], expected.intensity[i])
                                   : std::isnan(got.intensity[i]);
    const bool is_right =
        has_range && has_intensity && (edit != nullptr || is_same(got.x[i], expected.x[i]));
    num_wrong += is_right ? 0 : 1;
  }
  EXPECT_EQ(num_wrong, 0U);
  EXPECT_EQ(got.time_ns, expected.time_ns);
}

}  // namespace railcast
