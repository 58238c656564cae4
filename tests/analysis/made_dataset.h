#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/core/scenario/scenario_files.h"
#include "tests/support/run_command.h"

namespace railcast {

/// Makes a data set of three scenarios of two frames with railcast-generate.
inline std::filesystem::path MakeSmallDataset(const TemporaryFolder& folder,
                                              const std::string& options) {
  const auto recipe = folder.Write(
      "recipe.json", R"({"version": 1, "num_scenarios": 3, "num_frames": 2, "bases": [{"file": ")" +
                         (ScenariosDir() / "minimal.json").string() +
                         R"("}], "set": {"/lidar/scan/pattern/angular_resolution_deg": 1.0,
                           "/world/vegetation/trees_per_hectare": 0,
                           "/world/vegetation/grass": false}})");
  const auto out = recipe.parent_path() / "set";
  const Ended run = RunCommand(RAILCAST_GENERATE " dataset " + recipe.string() + " --out " +
                               out.string() + " " + options);
  if (run.status != 0) throw std::runtime_error(run.said);
  return out;
}

}  // namespace railcast
