#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/run/frame_record.h"
#include "core/io/run/run_folder.h"

namespace railcast {

/// A file of a folder that gets one line for each of its items; those of motion sensors, one for
/// each sample.
struct LineFileName {
  std::string name;
  std::string header;
};

/// What the line of an item in the last file says.
struct LedgerItem {
  std::vector<KnownFile> files;
  std::string records_hash;  ///< Hash of the item's lines in the other files, one after another.
  std::vector<std::uint32_t> num_lines;  ///< In each of these.
};

/// The lines of a folder of numbered items, such as the frames of a sequence. An item is done once
/// its line in the last file is whole, its lines in the other files have the hash that this line
/// states, and so have the files that it names. What else is there, an interrupted run or damage
/// has left.
class LineLedger {
 public:
  LineLedger(std::filesystem::path directory, std::vector<LineFileName> files)
      : directory_(std::move(directory)), files_(std::move(files)) {}

  /// Counts the first items that are done.
  /// @param read Reads the line of the i-th item; returns nothing if it is not that.
  /// @param on_done Called for each item that is done, with its lines in the other files.
  /// @throws InputError if a file is there, but cannot be read.
  std::uint32_t Count(
      std::uint32_t most,
      const std::function<std::optional<LedgerItem>(std::uint32_t i, std::string_view line)>& read,
      const std::function<void(std::string_view records)>& on_done = [](std::string_view) {});
  /// The first file that holds anything else than the items that were counted; empty if there is
  /// none.
  [[nodiscard]] std::string FileWithOthers() const;

  /// Drops all lines but those of the items that were counted last.
  /// @throws InputError if the system refuses.
  void Open();
  /// Adds an item's lines; its own comes last and makes it count as done.
  /// @param own Returns its own line, given the hash of the others.
  void Append(const std::vector<std::string>& records,
              const std::function<std::string(std::string records_hash)>& own);
  /// Waits until all lines are on the disk.
  void Sync();

  [[nodiscard]] const std::vector<LineFileName>& files() const { return files_; }

 private:
  std::filesystem::path directory_;
  std::vector<LineFileName> files_;
  std::vector<std::uint64_t> sizes_;  ///< Sizes of the files, up to the items that were counted.
  std::vector<LineFile> open_;
};

/// Whether a file is there and has the content that was written.
/// @throws InputError if it cannot be read.
[[nodiscard]] bool HasContent(const std::filesystem::path& directory, const KnownFile& file);

}  // namespace railcast
