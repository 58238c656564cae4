#pragma once

#include "railcast/frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A frame as railcast records it: with every field, with firings as slots, and with a known pose.
[[nodiscard]] inline RecordedFrame Record(Frame frame) {
  RecordedFrame recorded;
  ForEachField(frame,
               [&](const char* name, const char*, const auto&) { recorded.fields.emplace(name); });
  recorded.frame = std::move(frame);
  recorded.is_grid = true;
  recorded.has_pose = true;
  return recorded;
}

/// The frame as a foreign recording has it: positions, intensity, ring and column only.
[[nodiscard]] inline RecordedFrame RecordPointsOnly(Frame frame) {
  RecordedFrame recorded = Record(std::move(frame));
  recorded.fields = {"x", "y", "z", "intensity", "range_m", "ring", "column"};
  recorded.has_pose = false;
  return recorded;
}

}  // namespace railcast
