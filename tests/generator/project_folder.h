#pragma once

#include <filesystem>
#include <string>

#include "core/io/write_file.h"

namespace railcast {

inline const std::string kScenariosFolder = std::string(RAILCAST_SOURCE_DIR) + "/scenarios/";

/// A pyramid 2 m high, for a scenario's mesh file.
inline constexpr const char* kPyramidObj =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 2\n"
    "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

/// Makes a user's project in a folder: scenario.json on a straight line of 1 km, with the mesh
/// rock.obj and the firing table beams.csv beside it, and without plants, which take long to build.
/// @return The path of the scenario.
inline std::filesystem::path MakeProject(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  WriteFileWhole(folder / "rock.obj", kPyramidObj);
  WriteFileWhole(folder / "beams.csv",
                 "azimuth_deg,elevation_deg,time_us\n0,-3,0\n0,-2,10\n1,-2,20\n-1,-2,30\n");
  WriteFileWhole(folder / "scenario.json", R"({
    "version": 1,
    "lidar": {"name": "beams", "range_max_m": 200,
              "scan": {"rate_hz": 10, "pattern": {"type": "table", "file": "beams.csv"}}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [{"name": "rock", "type": "mesh", "file": "rock.obj", "s_m": 450, "d_m": 2}]
    },
    "vehicle": {"start_s_m": 400},
    "materials": ")" + kScenariosFolder + R"(materials/railway.json",
    "labels": ")" + kScenariosFolder + R"(labels.json"
  })");
  return folder / "scenario.json";
}

}  // namespace railcast
