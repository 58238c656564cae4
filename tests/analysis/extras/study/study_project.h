#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/extras/study/run_study.h"
#include "core/io/write_file.h"

namespace railcast {

/// A vehicle at 20 m/s on a bare line, before which a person is placed.
inline nlohmann::json StudiedRecipe(std::uint32_t num_scenarios) {
  nlohmann::json recipe = nlohmann::json::parse(R"({
    "version": 1,
    "seed": 5,
    "num_frames": 60,
    "bases": [{"file": "base.json"}],
    "groups": [
      {
        "name": "weather",
        "options": [
          {"name": "clear", "set": {"/weather": {}}},
          {"name": "fog", "set": {"/weather": {"visibility_m": 60}}}
        ]
      }
    ],
    "objects": [
      {
        "name": "person",
        "count": {"type": "choice", "values": [1]},
        "object": {"type": "person"},
        "draws": {
          "/d_m": {"type": "uniform", "min": -1, "max": 1},
          "/person/physique": {"type": "choice", "values": ["man", "child"]}
        },
        "ahead_m": {"type": "uniform", "min": 100, "max": 115},
        "gauge": "foul"
      },
      {
        "name": "worker",
        "count": {"type": "choice", "values": [0, 1]},
        "object": {"type": "person", "d_m": -5},
        "ahead_m": {"type": "uniform", "min": 60, "max": 80}
      }
    ]
  })");
  recipe["num_scenarios"] = num_scenarios;
  return recipe;
}

/// Writes a study, its recipe and its base to a folder.
/// @return The study's file.
inline std::filesystem::path WriteStudy(const std::filesystem::path& folder,
                                        const nlohmann::json& recipe) {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  WriteFileWhole(folder / "base.json", R"({
    "version": 1,
    "fidelity": "surface",
    "lidar": {"file": ")" + scenarios + R"(sensors/vir2rail.json",
              "range_max_m": 120, "mount": {"position_m": [2.2, 0, 2.5]}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "vegetation": {"trees_per_hectare": 0, "grass": false}
    },
    "vehicle": {"start_s_m": 300, "may_overlap": true,
                "motion": {"profile": [{"time_s": 0, "speed_mps": 20}]}},
    "materials": ")" + scenarios + R"(materials/railway.json",
    "labels": ")" + scenarios + R"(labels.json"
  })");
  WriteFileWhole(folder / "recipe.json", recipe.dump());
  WriteFileWhole(folder / "study.json",
                 R"({"version": 1, "question": "Seen?", "recipe": "recipe.json",
                     "detection": {"points": 4, "frames": 2, "of_frames": 3}})");
  return folder / "study.json";
}

inline StudyHooks NoStudyHooks() {
  return {[](std::uint32_t, std::uint32_t) {}, [] { return false; }};
}

/// Runs a study, or a shard of it.
inline StudyResult RunStudyIn(const std::filesystem::path& study_file, StudyChoices choices) {
  const StudySpec study = ReadStudy(study_file);
  const Recipe recipe = ReadStudyRecipe(study);
  return RunStudy(study, ScenarioDrawer(recipe), choices, NoStudyHooks());
}

}  // namespace railcast
