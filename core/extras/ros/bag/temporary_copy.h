#pragma once

#include <filesystem>

namespace railcast::bag {

/// A folder for copies of a bag's files, in the system's temporary folder. It is deleted with its
/// content as soon as these have been opened, so that nothing stays if the program is killed later.
class TemporaryCopy {
 public:
  /// @throws InputError "folder: reason" if the system refuses.
  TemporaryCopy();
  ~TemporaryCopy();
  TemporaryCopy(const TemporaryCopy&) = delete;
  TemporaryCopy& operator=(const TemporaryCopy&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Copies a file into the folder.
  void Add(const std::filesystem::path& file) const;
  /// Uncompresses a .zstd file into the folder and returns the result's path.
  /// @throws InputError as mcap::UncompressFile() does.
  [[nodiscard]] std::filesystem::path AddUncompressed(const std::filesystem::path& file) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace railcast::bag
