#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include <vtkRenderWindow.h>

namespace railcast {

/// Writes the contents of the window as a PNG file.
/// @throws InputError if the file cannot be written.
void WritePicture(vtkRenderWindow& window, const std::filesystem::path& file);

/// The folder of a video's pictures: 000000.png, 000001.png, ...
class PictureFolder {
 public:
  /// Creates the folder.
  /// @throws InputError if it cannot be created or is not empty, so that no video is overwritten.
  explicit PictureFolder(const std::filesystem::path& directory);

  /// Adds the next picture.
  /// @throws InputError if the file cannot be written.
  void Add(vtkRenderWindow& window);
  [[nodiscard]] std::size_t num_pictures() const { return num_pictures_; }

 private:
  std::filesystem::path directory_;
  std::size_t num_pictures_{};
};

}  // namespace railcast
