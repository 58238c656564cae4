#include "generator/import/structures/map_account.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/import/map/map_projection.h"
#include "generator/import/map/read_map.h"
#include "generator/import/structures/standing_world.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/import/made_map.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;

/// All of it is in worlds or left out, for a reason.
void ExpectWhole(const AccountRow& row) {
  EXPECT_NEAR(row.in_worlds + row.out(), row.on_map, 1e-6) << row.what << " " << row.place;
  EXPECT_EQ(row.left_out.count(kNoReason), 0U) << row.what << " " << row.place;
}

TEST(MapAccount, BooksEachMetreOfATrackAndItsTunnelOnce) {
  MadeMap map;
  map.AddTrack(0.0, {{"tunnel", "yes"}});
  map.AddTrack(4.5, {{"tunnel", "yes"}});
  map.AddWay({{300.0, 200.0}, {500.0, 200.0}}, {});
  map.Make();
  for (const AccountRow& row : map.Account()) ExpectWhole(row);
  EXPECT_DOUBLE_EQ(map.Sum("running track").on_map, 2000.0 + 1800.0 + 200.0);
  EXPECT_NEAR(map.Sum("running track").in_worlds, 3800.0, 1e-6);
  EXPECT_THAT(map.Sum("running track").left_out, ElementsAre(Pair(kNearNoLine, 200.0)));
  EXPECT_NEAR(map.Sum("tunnel").in_worlds, 800.0, 2.0);
}

TEST(MapAccount, SaysWhyATrackBesideALineIsNotMade) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddWay({{300.0, 20.0}, {310.0, 20.0}}, {});
  map.AddWay({{500.0, 20.0}, {510.0, 40.0}}, {});
  map.AddWay({{700.0, 50.0}, {720.0, 80.0}}, {});
  map.Make();
  EXPECT_THAT(
      map.Sum("running track").left_out,
      ElementsAre(Pair("it does not run along the line", ::testing::DoubleNear(22.36, 0.01)),
                  Pair("it leaves the 60 m beside the line", ::testing::DoubleNear(36.06, 0.01)),
                  Pair("it runs along the line for less than 20 m", 10.0)));
}

TEST(MapAccount, CountsWhatATrackThatCannotStandTakesWithIt) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(4.5, {});
  map.Make();
  map.world().tracks[1].draft.spec.offset_m = 2.0;
  ASSERT_EQ(MakeStand(map.line().alignment, std::nullopt, map.world()), std::nullopt);
  EXPECT_NEAR(map.Sum("running track").in_worlds, 2000.0, 1e-6);
  EXPECT_NEAR(map.Sum("running track").out(), 1800.0, 1e-6);
}

TEST(MapAccount, HasThePlatformEdgesThatTracksOfTheMapPass) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(10.0, {});
  map.AddPlatformArea(900.0, 1100.0, 2.2, 7.6);
  map.AddPlatformArea(300.0, 400.0, -9.0, -6.0);
  map.Make();
  const AccountRow platforms = map.Sum("platform");
  EXPECT_NEAR(platforms.on_map, 400.0, 1e-6) << "two edges, and none 6 m from a track";
  EXPECT_NEAR(platforms.in_worlds, 400.0, 1.0);
}

TEST(MapAccount, CountsCrossingsSignalsAndBufferStops) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(4.5, {});
  map.AddThing({{1900.0, 4.5}}, {{"railway", "buffer_stop"}});
  map.AddThing({{500.0, 0.0}}, {{"railway", "level_crossing"}});
  map.AddThing({{501.0, 4.5}}, {{"railway", "crossing"}});
  map.AddThing({{600.0, 9.0}}, {{"railway", "crossing"}});
  map.AddThing({{800.0, 4.5}}, {{"railway", "signal"}, {"railway:signal:main", "DE-ESO:ks"}});
  map.AddThing({{700.0, 0.0}}, {{"railway", "signal"}});
  map.AddThing({{1500.0, 0.0}}, {{"railway", "buffer_stop"}});
  map.Make();
  for (const AccountRow& row : map.Account()) ExpectWhole(row);
  EXPECT_EQ(map.Sum("level_crossing").on_map, 3.0);
  EXPECT_EQ(map.Sum("level_crossing").in_worlds, 2.0) << "on one road";
  EXPECT_THAT(map.All<LevelCrossingSpec>(), ::testing::SizeIs(1));
  ASSERT_THAT(map.All<SignalSpec>(), ::testing::SizeIs(1));
  EXPECT_EQ(map.All<SignalSpec>()[0].track, "running_1");
  // The way is drawn to the east.
  EXPECT_EQ(map.All<SignalSpec>()[0].direction,
            map.runs_east() ? RunningDirection::kRising : RunningDirection::kFalling);
  EXPECT_THAT(map.Sum("signal").left_out,
              ElementsAre(Pair("the map does not say which kind it is", 1.0)));
  EXPECT_THAT(map.Sum("buffer_stop").left_out,
              ElementsAre(Pair("its track goes on behind it", 1.0)));
  map.world().structures.clear();
  EXPECT_THAT(map.Sum("level_crossing").left_out, ::testing::SizeIs(2));
}

/// A map of the shared data, and what of it is imported in seconds.
struct SharedMap {
  const char* file;
  const char* options;
};

class AccountOfSharedMap : public ::testing::TestWithParam<SharedMap> {};

std::vector<std::string> RowFields(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

TEST_P(AccountOfSharedMap, IsWhole) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const TemporaryDirectory directory;
  const std::filesystem::path out = directory.path() / "out";
  const Ended run =
      Generate("import " + file.string() + " " + GetParam().options + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  std::istringstream account(ReadFileWhole(out / "account.csv"));
  std::string line;
  std::getline(account, line);
  ASSERT_EQ(line, "what,place,unit,on_map,in_worlds,left_out,reasons");
  double tracks_m = 0.0;
  while (std::getline(account, line)) {
    EXPECT_THAT(line, Not(HasSubstr(kNoReason)));
    const std::vector<std::string> fields = RowFields(line);
    ASSERT_GE(fields.size(), 6U) << line;
    const double on_map = std::stod(fields[3]);
    EXPECT_NEAR(std::stod(fields[4]) + std::stod(fields[5]), on_map, 0.02) << line;
    if (fields[0].ends_with("track")) tracks_m += on_map;
  }
  if (std::string(GetParam().options).find("--within") != std::string::npos) return;
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  double ways_m = 0.0;
  for (const MapWay& way : map.ways) ways_m += LengthOf_m(map, way);
  EXPECT_NEAR(tracks_m, ways_m, 0.005 * static_cast<double>(map.ways.size()));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    AccountOfSharedMap,
    ::testing::Values(SharedMap{"osm_sankt_poelten/sankt_poelten.json",
                                "--min-length 500 --within 15.61,48.20,15.64,48.212"},
                      SharedMap{"osm_more/da_hbf_2.osm.pbf", "--min-length 200"},
                      SharedMap{"osm_more/harrisburg.osm.pbf",
                                "--within=-76.8310,40.2155,-76.8095,40.2275"},
                      SharedMap{"osm_more/karlsruhe-kirchfeld.osm.pbf", ""},
                      SharedMap{"osm_more/liechtenstein.osm.pbf", ""},
                      SharedMap{"osm_more/monaco.osm.pbf", ""}),
    [](const auto& of) {
      std::string name = std::filesystem::path(of.param.file).stem().stem();
      std::erase_if(name, [](char letter) { return letter == '-' || letter == '_'; });
      return name;
    });

}  // namespace
}  // namespace railcast
