#include "core/scenario/describe_scenario.h"
#include "core/scenario/json_writer.h"
#include "railcast/scenario.h"

namespace railcast {

std::string ResolvedScenarioJson(const ScenarioSpec& spec) {
  ScenarioSpec copy = spec;  // Descriptions take mutable values because the reader fills them.
  Json json = {{"version", 1}};
  json.update(JsonWriter::Write(copy));
  return json.dump(2) + '\n';
}

}  // namespace railcast
