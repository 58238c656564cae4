#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/base/input_file.h"
#include "core/io/write_file.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/run_command.h"

namespace railcast {

/// Runs railcast-analyze at a fixed time (SOURCE_DATE_EPOCH), so that reports can be compared.
inline Ended Analyze(const std::string& arguments) {
  return RunCommand("SOURCE_DATE_EPOCH=1700000000 " RAILCAST_ANALYZE " " + arguments);
}

/// Makes what railcast-generate makes with these arguments, once for all tests that ask for it, and
/// copies it to `out`.
inline void GenerateOnce(const std::string& arguments, const std::filesystem::path& out) {
  static const TemporaryDirectory kept;
  static std::map<std::string, std::filesystem::path> made;
  if (!made.contains(arguments)) {
    const std::filesystem::path folder = kept.path() / std::to_string(made.size());
    const Ended run = RunCommand(RAILCAST_GENERATE " " + arguments + " --out " + folder.string());
    if (run.status != 0) throw std::runtime_error(run.said);
    made.emplace(arguments, folder);
  }
  std::filesystem::copy(made.at(arguments), out, std::filesystem::copy_options::recursive);
}

/// Writes a scenario of a straight line with few beams.
/// @param more Further keys, each followed by a comma.
inline std::filesystem::path WriteScenario(const TemporaryFolder& folder,
                                           const std::string& more = {},
                                           const std::string& resolution_deg = "0.5") {
  const std::string scenarios = ScenariosDir().string();
  return folder.Write("scenario.json", R"({
    "version": 1,)" + more + R"(
    "lidar": {"scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 20,
              "vertical_fov_deg": 40, "angular_resolution_deg": )" +
                                           resolution_deg + R"(}}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "vegetation": {"trees_per_hectare": 0, "grass": false}
    },
    "vehicle": {"start_s_m": 400},
    "materials": ")" + scenarios + R"(/materials/railway.json",
    "labels": ")" + scenarios + R"(/labels.json"})");
}

/// Gives a scenario its sensor twice, as "front" and "roof".
inline void DoubleSensor(const std::filesystem::path& scenario) {
  auto both = nlohmann::json::parse(ReadFileWhole(scenario));
  both["lidars"] = {both["lidar"], both["lidar"]};
  both["lidars"][0]["name"] = "front";
  both["lidars"][1]["name"] = "roof";
  both.erase("lidar");
  WriteFileWhole(scenario, both.dump());
}

}  // namespace railcast
