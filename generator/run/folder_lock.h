#pragma once

#include <filesystem>

namespace railcast {

/// Keeps other processes of railcast from writing to a folder while it exists.
class FolderLock {
 public:
  /// @throws InputError if the folder cannot be opened, or "FOLDER: another run is writing here".
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace railcast
