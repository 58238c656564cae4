#pragma once

#include <cstdint>
#include <string>

#include "core/frame/labels.h"
#include "core/scene/material.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// A firing's way for people: where it went, what it hit, what each effect made of it, and its
/// echoes if there are several. Whole lines, columns aligned; what is not known is a dash.
/// @param frame The one that the story is of.
/// @pre story.material is of `materials`.
[[nodiscard]] std::string StoryText(std::uint32_t frame,
                                    const FiringStory& story,
                                    const LabelTable& labels,
                                    const MaterialLibrary& materials);

}  // namespace railcast
