#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "generator/extras/dataset/run_dataset.h"
#include "tests/core/extras/recipe/recipe_project.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// ProjectRecipe() with two sensors that take turns: `front` of 10 Hz and `roof` of 20 Hz.
inline nlohmann::json RecipeOfTwoSensors() {
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 3;
  recipe["num_frames"] = 2;
  recipe["set"].erase("/lidar/range_max_m");
  nlohmann::json sensor = nlohmann::json::parse(R"({
    "name": "front", "range_max_m": 60,
    "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 20,
             "vertical_fov_deg": 10, "angular_resolution_deg": 1}}
  })");
  recipe["set"]["/lidars"] = {sensor};
  sensor["name"] = "roof";
  sensor["scan"]["rate_hz"] = 20;
  sensor["phase_s"] = 0.03;
  sensor["mount"] = {{"position_m", {0, 0, 4}}};
  recipe["set"]["/lidars"].push_back(sensor);
  return recipe;
}

/// Names and contents of all files of a data set.
inline std::map<std::string, std::string> FilesOfDataset(const std::filesystem::path& directory) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    if (entry.is_directory()) continue;
    files[entry.path().lexically_relative(directory)] = ReadFileWhole(entry.path());
  }
  return files;
}

inline DatasetHooks NoDatasetHooks() {
  return {[](const DatasetProgress&) {}, [] { return false; }};
}

/// A data set, or a shard of one, made on one thread.
inline DatasetChoices OnOneThread(const std::filesystem::path& directory, const Shard& shard = {}) {
  DatasetChoices choices;
  choices.directory = directory;
  choices.num_threads = 1;
  choices.shard = shard;
  return choices;
}

/// Makes a data set in a new folder; a program makes it once for each text of a recipe, and copies
/// it from then on.
inline DatasetResult MakeOnce(const Recipe& recipe, const DatasetChoices& choices) {
  static const TemporaryDirectory folder;
  static std::map<std::string, DatasetResult> results;
  const std::string name =
      ContentHash(ReadFileWhole(recipe.file) + choices.format + " " +
                  std::to_string(choices.shard.number) + "/" + std::to_string(choices.shard.of));
  const std::filesystem::path made = folder.path() / name;
  if (!results.contains(name)) {
    DatasetChoices there = choices;
    there.directory = made;
    results[name] = RunDataset(recipe, there, NoDatasetHooks());
  }
  std::filesystem::copy(made, choices.directory, std::filesystem::copy_options::recursive);
  return results[name];
}

/// Makes such a data set.
inline DatasetResult MakeDataset(const Recipe& recipe,
                                 const std::filesystem::path& directory,
                                 const Shard& shard = {}) {
  return RunDataset(recipe, OnOneThread(directory, shard), NoDatasetHooks());
}

}  // namespace railcast
