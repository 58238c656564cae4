#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/file_descriptor.h"

namespace railcast {

/// Makes the folder that a run writes to, if there is none, and keeps other processes of railcast
/// from writing there while this exists. The folder itself may be a symbolic link, but nothing in
/// it: what the link leads to would be written in place of the run's own file.
class FolderLock {
 public:
  /// @throws InputError if the folder cannot be made or opened; "FOLDER: another run is writing
  ///   here"; or "FOLDER: holds a symbolic link, which no run makes (frames/000003.pcd); ...".
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  FileDescriptor descriptor_;
};

/// A text file that grows line by line.
class LineFile {
 public:
  /// Opens or creates the file and truncates it to its first `keep_bytes`.
  /// @throws InputError as CheckIsOwnFile(), or if the system refuses.
  LineFile(std::filesystem::path file, std::uint64_t keep_bytes);

  /// Appends whole lines, or nothing on failure.
  /// @throws InputError if the system refuses, for example on a full disk.
  void Append(std::string_view lines);

  /// Waits until all lines are on the disk.
  /// @throws InputError if they cannot be written.
  void Sync();

 private:
  std::filesystem::path file_;
  std::uint64_t size_;
  FileDescriptor descriptor_;
};

/// Where a path leads, links followed; it need not exist. What has no name, such as the pipe that
/// /dev/stdin leads to, stays as it is given.
/// @throws InputError if the system cannot follow it, such as a link to itself.
[[nodiscard]] std::filesystem::path FollowedPath(const std::filesystem::path& path);

/// Whether a path leads to a folder or into it, links followed. Neither need exist.
/// @throws InputError if the system cannot follow a path, such as a link to itself.
[[nodiscard]] bool IsInFolder(const std::filesystem::path& path,
                              const std::filesystem::path& folder);

/// Checks that a file or folder is to be written neither as nor into the folder of a run, several
/// sensors' runs, an insertion, a conversion, a data set, a study or a survey, which hold nothing
/// but their own files.
/// @param option Names the path: "--out".
/// @param may_be_own Whether it may be such a folder itself, which its command judges.
/// @throws InputError "--out: must be outside a/run, which holds nothing but what belongs to its
///   frames.jsonl (got a/run/stats)".
void CheckIsOutside(const std::string& option,
                    const std::filesystem::path& path,
                    bool may_be_own = false);

/// A path of the command line, empty if it is not given.
struct GivenPath {
  std::string option;  ///< "--summary".
  std::filesystem::path path;
};

/// Checks that files can be written, outside of the folders of CheckIsOutside(), and over neither
/// what a command reads nor each other. Leaves nothing behind.
/// @throws InputError as CheckIsOutside(); "--summary: must not be SCENARIO or in it (got a.json)";
///   or as CheckCanWrite().
void CheckOutputFiles(std::vector<GivenPath> inputs, const std::vector<GivenPath>& outputs);

/// Makes a folder and those that it lies in, unless they are there.
/// @throws InputError if the system refuses.
void MakeFolders(const std::filesystem::path& folder);

/// Returns the name of a symbolic link in a folder or below it; nothing if there is none.
/// @throws InputError if a folder cannot be read.
[[nodiscard]] std::optional<std::string> FindLink(const std::filesystem::path& folder);

/// Checks that what a command writes into a folder, which may hold other things, leads nowhere
/// else.
/// @param own Names of its files and folders; those need not exist.
/// @throws InputError "out/charts: must not be a symbolic link" if one is, or holds one.
void RefuseLinks(const std::filesystem::path& folder, const std::vector<std::string>& own);

/// Refuses a folder because of a file in it that its run has not written: it could be mistaken for
/// one of the run's, or be lost when the run cleans up.
/// @throws InputError "FOLDER: holds a file that does not belong to this run (notes.txt); ...".
[[noreturn]] void RefuseStranger(const std::filesystem::path& folder, const std::string& name);

/// What a command says that has found a complete folder of its own with faults, and has made anew
/// what they name; empty if there were none.
[[nodiscard]] std::string MendedText(const std::vector<std::string>& faults);

}  // namespace railcast
