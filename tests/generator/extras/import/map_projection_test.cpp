#include "generator/extras/import/map/map_projection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "core/rail/line/map_place.h"
#include "generator/extras/import/map/read_map.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

/// Nodes 0.05 degrees from each other, over some 70 km to the north and the east.
RailMap MapAbout(const Eigen::Vector2d& middle_deg) {
  constexpr int kNum = 6;
  constexpr double kSpacing_deg = 0.05;
  RailMap map;
  for (int i = -kNum; i <= kNum; ++i) {
    for (int j = -kNum; j <= kNum; ++j) {
      map.nodes.push_back(
          {.geographic_deg = middle_deg + kSpacing_deg * Eigen::Vector2d(i, j), .tags = {}});
    }
  }
  return map;
}

/// The greatest distance between where PROJ and where a scenario places the map's nodes.
double LargestDifference_m(const MapProjection& projection, const RailMap& map) {
  const MapSpec spec = MapSpecOf(projection);
  double largest_m = 0.0;
  for (const MapNode& node : map.nodes) {
    const Eigen::Vector2d& there_deg = node.geographic_deg;
    const Eigen::Vector2d found_m = WorldFromGeographic(spec, there_deg.x(), there_deg.y());
    largest_m = std::max(largest_m, (found_m - node.place_m).norm());
  }
  return largest_m;
}

TEST(MapProjection, OfAWorldIsThatOfProj) {
  RailMap map = MapAbout({15.63, 48.21});
  const MapProjection projection = ProjectMap("", map);
  EXPECT_TRUE(projection.coefficients_m.empty());
  EXPECT_LT(LargestDifference_m(projection, map), 2e-6);
}

struct GivenSystem {
  const char* definition;
  Eigen::Vector2d middle_deg;
  double tolerance_m = 1e-3;
};

TEST(MapProjection, OfAWorldFollowsGivenSystemsOfAllKinds) {
  // Transverse Mercators on other ellipsoids and far from their meridians, Lambert's conical one,
  // oblique and double ones, and one that is not conformal, for which PROJ has a grid of
  // corrections with steps of some centimetres.
  for (const GivenSystem& system : std::vector<GivenSystem>{{"EPSG:32633", {17.9, 48.0}},
                                                            {"EPSG:31256", {15.63, 48.21}},
                                                            {"EPSG:25832", {6.2, 51.0}},
                                                            {"EPSG:27700", {-1.5, 53.5}},
                                                            {"EPSG:2154", {-1.7, 48.1}},
                                                            {"EPSG:2056", {8.9, 47.4}},
                                                            {"EPSG:5514", {14.4, 50.1}},
                                                            {"EPSG:28992", {5.1, 52.1}},
                                                            {"EPSG:3068", {13.4, 52.5}, 0.1}}) {
    RailMap map = MapAbout(system.middle_deg);
    const MapProjection projection = ProjectMap(system.definition, map);
    EXPECT_EQ(projection.coefficients_m.size(), 21U);
    EXPECT_LT(LargestDifference_m(projection, map), system.tolerance_m) << system.definition;
    EXPECT_EQ(projection.geographic_error_m, LargestDifference_m(projection, map));
  }
}

TEST(MapProjection, OfARealMapIsThatOfProj) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "osm_sankt_poelten/sankt_poelten.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  for (const char* definition : {"", "EPSG:31256"}) {
    const MapProjection projection = ProjectMap(definition, map);
    EXPECT_LT(LargestDifference_m(projection, map), 1e-3) << definition;
  }
}

TEST(MapProjection, RefusesASystemThatIsNotSmooth) {
  // Goode's homolosine projection is torn along some meridians, such as that of 40 degrees west.
  RailMap map = MapAbout({-39.9, 2.0});
  EXPECT_THAT(
      MessageOf([&] { static_cast<void>(ProjectMap("+proj=igh +ellps=WGS84 +type=crs", map)); }),
      testing::MatchesRegex("--crs: must be smooth over the map, a polynomial of the "
                            "fifth order to 1 m \\(got \\+proj=igh .* with [0-9.e+]+ m\\)"));
}

}  // namespace
}  // namespace railcast
