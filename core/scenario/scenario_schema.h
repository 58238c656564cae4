#pragma once

#include <map>
#include <string>

namespace railcast {

/// The JSON Schemas (draft 2020-12) of a scenario and of the files that it may name, by file name
/// ("lidar.schema.json"), as `scenarios/schema/` publishes them for editors. They state the keys,
/// types, limits and defaults; rules across keys are `check`'s.
[[nodiscard]] std::map<std::string, std::string> ScenarioSchemas();

}  // namespace railcast
