#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/shard.h"
#include "core/extras/recipe/split_quota.h"
#include "core/io/run/run_folder.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// Everything that the bytes of a data set depend on.
struct DatasetSpec {
  std::filesystem::path directory;
  std::string recipe;    ///< Its text.
  DatasetRecord record;  ///< The record of the whole data set.
  Shard shard;
};

/// dataset.json of a data set or a shard.
[[nodiscard]] DatasetRecord RecordOf(const DatasetSpec& spec);

/// A folder with a data set, complete or unfinished: dataset.json, recipe.json, scenarios.jsonl
/// with a line for each scenario that is done, and sequences/NNN/NNNNNN. manifest.json says that it
/// is complete.
class DatasetDirectory {
 public:
  /// Creates the folder, or opens it and finds out how far its run has got.
  /// @throws InputError if it holds anything else, belongs to another data set, or is being written
  ///   by another process.
  explicit DatasetDirectory(DatasetSpec spec);

  /// Whether manifest.json exists.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// Number of the shard's scenarios that are done.
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  [[nodiscard]] const DatasetSpec& spec() const { return spec_; }
  /// What was not as it was written in a complete data set, a line each, once it is checked.
  [[nodiscard]] const std::vector<std::string>& changed() const { return changed_; }

  /// Reads all that is there against its hashes. The scenarios from the first one on that is not as
  /// it was written count as not done, and those of them that are whole as kept; a data set is
  /// complete only if all is whole.
  /// @param goes_on Called with the share that is read, in [0, 1]; returns false to stop.
  /// @return False if it was stopped; then nothing has been made anew.
  /// @throws InputError if a complete data set holds files of others.
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
  DatasetSpec spec_;
  std::optional<FolderLock> lock_;
  std::optional<LineFile> lines_;
  std::uint32_t num_found_ = 0;  ///< Lines when the folder was opened.
  std::uint32_t num_done_ = 0;
  std::map<std::uint32_t, std::string> kept_;
  bool is_complete_ = false;
  std::vector<std::string> changed_;
};

/// Writes the files about all scenarios of a data set whose sequences are complete: index.jsonl,
/// split/*.txt, report.json and, last, manifest.json with the hashes of all. They depend on the
/// files of the sequences alone, so that a merged data set has the same bytes as one that was made
/// at once. Removes an index.sqlite, which was made of an earlier index.
/// @return The scenarios of each part.
/// @throws InputError if a sequence cannot be read or the system refuses.
PerPart<std::uint32_t> WriteDatasetFiles(const DatasetSpec& spec);

/// Writes the manifest.json of a shard whose sequences are complete.
/// @throws InputError if a file cannot be read or the system refuses.
void WriteShardManifest(const DatasetSpec& spec);

}  // namespace railcast
