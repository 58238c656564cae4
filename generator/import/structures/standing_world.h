#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "generator/import/network/line_world.h"
#include "railcast/alignment.h"

namespace railcast {

/// Holds a world against the rules that `railcast-generate check` has for it (DraftWorld), and
/// leaves out the tracks and structures that break one, with all that depends on them, until none
/// does.
/// @param elevation Its elevation model; absent if it has none.
/// @returns What is wrong with the line itself, so that no world stands; absent if this one does.
[[nodiscard]] std::optional<std::string> MakeStand(
    const AlignmentSpec& alignment,
    const std::optional<std::filesystem::path>& elevation,
    LineWorld& world);

}  // namespace railcast
