#include "core/scenario/describe_scenario.h"
#include "core/scenario/json_writer.h"
#include "core/scenario/scenario.h"

namespace railcast {

std::string ResolvedScenarioJson(const ScenarioSpec& spec) {
  ScenarioSpec copy = spec;  // Descriptions are shared with the reader, which fills what they name.
  Json json = {{"version", 1}};
  json.update(JsonWriter::Write(copy));
  return json.dump(2) + '\n';
}

}  // namespace railcast
