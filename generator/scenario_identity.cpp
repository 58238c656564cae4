#include "generator/scenario_identity.h"

#include <filesystem>
#include <map>
#include <utility>
#include <variant>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "core/scenario/scenario.h"

namespace railcast {

ScenarioIdentity IdentityOf(const ScenarioSpec& scenario) {
  ScenarioIdentity identity;
  std::map<std::string, std::string> content_of;  // By the name in the scenario.
  const auto replace_by_content = [&](std::string& file) {
    auto known = content_of.find(file);
    if (known == content_of.end()) {
      InputFile input{std::filesystem::path(file).filename().string(),
                      ContentHash(ReadFileWhole(file))};
      known = content_of.emplace(file, input.name + " " + input.hash).first;
      identity.inputs.push_back(std::move(input));
    }
    file = known->second;
  };

  ScenarioSpec anywhere = scenario;
  const auto replace_table = [&](LidarSpec& lidar) {
    if (auto* table = std::get_if<FiringTableSpec>(&lidar.scan.pattern)) {
      replace_by_content(table->file);
    }
  };
  replace_table(anywhere.lidar);
  for (LidarSpec& lidar : anywhere.lidars) replace_table(lidar);
  for (ObjectSpec& object : anywhere.world.objects) {
    if (object.file) replace_by_content(*object.file);
  }
  identity.scenario_hash = ContentHash(ResolvedScenarioJson(anywhere));
  return identity;
}

}  // namespace railcast
