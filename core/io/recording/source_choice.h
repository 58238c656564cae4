#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railcast {

/// What users say of recordings that do not say it themselves; empty: nothing.
struct SourceChoice {
  std::string topic{};          ///< Of bags.
  std::string kitti_columns{};  ///< Of .bin files, as IsKittiColumns().
  std::string sensor{};         ///< Of captures, as ParseSender().
};

/// Returns the sources with what was chosen behind those that it is for: "run.mcap:/points",
/// "drive:nuscenes".
/// @throws InputError if something is chosen that is for no source.
[[nodiscard]] std::vector<std::filesystem::path> WithChoice(
    std::vector<std::filesystem::path> sources, const SourceChoice& choice);

}  // namespace railcast
