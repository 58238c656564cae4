#pragma once

#include <filesystem>
#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// What a reader of a data set must know before using it: what is seen, parts, classes and objects,
/// what it was made of, its licence, and what its sensors and its model lack.
///
///     const Report card = MakeDatasetCard("out/small", "CC-BY-4.0", command);
///
/// @param dataset Folder of a whole, finished data set.
/// @param licence Under which it is given away, or empty if that is not known.
/// @param command Command line that made the card.
/// @throws InputError with one line if the folder is no such data set, or is damaged.
[[nodiscard]] Report MakeDatasetCard(const std::filesystem::path& dataset,
                                     const std::string& licence,
                                     const std::string& command);

/// The section on the recipe: what it says, and what the data set's bytes depend on.
/// @throws InputError with one line if recipe.json or dataset.json is damaged.
[[nodiscard]] Section MadeOfSection(const std::filesystem::path& dataset);

}  // namespace railcast
