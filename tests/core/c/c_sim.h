#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include "railcast/c_api.h"
#include "railcast/frame.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {

struct DestroySim {
  void operator()(railcast_sim* sim) const { railcast_destroy(sim); }
};
using Sim = std::unique_ptr<railcast_sim, DestroySim>;

/// A text as the content of a file among the shipped scenarios.
struct ScenarioText {
  std::string text;
  std::string file;

  /// The content of a shipped scenario.
  static ScenarioText Of(const std::string& name) {
    const std::filesystem::path file = ScenariosDir() / name;
    return {TextOf(file), file.string()};
  }
  void Replace(const std::string& part, const std::string& by) {
    const std::size_t place = text.find(part);
    ASSERT_NE(place, std::string::npos) << part;
    text.replace(place, part.size(), by);
  }
  /// minimal.json with another raster.
  [[nodiscard]] ScenarioText WithRaster(double horizontal_fov_deg,
                                        double vertical_fov_deg,
                                        double angular_resolution_deg) const {
    std::ostringstream lidar;
    lidar << R"({"file": "sensors/vir2rail.json", "scan": {"rate_hz": 10, "pattern": {)"
          << R"("type": "raster", "horizontal_fov_deg": )" << horizontal_fov_deg
          << R"(, "vertical_fov_deg": )" << vertical_fov_deg << R"(, "angular_resolution_deg": )"
          << angular_resolution_deg << "}}}";
    ScenarioText changed = *this;
    changed.Replace(R"("sensors/vir2rail.json")", lidar.str());
    return changed;
  }
  [[nodiscard]] railcast_config Config(int num_threads = 2) const {
    railcast_config config{};
    config.json_text = text.c_str();
    config.file = file.c_str();
    config.num_threads = num_threads;
    return config;
  }
};

/// Returns the simulation, and null with a failure of the test if there is none.
[[nodiscard]] inline Sim CreateSim(const railcast_config& config) {
  railcast_sim* sim = nullptr;
  EXPECT_EQ(railcast_create(&config, &sim), RAILCAST_OK) << railcast_last_error();
  return Sim(sim);
}

/// Every bit of every field, as FrameBytes() has it.
[[nodiscard]] inline std::string SimBytes(const railcast_sim* sim) {
  std::string bytes;
  const Frame table;
  ForEachField(table, [&](std::string_view name, std::string_view, const auto& values) {
    railcast_field field{};
    EXPECT_EQ(railcast_get_field(sim, std::string(name).c_str(), &field), RAILCAST_OK)
        << railcast_last_error();
    bytes.append(static_cast<const char*>(field.values), field.num_values * sizeof(values[0]));
  });
  return bytes;
}

}  // namespace railcast
