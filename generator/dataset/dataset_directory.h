#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
#include "core/io/run/dataset_record.h"
#include "core/io/run/run_folder.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// Everything that the bytes of a data set depend on.
struct DatasetSpec {
  std::filesystem::path directory;
  std::string version;         ///< ProgramVersion().
  std::string embree_version;  ///< EmbreeVersion().
  std::string isa;             ///< IsaInUse() of the trace.
  std::string recipe;          ///< Its text.
  std::vector<std::string> base_hashes;
  std::string files_hash;  ///< HashOfRecipeFiles().
  std::uint32_t num_scenarios{};
  std::string format;
  std::string fields;
  bool is_merged{};  ///< Whether the clouds of several sensors are merged, too.
  Shard shard;
};

/// dataset.json of a data set.
[[nodiscard]] DatasetRecord RecordOf(const DatasetSpec& spec);

/// A folder with a data set, complete or unfinished: dataset.json, recipe.json, scenarios.jsonl
/// with a line for each scenario that is done, and sequences/NNN/NNNNNN. manifest.json says that it
/// is complete.
class DatasetDirectory {
 public:
  /// Creates the folder, or opens it and finds out how far its run has got.
  /// @throws InputError if it holds anything else, belongs to another data set, is complete but has
  ///   a line that was changed since, or is being written by another process.
  explicit DatasetDirectory(DatasetSpec spec);

  /// Whether manifest.json exists.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// Number of the shard's scenarios that are done.
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  [[nodiscard]] const DatasetSpec& spec() const { return spec_; }

  /// Reads all that is there against its hashes: a data set that is complete must be so as it was
  /// written. Else the scenarios from the first one on that is not count as not done, and those of
  /// them that are whole as kept.
  /// @param goes_on Called with the share that is read, in [0, 1]; returns false to stop.
  /// @return False if it was stopped; then nothing has changed.
  /// @throws InputError with a line for each fault of a complete data set.
  [[nodiscard]] bool Check(const std::function<bool(double share)>& goes_on);
  /// Whether the shard's i-th scenario was done when the folder was opened.
  [[nodiscard]] bool WasDone(std::uint32_t i) const { return i < num_found_; }
  /// The record of a scenario that is kept; null if it is none.
  [[nodiscard]] const std::string* Kept(std::uint32_t i) const;
  [[nodiscard]] std::uint32_t num_kept() const { return static_cast<std::uint32_t>(kept_.size()); }

  /// Adds the record of the next scenario, whose sequence is complete, as a line.
  void Append(const std::string& record);
  /// Waits until all lines are on the disk.
  void Sync();

 private:
  void CheckSameDataset() const;

  DatasetSpec spec_;
  std::optional<FolderLock> lock_;
  std::optional<LineFile> lines_;
  std::uint32_t num_found_ = 0;  ///< Lines when the folder was opened.
  std::uint32_t num_done_ = 0;
  std::map<std::uint32_t, std::string> kept_;
  bool is_complete_ = false;
};

}  // namespace railcast
