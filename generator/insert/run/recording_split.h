#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace railcast {

/// Returns the part of its data set that a recording belongs to, "train", "val" or "test"; nothing
/// if it is not a sequence of one.
[[nodiscard]] std::optional<std::string> SplitOfRecording(const std::filesystem::path& recording);

}  // namespace railcast
