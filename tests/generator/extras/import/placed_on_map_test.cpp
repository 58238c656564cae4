#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kMapOfLine = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}}]})";

/// A person in the world that was imported into `out`.
std::shared_ptr<const RailWorld> WorldWithPerson(const fs::path& out, json place) {
  json person = {{"name", "person"}, {"type", "person"}};
  person.update(place);
  const json scenario = {
      {"version", 1},
      {"file", RAILCAST_SOURCE_DIR "/scenarios/minimal.json"},
      {"world",
       {{"file", (out / "hill-line.world.json").string()}, {"objects", json::array({person})}}}};
  return MakeWorld(ReadScenarioText(scenario.dump(), out / "scenario.json"));
}

Eigen::Vector2d PlaceInPlan_m(const RailWorld& world) {
  return world.WorldFromObject(0, 0).translation().head<2>();
}

TEST(PlacedOnMap, APersonStandsAtANodeOfTheMapInEveryWayOfPlacing) {
  // PROJ's metres, the polynomial of a given system, and the place beside the track.
  constexpr double kTolerance_m = 1e-3;
  for (const std::string& crs : {std::string(), std::string("EPSG:31256")}) {
    const TemporaryDirectory directory;
    const fs::path file = directory.path() / "map.geojson";
    const fs::path out = directory.path() / "out";
    WriteFileWhole(file, kMapOfLine);
    const Ended run = Generate("import " + file.string() + " --out " + out.string() +
                               (crs.empty() ? "" : " --crs " + crs));
    ASSERT_EQ(run.status, 0) << run.said;
    RailMap map = ReadMap(file);
    const MapProjection projection = ProjectMap(crs, map);
    for (const std::size_t node : {1U, 2U}) {
      const MapNode& there = map.nodes.at(node);
      const auto world = WorldWithPerson(out, {{"longitude_deg", there.geographic_deg.x()},
                                               {"latitude_deg", there.geographic_deg.y()}});
      EXPECT_LT((PlaceInPlan_m(*world) - there.place_m).norm(), kTolerance_m) << crs;

      const Eigen::Vector2d projected_m = there.place_m + projection.origin_m;
      const auto by_projection =
          WorldWithPerson(out, {{"x_m", projected_m.x()}, {"y_m", projected_m.y()}});
      EXPECT_LT((PlaceInPlan_m(*by_projection) - there.place_m).norm(), kTolerance_m) << crs;

      const double s_m = world->ObjectChainage_m(0, 0);
      const AxisPoint axis = world->alignment().At(s_m);
      const Eigen::Vector2d off_m = there.place_m - axis.position_m.head<2>();
      const double d_m =
          std::cos(axis.heading_rad) * off_m.y() - std::sin(axis.heading_rad) * off_m.x();
      // What the fit leaves of a map's points.
      EXPECT_LT(std::abs(d_m), 2.0);
      const auto beside = WorldWithPerson(out, {{"s_m", s_m}, {"d_m", d_m}});
      EXPECT_LT((PlaceInPlan_m(*beside) - PlaceInPlan_m(*world)).norm(), kTolerance_m) << crs;
    }
  }
}

}  // namespace
}  // namespace railcast
