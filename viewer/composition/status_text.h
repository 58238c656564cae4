#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "railcast/frame.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns "frame 20   2.000 s   26,812 points", without the time where the frame has none.
[[nodiscard]] std::string FrameText(const ShownFrame& shown);

/// Returns "with 15 frames before it   253,104 points"; empty for a single frame.
[[nodiscard]] std::string AccumulatedText(const Composition& composition);

/// Returns the share of firings that met a surface and were lost, by cause, counted as in
/// `railcast-analyze stats`: "dropout 4.8 % (below_threshold 3.1, rain_absorbed 1.7)   clutter 12".
/// Empty if the frame has no outcomes.
[[nodiscard]] std::string DropoutText(const RecordedFrame& recorded);

/// Returns "selected wagon, person: 812 points"; empty if no label is selected.
[[nodiscard]] std::string SelectionText(const ShownFrame& shown,
                                        const std::set<std::uint32_t>& labels,
                                        const LabelTable& table);

/// Returns a number with its digits in groups of three: "12,345,678".
[[nodiscard]] std::string GroupedDigits(std::uint64_t number);

}  // namespace railcast
