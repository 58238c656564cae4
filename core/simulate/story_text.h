#pragma once

#include <cstdint>
#include <string>

#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/simulator.h"

namespace railcast {

/// Formats a firing's history for display: its direction, what it hit, the result of each effect,
/// and its echoes if there are several. Effects that added echoes show their number, as in "clutter
/// +2". The text consists of whole lines with aligned columns; unknown values are shown as a dash.
/// @param frame Index of the frame that the firing belongs to.
/// @pre story.material is an index into `materials`.
[[nodiscard]] std::string StoryText(std::uint32_t frame,
                                    const FiringStory& story,
                                    const LabelTable& labels,
                                    const MaterialLibrary& materials);

}  // namespace railcast
