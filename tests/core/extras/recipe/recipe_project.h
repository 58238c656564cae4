#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/extras/recipe/recipe.h"
#include "core/io/write_file.h"
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

}  // namespace railcast
