#pragma once

#include <string>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {

/// A straight line of 1 km, scanned by few beams from a vehicle at 10 m/s, which stays on the first
/// 460 m of it, so that few windows have to be built.
struct Line {
  bool has_wires = true;
  std::string mount = "{}";
  std::string more = "";  ///< Further keys of the scenario.
  std::string start_s_m = "400";
  std::string end_s_m = "460";
  std::string trees_per_hectare = "0";
  std::string objects = "[]";
  std::string speed_mps = "10";
  int world_seed = 1;
};

[[nodiscard]] inline ScenarioSpec ReadLine(const Line& line) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  return ReadScenario(folder.Write("scenario.json",
                                   R"({
    "version": 1,
    "fidelity": "auto",
    "lidar": {
      "range_max_m": 120,
      "mount": )" + line.mount + R"(,
      "beam": {"reference_rays": 64},
      "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 30,
               "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}
    },
    "world": {
      "seed": )" + std::to_string(line.world_seed) +
                                       R"(,
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "tracks": [{"name": "main", "end_s_m": )" +
                                       line.end_s_m + R"(}],
      "catenary": {"enabled": )" + (line.has_wires ? "true" : "false") +
                                       R"(},
      "terrain": {"roughness_sigma_m": 0.01},
      "vegetation": {"trees_per_hectare": )" +
                                       line.trees_per_hectare + R"(, "grass": false},
      "objects": )" + line.objects + R"(
    },
    "vehicle": {"start_s_m": )" + line.start_s_m +
                                       R"(, "motion": {"profile": [{"time_s": 0, "speed_mps": )" +
                                       line.speed_mps + R"(}]}},)" + line.more + R"(
    "materials": ")" + scenarios + R"(/materials/railway.json",
    "labels": ")" + scenarios + R"(/labels.json"})"));
}

}  // namespace railcast
