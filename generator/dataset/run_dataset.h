#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "generator/dataset/dataset_directory.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/scenario_draw.h"

namespace railcast {

/// How a recipe's frames are made.
struct DatasetChoices {
  std::filesystem::path directory;
  std::string format = "pcd";
  std::string fields = "all";
  bool is_merged = false;  ///< Whether the clouds of several sensors are merged, too.
  std::string isa;         ///< Of the trace; empty = the machine's best.
  int num_threads = 0;     ///< 0 = all cores.
  Shard shard;
};

/// Callbacks of a run.
struct DatasetHooks {
  /// Called after every frame.
  /// @param scenario How many of the shard's scenarios are done.
  std::function<void(std::uint32_t num_done, std::uint32_t num_scenarios)> on_progress;
  std::function<bool()> is_stopped;
};

struct DatasetResult {
  std::uint32_t num_resumed{};    ///< Scenarios made by an earlier run.
  std::uint32_t num_done{};       ///< Of the shard's scenarios.
  std::uint32_t num_scenarios{};  ///< Of the shard.
  std::uint64_t num_frames{};     ///< Made by this run.
  bool was_complete{};
  bool is_complete{};  ///< All scenarios are done and, of a whole data set, the files about them.
  double elapsed_s{};
};

/// Makes the scenarios of a shard that its folder does not hold yet; of a whole data set then the
/// files about all of them (WriteDatasetFiles).
/// @throws InputError as DatasetDirectory and ScenarioDrawer do.
[[nodiscard]] DatasetResult RunDataset(const Recipe& recipe,
                                       const DatasetChoices& choices,
                                       const DatasetHooks& hooks);

}  // namespace railcast
