#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "railcast/lidar.h"

namespace railcast {

/// Reads the scan of scenarios/sensors/NAME.json as the scenario reader does.
[[nodiscard]] inline ScanSpec ReadSensor(const std::string& name) {
  std::ifstream file(std::string(RAILCAST_SOURCE_DIR "/scenarios/sensors/") + name + ".json");
  const nlohmann::json scan = nlohmann::json::parse(file).at("scan");
  const nlohmann::json& pattern = scan.at("pattern");
  SpinningSpec spec{
      .channels = {},
      .cycle_us = pattern.at("cycle_us"),
      .columns = pattern.at("columns"),
      .rotation = ValueNamed<Rotation>(pattern.at("rotation").get<std::string>()).value(),
      .start_azimuth_deg = pattern.at("start_azimuth_deg")};
  for (const nlohmann::json& channel : pattern.at("channels")) {
    spec.channels.push_back({.elevation_deg = channel.at("elevation_deg"),
                             .azimuth_deg = channel.at("azimuth_deg"),
                             .time_us = channel.at("time_us")});
  }
  return {.rate_hz = scan.at("rate_hz"), .pattern = spec};
}

}  // namespace railcast
