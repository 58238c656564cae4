#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// Reads the scan of scenarios/sensors/NAME.json as the scenario reader does, but for a raster.
[[nodiscard]] inline ScanSpec ReadSensor(const std::string& name) {
  const std::string folder = RAILCAST_SOURCE_DIR "/scenarios/sensors/";
  std::ifstream file(folder + name + ".json");
  const nlohmann::json scan = nlohmann::json::parse(file).at("scan");
  const nlohmann::json& pattern = scan.at("pattern");
  if (pattern.at("type") == "table") {
    return {.rate_hz = scan.at("rate_hz"),
            .pattern = FiringTableSpec{folder + pattern.at("file").get<std::string>(),
                                       pattern.value("frames", 1U)}};
  }
  std::vector<ChannelSpec> channels;
  for (const nlohmann::json& channel : pattern.at("channels")) {
    channels.push_back({.elevation_deg = channel.at("elevation_deg"),
                        .azimuth_deg = channel.at("azimuth_deg"),
                        .time_us = channel.at("time_us")});
  }
  if (pattern.at("type") == "risley") {
    RisleySpec risley{.channels = channels,
                      .cycle_us = pattern.at("cycle_us"),
                      .columns = pattern.at("columns"),
                      .prisms = {}};
    for (const nlohmann::json& prism : pattern.at("prisms")) {
      risley.prisms.push_back({.wedge_deg = prism.at("wedge_deg"),
                               .refractive_index = prism.at("refractive_index"),
                               .turns_hz = prism.at("turns_hz")});
    }
    return {.rate_hz = scan.at("rate_hz"), .pattern = risley};
  }
  const SpinningSpec spinning{
      .channels = channels,
      .cycle_us = pattern.at("cycle_us"),
      .columns = pattern.at("columns"),
      .rotation = ValueNamed<Rotation>(pattern.at("rotation").get<std::string>()).value(),
      .start_azimuth_deg = pattern.at("start_azimuth_deg")};
  return {.rate_hz = scan.at("rate_hz"), .pattern = spinning};
}

}  // namespace railcast
