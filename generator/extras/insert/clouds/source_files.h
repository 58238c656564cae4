#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace railcast {

/// The files of a recording whose frames are in cloud files.
struct SourceFiles {
  std::filesystem::path directory;  ///< The folder that all names are relative to.
  /// For each frame: its cloud, and behind it the file of its labels if there is one.
  std::vector<std::vector<std::string>> frames;
  /// The files beside them, such as poses and calibrations, in order.
  std::vector<std::string> others;
  /// Received streams: the first line of frames.csv, and that of each frame. Such a file is none of
  /// `others`.
  std::vector<std::string> lines;
  std::string kitti_columns{};  ///< KittiSource::columns.
};

/// Finds the files of a cloud, of a directory of clouds, of KITTI's layout or of a received stream.
/// Returns nothing for other recordings, railcast's sequences among them.
[[nodiscard]] std::optional<SourceFiles> FindSourceFiles(const std::filesystem::path& recording);

}  // namespace railcast
