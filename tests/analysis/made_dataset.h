#pragma once

#include <filesystem>
#include <string>

#include "tests/analysis/analyze_program.h"

namespace railcast {

/// Makes a data set of three scenarios of two frames with railcast-generate.
inline std::filesystem::path MakeSmallDataset(const TemporaryFolder& folder,
                                              const std::string& options) {
  static const TemporaryFolder kept;
  const auto recipe = kept.Write(
      "recipe.json", R"({"version": 1, "num_scenarios": 3, "num_frames": 2, "bases": [{"file": ")" +
                         (ScenariosDir() / "minimal.json").string() +
                         R"("}], "set": {"/lidar/scan/pattern/angular_resolution_deg": 1.0,
                           "/world/vegetation/trees_per_hectare": 0,
                           "/world/vegetation/grass": false}})");
  const auto out = folder.Write("recipe.json", "").parent_path() / "set";
  GenerateOnce("dataset " + recipe.string() + " " + options, out);
  return out;
}

}  // namespace railcast
