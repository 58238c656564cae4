#pragma once

#include <filesystem>
#include <optional>

#include "core/frame/labels.h"

namespace railcast {

/// The labels.json that goes with a cloud: beside it, or beside the frames/ it lies in.
[[nodiscard]] std::optional<std::filesystem::path> FindLabelFile(
    const std::filesystem::path& cloud_file);

/// Ids, names and colours of a label table.
/// @throws InputError with one line if it cannot be read.
[[nodiscard]] LabelTable ReadLabelFile(const std::filesystem::path& file);

}  // namespace railcast
