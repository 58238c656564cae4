#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace railcast {

/// Makes the folder that a run writes to, if there is none, and keeps other processes of railcast
/// from writing there while this exists.
class FolderLock {
 public:
  /// @throws InputError if the folder cannot be made or opened, or "FOLDER: another run is writing
  ///   here".
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// A text file that grows line by line.
class LineFile {
 public:
  /// Opens or creates the file and truncates it to its first `keep_bytes`.
  /// @throws InputError if the system refuses.
  LineFile(std::filesystem::path file, std::uint64_t keep_bytes);
  ~LineFile();
  LineFile(LineFile&& other) noexcept;
  LineFile& operator=(LineFile&&) = delete;
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Appends whole lines, or nothing on failure.
  /// @throws InputError if the system refuses, for example on a full disk.
  void Append(std::string_view lines);

  /// Waits until all lines are on the disk.
  /// @throws InputError if they cannot be written.
  void Sync();

 private:
  std::filesystem::path file_;
  std::uint64_t size_;
  int descriptor_;
};

/// Whether a path leads to a folder or into it, links followed. Neither need exist.
/// @throws InputError if the system cannot follow a path, such as a link to itself.
[[nodiscard]] bool IsInFolder(const std::filesystem::path& path,
                              const std::filesystem::path& folder);

/// Makes a folder and those that it lies in, unless they are there.
/// @throws InputError if the system refuses.
void MakeFolders(const std::filesystem::path& folder);

}  // namespace railcast
