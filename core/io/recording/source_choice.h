#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railcast {

/// Returns the sources with those that are bags replaced by this topic of theirs.
/// @param topic Empty: the sources as they are.
/// @throws InputError if a topic is given and no source is a bag.
[[nodiscard]] std::vector<std::filesystem::path> WithTopic(
    std::vector<std::filesystem::path> sources, const std::string& topic);

}  // namespace railcast
