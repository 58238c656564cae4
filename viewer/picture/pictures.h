#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include <vtkRenderWindow.h>

namespace railcast {

/// Writes what the window shows as a PNG.
/// @throws InputError if the file cannot be written.
void WritePicture(vtkRenderWindow& window, const std::filesystem::path& file);

/// The folder of a video's pictures: 000000.png, 000001.png, ...
class PictureFolder {
 public:
  /// Makes it.
  /// @throws InputError if it cannot be made, or holds anything: a video replaces no other.
  explicit PictureFolder(const std::filesystem::path& directory);

  /// @throws InputError if the file cannot be written.
  void Add(vtkRenderWindow& window);
  [[nodiscard]] std::size_t num_pictures() const { return num_pictures_; }

 private:
  std::filesystem::path directory_;
  std::size_t num_pictures_{};
};

}  // namespace railcast
