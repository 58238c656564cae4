#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/run_dataset.h"
#include "tests/generator/project_folder.h"

namespace railcast {

/// A recipe on the project's scenario (MakeProject), with a person or two ahead, and without
/// plants, which take long to build. The tests change its keys.
inline nlohmann::json ProjectRecipe() {
  return nlohmann::json::parse(R"({
    "version": 1,
    "seed": 5,
    "num_scenarios": 6,
    "num_frames": 3,
    "bases": [{"file": "scenario.json"}],
    "set": {
      "/lidar/range_max_m": 60,
      "/world/vegetation/trees_per_hectare": 0,
      "/world/vegetation/grass": false
    },
    "draws": {
      "/weather/rain_rate_mmph": {"type": "log_uniform", "min": 0.5, "max": 50},
      "/weather/wetness": {"type": "uniform", "min": 0.1, "max": 0.9}
    },
    "start_s_m": {"type": "uniform", "min": 300, "max": 600},
    "objects": [
      {
        "name": "person",
        "count": {"type": "integer", "min": 1, "max": 2},
        "object": {"type": "person"},
        "draws": {"/d_m": {"type": "uniform", "min": -4, "max": 4}},
        "ahead_m": {"type": "uniform", "min": 5, "max": 40}
      }
    ]
  })");
}

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

/// Writes the project and the recipe to a folder.
/// @return The recipe's path.
inline std::filesystem::path WriteProjectRecipe(const std::filesystem::path& folder,
                                                const nlohmann::json& recipe) {
  (void)MakeProject(folder);
  WriteFileWhole(folder / "recipe.json", recipe.dump());
  return folder / "recipe.json";
}

/// Reads the recipe after writing it.
inline Recipe ReadProjectRecipe(const std::filesystem::path& folder, const nlohmann::json& recipe) {
  return ReadRecipe(WriteProjectRecipe(folder, recipe));
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

/// Makes such a data set.
inline DatasetResult MakeDataset(const Recipe& recipe,
                                 const std::filesystem::path& directory,
                                 const Shard& shard = {}) {
  return RunDataset(recipe, OnOneThread(directory, shard), NoDatasetHooks());
}

}  // namespace railcast
