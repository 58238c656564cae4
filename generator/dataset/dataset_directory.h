#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
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
[[nodiscard]] Json DatasetJson(const DatasetSpec& spec);

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

  /// Adds the line of the next scenario, whose sequence is complete.
  void Append(const Json& line);
  /// Waits until all lines are on the disk.
  void Sync();

 private:
  void CheckSameDataset() const;

  DatasetSpec spec_;
  std::optional<FolderLock> lock_;
  std::optional<LineFile> lines_;
  std::uint32_t num_done_ = 0;
  bool is_complete_ = false;
};

}  // namespace railcast
