#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/run/sequence_files.h"

namespace railcast {

/// The images of a camera beside the frames of a sequence directory (docs/files.md).
struct ImageList {
  /// The images of one frame.
  struct FrameImages {
    std::size_t place{};  ///< Place of the frame, counted from 0 in the directory.
    std::uint32_t frame{};
    std::vector<KnownFile> files;

    /// Returns the image of a kind; null if there is none.
    /// @param folder As CameraFileKinds() names it: "color/".
    [[nodiscard]] const KnownFile* Find(std::string_view folder) const;
  };
  std::filesystem::path directory;
  std::vector<FrameImages> frames;  ///< Frames that have images, in order.

  /// Returns the latest images that were there when a frame was taken: its own, or those before it
  /// where the camera has a lower rate; null if there are none.
  [[nodiscard]] const FrameImages* LatestAt(std::size_t place) const;

  /// Returns the bytes of an image.
  /// @throws InputError with one line if the file is missing or not what frames.jsonl says.
  [[nodiscard]] std::string Read(const KnownFile& file) const;
};

/// Reads which images a directory has. None if it is not that of a sequence with a camera; then no
/// file is read.
/// @throws InputError with one line if frames.jsonl is damaged.
[[nodiscard]] ImageList ReadImageList(const std::filesystem::path& directory);

/// Returns the camera's name: "front" of "camera/front/color/000000.png".
/// @pre IsCameraFile(name)
[[nodiscard]] std::string CameraNameIn(std::string_view name);

}  // namespace railcast
