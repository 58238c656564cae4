#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "core/frame/labels.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// "frame 20   2.000 s   26,812 points". The time is left out where there is none.
[[nodiscard]] std::string FrameText(const ShownFrame& shown);

/// "with 15 frames before it   253,104 points"; empty if there is but one.
[[nodiscard]] std::string AccumulatedText(const Scene& scene);

/// Lost of the firings that met a surface, by cause, as `railcast-analyze stats` counts them:
/// "dropout 4.8 % (below_threshold 3.1, rain_absorbed 1.7)   clutter 12". Empty if the frame does
/// not say what became of its firings.
[[nodiscard]] std::string DropoutText(const RecordedFrame& recorded);

/// "selected wagon, person: 812 points"; empty without a selection.
[[nodiscard]] std::string SelectionText(const ShownFrame& shown,
                                        const std::set<std::uint32_t>& labels,
                                        const LabelTable& table);

/// "12,345,678"
[[nodiscard]] std::string GroupedDigits(std::uint64_t number);

}  // namespace railcast
