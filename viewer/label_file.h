#pragma once

#include <filesystem>
#include <optional>

namespace railcast {

/// The labels.json that goes with a cloud: beside it, or beside the frames/ it lies in.
[[nodiscard]] std::optional<std::filesystem::path> FindLabelFile(
    const std::filesystem::path& cloud_file);

}  // namespace railcast
