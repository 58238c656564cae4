#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/dataset/inserted_scenarios.h"
#include "generator/extras/dataset/run_dataset.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {

inline constexpr std::uint32_t kNumRecorded = 40;  ///< Frames of each recording.

/// Two sequences of a small raster that runs at 20 m/s, which recipes put things into.
class RecordingRecipe : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryDirectory;
    nlohmann::json recipe = ProjectRecipe();
    recipe["num_scenarios"] = 2;
    recipe["num_frames"] = kNumRecorded;
    recipe["draws"] = nlohmann::json::object();
    recipe["objects"] = nlohmann::json::array();
    recipe["set"]["/lidar/scan"] = {{"rate_hz", 10},
                                    {"pattern",
                                     {{"type", "raster"},
                                      {"horizontal_fov_deg", 20},
                                      {"vertical_fov_deg", 20},
                                      {"angular_resolution_deg", 1}}}};
    recipe["set"]["/vehicle/motion"] = {{"profile", {{{"time_s", 0}, {"speed_mps", 20}}}}};
    (void)MakeDataset(ReadProjectRecipe(Path("project"), recipe), Path("runs"));
    std::filesystem::rename(Path("runs/sequences/000/000000"), Path("one"));
    std::filesystem::rename(Path("runs/sequences/000/000001"), Path("two"));
    (void)WritePlan(folder_->path(), "{}", "");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  [[nodiscard]] static std::filesystem::path Path(const std::string& name) {
    return folder_->path() / name;
  }

  /// Puts a box before the vehicle in five frames of either recording.
  [[nodiscard]] static nlohmann::json Boxes() {
    return nlohmann::json::parse(R"({
      "version": 1, "seed": 3, "num_scenarios": 6, "num_frames": 5,
      "bases": [{"file": "plan.json", "recordings": ["one", "two"]}],
      "draws": {"/weather/rain_rate_mmph": {"type": "log_uniform", "min": 1, "max": 20}},
      "objects": [{"name": "box", "count": {"type": "choice", "values": [1]},
                   "object": {"type": "box", "size_m": [1, 1, 1], "h_m": 0},
                   "draws": {"/d_m": {"type": "uniform", "min": -1, "max": 1}},
                   "ahead_m": {"type": "uniform", "min": 15, "max": 30}}]
    })");
  }
  /// A plan with the sensor of the recordings, for their clouds alone.
  [[nodiscard]] static std::string StandingPlan() {
    nlohmann::json plan = nlohmann::json::parse(ReadFileWhole(Path("plan.json")));
    plan["world"]["recording"] = {{"poses", "standing"}};
    const auto scenario = ReadFileWhole(Path("one/scenario.resolved.json"));
    plan["lidar"] = nlohmann::json::parse(scenario).at("lidar");
    return plan.dump();
  }
  [[nodiscard]] static Recipe Read(const nlohmann::json& recipe) {
    WriteFileWhole(Path("recipe.json"), recipe.dump());
    return ReadRecipe(Path("recipe.json"), ReadRecordedBase);
  }
  [[nodiscard]] static std::string Fault(const nlohmann::json& recipe) {
    std::string message = MessageOf([&] { (void)Read(recipe); });
    const std::string folder = folder_->path().string() + "/";
    for (std::size_t at = 0; (at = message.find(folder)) != message.npos;) {
      message.erase(at, folder.size());
    }
    return message;
  }
  [[nodiscard]] static DatasetChoices Choices(const std::string& name, const Shard& shard = {}) {
    DatasetChoices choices = OnOneThread(Path(name), shard);
    choices.format = "same";
    return choices;
  }
  static DatasetResult Make(const Recipe& recipe,
                            const std::string& name,
                            const Shard& shard = {}) {
    std::filesystem::remove_all(Path(name));
    return RunDataset(recipe, Choices(name, shard), NoDatasetHooks());
  }
  [[nodiscard]] static std::vector<DrawnScenario> DrawAllOf(const Recipe& recipe) {
    const ScenarioDrawer drawer(recipe);
    std::vector<DrawnScenario> drawn;
    for (std::uint32_t i = 0; i < recipe.num_scenarios; ++i) drawn.push_back(drawer.Draw(i));
    return drawn;
  }

  inline static TemporaryDirectory* folder_ = nullptr;
};

}  // namespace railcast
