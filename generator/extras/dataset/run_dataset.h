#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/extras/recipe/split_quota.h"
#include "generator/extras/dataset/dataset_directory.h"
#include "generator/run/run_plan.h"

namespace railcast {

/// How a recipe's frames are made; which ones the recipe says. The format of a recipe of plans may
/// also be "same": that of the recordings.
struct DatasetChoices : RunChoices {
  Shard shard;
  /// Whether `certify` was asked for, so that a recipe of which nothing can be certified is
  /// refused.
  bool must_certify = false;
};

/// How far a run has got.
struct DatasetProgress {
  std::uint32_t num_done{};       ///< Scenarios of the shard that are done.
  std::uint32_t num_scenarios{};  ///< Scenarios of the shard.
  double num_beyond{};            ///< Sum of the shares of scenarios under way.

  /// Share of the shard, in [0, 1].
  [[nodiscard]] double done() const { return (num_done + num_beyond) / num_scenarios; }
};

/// Callbacks of a run.
struct DatasetHooks {
  /// Called before every scenario and after every frame, by one thread at a time.
  std::function<void(const DatasetProgress& progress)> on_progress;
  std::function<bool()> is_stopped;  ///< Called by several threads at once.
};

struct DatasetResult {
  std::uint32_t num_resumed{};    ///< Scenarios made by an earlier run.
  std::uint32_t num_done{};       ///< Scenarios of the shard that are done.
  std::uint32_t num_scenarios{};  ///< Scenarios of the shard.
  std::uint64_t num_frames{};     ///< Made by this run.
  /// Scenarios of each part, of a whole data set that this run completed.
  std::optional<PerPart<std::uint32_t>> parts;
  bool was_complete{};
  /// What was not as it was written in a complete data set and was made anew, a line each.
  std::vector<std::string> changed;
  bool is_complete{};  ///< All scenarios are done and, of a whole data set, the files about them.
  double elapsed_s{};
};

/// Makes the scenarios of a shard that its folder does not hold yet, one on each thread; of a whole
/// data set then the files about all of them (WriteDatasetFiles).
/// @throws InputError as DatasetDirectory and ScenarioDrawer do.
[[nodiscard]] DatasetResult RunDataset(const Recipe& recipe,
                                       const DatasetChoices& choices,
                                       const DatasetHooks& hooks);

/// Makes one data set of all its shards: the same bytes as one run without shards. Files are linked
/// where the file system can, so that they take no further space, and copied elsewhere. An
/// interrupted merge is continued by the same call.
/// @param on_progress Called with the number of scenarios done.
/// @return Number of scenarios.
/// @throws InputError with a line for each shard that is missing, unfinished, changed or of another
///   data set, and for each file of a scenario that is not as its shard's run wrote it; the
///   scenarios before that are merged.
std::uint32_t MergeShards(
    const std::vector<std::filesystem::path>& shards,
    const std::filesystem::path& out,
    const std::function<void(std::uint32_t num_done, std::uint32_t num_scenarios)>& on_progress);

}  // namespace railcast
