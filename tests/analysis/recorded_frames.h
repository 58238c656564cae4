#pragma once

#include <cmath>
#include <string>

#include "core/frame/frame.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// A frame as a recording of ours has it: every field, slots are firings, the pose is known.
[[nodiscard]] inline RecordedFrame Record(Frame frame) {
  RecordedFrame recorded;
  ForEachField(frame,
               [&](const char* name, const char*, const auto&) { recorded.fields.emplace(name); });
  recorded.frame = std::move(frame);
  recorded.is_grid = true;
  recorded.has_pose = true;
  return recorded;
}

/// The same as another's sensor would have recorded it: positions, intensity, ring and column.
[[nodiscard]] inline RecordedFrame RecordPointsOnly(Frame frame) {
  RecordedFrame recorded = Record(std::move(frame));
  recorded.fields = {"x", "y", "z", "intensity", "range_m", "ring", "column"};
  recorded.has_pose = false;
  return recorded;
}

}  // namespace railcast
