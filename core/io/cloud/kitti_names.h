#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "railcast/frame.h"

namespace railcast {

// The names of labels in clouds of KITTI's layout, from the configuration of semantic-kitti-api.

/// Reads the keys `labels` (names by number) and, if there is one, `color_map` (blue, green, red by
/// number; grey where it has none). Other keys are of no concern here.
/// @param place Names the file in errors.
/// @return Labels in rising order whose Label::id and Label::semantic_kitti are the number.
/// @throws InputError with a line for each fault.
[[nodiscard]] LabelTable ParseSemanticKittiNames(const std::string& yaml, const std::string& place);

/// Finds the configuration, semantic-kitti*.yaml, that belongs to clouds: in their folder, or,
/// where that is called velodyne, in it or at most three above, from the nearest on.
/// @throws InputError if a folder holds several.
[[nodiscard]] std::optional<std::filesystem::path> FindSemanticKittiYaml(
    const std::filesystem::path& clouds);

/// The names that belong to the clouds in a folder; empty if there is no configuration.
/// @throws InputError as the two above do.
[[nodiscard]] LabelTable SemanticKittiNamesOf(const std::filesystem::path& clouds);

}  // namespace railcast
