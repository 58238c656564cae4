#pragma once

#include <map>
#include <string>

namespace railcast {

/// The JSON Schemas (draft 2020-12) of a scenario and of the files that it may name, by file name
/// ("lidar.schema.json"), as published in `scenarios/schema/` for editors. They state keys, types,
/// limits and defaults; only `check` tests rules across keys.
[[nodiscard]] std::map<std::string, std::string> ScenarioSchemas();

}  // namespace railcast
