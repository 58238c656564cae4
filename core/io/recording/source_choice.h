#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/io/endpoint.h"

namespace railcast {

/// What users say of recordings that do not say it themselves; empty: nothing.
struct SourceChoice {
  std::string topic{};          ///< For bags.
  std::string frame_id{};       ///< For a topic of bags.
  std::string kitti_columns{};  ///< For .bin files, as IsKittiColumns().
  std::string columns{};        ///< For clouds in text, as IsTextColumns().
  std::string sensor{};         ///< For captures, as ParseSender().
};

/// Returns the sources with what was chosen behind those that it is for: "run.mcap:/points",
/// "drive:nuscenes".
/// @throws InputError if something is chosen that is for no source.
[[nodiscard]] std::vector<std::filesystem::path> WithChoice(
    std::vector<std::filesystem::path> sources, const SourceChoice& choice);

/// Reads "192.168.1.201", "192.168.1.201:2368" or, of IPv6, "fe80::1" and "[fe80::1]:2368"; port 0
/// is any. Nothing of what is no address in numbers.
[[nodiscard]] std::optional<Endpoint> ParseSender(std::string_view text);

}  // namespace railcast
