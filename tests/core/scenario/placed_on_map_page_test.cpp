#include <gtest/gtest.h>

#include <string>

#include "core/base/units.h"
#include "core/rail/line/line_place.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

/// The JSON that follows a line of docs/scenario.md.
std::string ExampleAfter(const std::string& line) {
  const std::string page = TextOf(std::filesystem::path(RAILCAST_SOURCE_DIR) / "docs/scenario.md");
  const std::string fence = line + "\n```json\n";
  const std::size_t begin = page.find(fence);
  if (begin == std::string::npos) return {};
  const std::size_t end = page.find("```", begin + fence.size());
  return page.substr(begin + fence.size(), end - begin - fence.size());
}

TEST(ScenarioPage, PlacesItsObjectsOnTheMapOfSanktPoelten) {
  const std::string scenario =
      R"({"version": 1, "file": "line.json", "world": {"file": "westbahn-130-01.world.json",)" +
      ExampleAfter("<!-- example: on the map of osm_sankt_poelten/line.json -->") + "}}";
  const auto world = MakeWorld(
      ReadScenarioText(scenario, ScenariosDir() / "osm_sankt_poelten" / "with_objects.json"));
  const auto beside = [&](std::size_t object, std::int64_t time_ns) {
    return PlaceOnLine(world->alignment(), world->WorldFromObject(object, time_ns).translation(),
                       500.0);
  };
  // 1e-7 degrees are 1.1 cm of latitude.
  EXPECT_NEAR(beside(0, 0).s_m, 500.0, 0.01);
  EXPECT_NEAR(beside(0, 0).d_m, -6.0, 0.01);
  EXPECT_NEAR(beside(0, 600 * kNsPerS).d_m, 6.0, 0.01);
  EXPECT_NEAR(beside(1, 0).s_m, 650.0, 0.1);
  EXPECT_NEAR(beside(1, 0).d_m, 0.0, 1e-3);
}

}  // namespace
}  // namespace railcast
