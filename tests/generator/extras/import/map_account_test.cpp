#include "generator/extras/import/structures/map_account.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/structures/standing_world.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/import/made_map.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;

/// What is in worlds is what the world has, and all else is left out for a reason.
void ExpectWhole(MadeMap& map) {
  double tracks_m = 0.0;
  for (const AccountRow& row : map.Account()) {
    EXPECT_EQ(row.left_out.count(kNoReason), 0U) << row.what << " " << row.place;
    if (row.what.ends_with("track")) tracks_m += row.in_worlds;
  }
  for (const WorldTrack& track : map.world().tracks) {
    tracks_m -= track.draft.course.end_s_m() - track.draft.course.begin_s_m();
  }
  // A turnout begins up to 14 m before the point where tracks part on the map.
  const auto num_switches = static_cast<double>(map.world().switches.size());
  EXPECT_NEAR(tracks_m, 0.0, 1.0 + 14.0 * num_switches);
  EXPECT_EQ(map.Sum("switch").in_worlds, num_switches);
}

/// A siding of 600 m that leaves the track at y = 0 by 1:9.
void AddAccountedSiding(MadeMap& map) {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m < 40.5; x_m += 5.0) points_m.emplace_back(400.0 + x_m, x_m / 9.0);
  points_m.insert(points_m.end(), {{440.5, 4.5}, {700.0, 4.5}, {1000.0, 4.5}});
  map.AddWay(points_m, {{"service", "siding"}});
}

TEST(MapAccount, BooksEachMetreOfATrackAndItsTunnelOnce) {
  MadeMap map{{0.0, {{"tunnel", "yes"}}}, {4.5, {{"tunnel", "yes"}}}};
  map.AddWay({{300.0, 200.0}, {500.0, 200.0}}, {});
  map.Make();
  ExpectWhole(map);
  EXPECT_DOUBLE_EQ(map.Sum("running track").on_map, 2000.0 + 1800.0 + 200.0);
  EXPECT_NEAR(map.Sum("running track").in_worlds, 3800.0, 1e-6);
  EXPECT_THAT(map.Sum("running track").left_out, ElementsAre(Pair(kNearNoLine, 200.0)));
  EXPECT_NEAR(map.Sum("tunnel").in_worlds, 800.0, 2.0);
}

TEST(MapAccount, CountsTheSwitchesThatAreTurnouts) {
  MadeMap map{{0.0, {}}};
  AddAccountedSiding(map);
  map.AddWay({{1600.0, 0.0}, {1610.0, 2.0}}, {});
  map.Make();
  ExpectWhole(map);
  EXPECT_EQ(map.Sum("switch").on_map, 2.0);
  EXPECT_EQ(map.Sum("switch").in_worlds, 1.0);
}

TEST(MapAccount, HasTheReasonOfTheWorldThatCameNearest) {
  MadeMap map{{0.0, {}}};
  map.AddWay({{1600.0, 0.0}, {1610.0, 2.0}}, {});
  map.Make();
  LineWorld other = map.world();
  for (LeftOut& thing : other.left_out) {
    if (thing.what == "switch") thing.reason = kOnNoTrack;
  }
  for (const auto& worlds : {std::vector{map.world(), other}, std::vector{other, map.world()}}) {
    EXPECT_THAT(SumOf(map.AccountWith(worlds), "switch").left_out,
                ElementsAre(Pair("no track of 20 m leads from it along the line", 1.0)));
  }
}

// Where ways leave the end of a line by 39 and 45 degrees, so that it is not followed there.
TEST(MapAccount, KnowsTheSwitchesAtTheEndsOfALine) {
  MadeMap map{{0.0, {}}};
  map.AddWay({{2000.0, 0.0}, {2050.0, 40.0}}, {});
  map.AddWay({{2000.0, 0.0}, {2040.0, -40.0}}, {});
  map.AddWay({{0.0, 0.0}, {-50.0, 40.0}}, {});
  map.AddWay({{0.0, 0.0}, {-40.0, -40.0}}, {});
  map.Make();
  EXPECT_THAT(map.Sum("switch").left_out, ElementsAre(Pair(kAtLinesEnd, 2.0)));
  EXPECT_EQ(map.world().quality.num_switches, 2U);
  // Another line says more of them if it goes on there, and less if they are only beside it.
  for (const auto& [reason, counts] :
       {std::pair{kOnNoTrack, false}, std::pair{"no turnout fits", true}}) {
    LineWorld other = map.world();
    for (LeftOut& thing : other.left_out) {
      if (thing.what == "switch") thing.reason = reason;
    }
    for (const auto& worlds : {std::vector{map.world(), other}, std::vector{other, map.world()}}) {
      EXPECT_THAT(SumOf(map.AccountWith(worlds), "switch").left_out,
                  ElementsAre(Pair(counts ? reason : kAtLinesEnd, 2.0)));
    }
  }
}

// Two worlds have the platform's track: what one says of the platform itself is the reason,
// whatever their order, and "no track near" only where none does.
TEST(MapAccount, HasTheReasonOfTheWorldThatKnowsThePlatform) {
  MadeMap map{{0.0, {}}};
  map.AddPlatformArea(500.0, 600.0, -2.3, -2.0);
  map.Make();
  LineWorld silent = map.world();
  std::erase_if(silent.left_out, [](const LeftOut& thing) { return thing.what == "platform"; });
  const auto reasons = [&](const std::vector<LineWorld>& worlds) {
    return SumOf(map.AccountWith(worlds), "platform").left_out;
  };
  const auto length_m = ::testing::DoubleNear(100.0, 1e-6);
  const std::string no_room = "there is no room for it beside track main";
  EXPECT_THAT(reasons({silent, map.world()}), ElementsAre(Pair(no_room, length_m)));
  EXPECT_THAT(reasons({map.world(), silent}), ElementsAre(Pair(no_room, length_m)));
  EXPECT_THAT(reasons({silent, silent}),
              ElementsAre(Pair("no track of the world is 0.3 to 4.5 m from it there", length_m)));
  // Of two that know it, the first one's.
  LineWorld other = map.world();
  for (LeftOut& thing : other.left_out) {
    if (thing.what == "platform") thing.reason = "another reason";
  }
  EXPECT_THAT(reasons({other, map.world()}), ElementsAre(Pair("another reason", length_m)));
  // One that has it leaves no reason, and without a world it is that of its track.
  LineWorld with = map.world();
  PlatformSpec platform;
  platform.track = "main";
  platform.side = map.south();
  platform.begin_s_m = std::min(map.ChainageAt_m(500.0), map.ChainageAt_m(600.0));
  platform.end_s_m = platform.begin_s_m + 100.0;
  with.structures.push_back(platform);
  EXPECT_THAT(reasons({map.world(), with}), ElementsAre());
  EXPECT_THAT(reasons({}),
              ElementsAre(Pair("its track is in no world: " + std::string(kNearNoLine), length_m)));
}

TEST(MapAccount, HasTheReasonOfTheWorldForAPlatformBesideItsTrack) {
  MadeMap map{{0.0, {}}};
  map.AddPlatformArea(500.0, 600.0, -2.3, -2.0);
  map.Make();
  const AccountRow row = map.Sum("platform");
  EXPECT_EQ(row.in_worlds, 0.0);
  EXPECT_THAT(row.left_out, ElementsAre(Pair("there is no room for it beside track main",
                                             ::testing::DoubleNear(100.0, 1e-6))));
}

TEST(MapAccount, TurnsNoSignalRoundWhereTwoWaysMeetInTwoPoints) {
  MadeMap map{};
  map.AddWay({{0.0, 0.0}, {799.7, 0.0}, {800.0, 0.0}}, {});
  map.AddWay({{800.0, 0.0}, {2000.0, 0.0}}, {});
  map.AddThing({{1000.0, 0.0}}, {{"railway", "signal"}, {"railway:signal:main", "DE-ESO:ks"}});
  map.Make();
  ASSERT_THAT(map.All<SignalSpec>(), ::testing::SizeIs(1));
  EXPECT_EQ(map.All<SignalSpec>()[0].direction,
            map.runs_east() ? RunningDirection::kRising : RunningDirection::kFalling);
}

TEST(MapAccount, KnowsHowTheLastStepOfAClosedWayIsDrawn) {
  MadeMap map{};
  map.AddWay({{0.0, 0.0}, {100.0, 0.0}, {0.0, 100.0}, {0.0, 0.0}}, {});
  EXPECT_TRUE(IsDrawnForward(map.map(), {0, 2, 0}));
  EXPECT_FALSE(IsDrawnForward(map.map(), {0, 0, 2}));
  EXPECT_TRUE(IsDrawnForward(map.map(), {0, 0, 1}));
}

TEST(MapAccount, SaysWhyATrackBesideALineIsNotMade) {
  MadeMap map{{0.0, {}}};
  map.AddWay({{300.0, 20.0}, {310.0, 20.0}}, {});
  map.AddWay({{500.0, 20.0}, {510.0, 40.0}}, {});
  map.AddWay({{700.0, 50.0}, {720.0, 80.0}}, {});
  map.Make();
  EXPECT_THAT(
      map.Sum("running track").left_out,
      ElementsAre(Pair("it does not run along the line", ::testing::DoubleNear(22.36, 0.01)),
                  Pair("it leaves the 60 m beside the line", ::testing::DoubleNear(36.06, 0.01)),
                  Pair("it runs along the line for less than 20 m", 10.0)));
  ImportedLine line;
  line.name = "a";
  const std::string csv = LeftOutCsv({}, {line}, {map.world()});
  const auto at = [&](int from_m, int to_m) {
    const int from_s_m = map.runs_east() ? from_m : 2000 - to_m;
    return "a,running track," + std::to_string(from_s_m) + "," +
           std::to_string(from_s_m + to_m - from_m) + ",\"it ";
  };
  EXPECT_THAT(csv, HasSubstr(at(300, 310) + "runs along the line for less than 20 m\"\n"));
  EXPECT_THAT(csv, HasSubstr(at(500, 510) + "does not run along the line\"\n"));
  EXPECT_THAT(csv, HasSubstr(at(700, 700) + "leaves the 60 m beside the line\"\n"));
}

TEST(MapAccount, CountsWhatATrackThatCannotStandTakesWithIt) {
  MadeMap map = ImportedTracks({{0.0, {}}, {4.5, {}}});
  map.world().tracks[1].draft.spec.offset_m = 2.0;
  ASSERT_EQ(MakeStand(map.line().alignment, std::nullopt, map.world()), std::nullopt);
  EXPECT_NEAR(map.Sum("running track").in_worlds, 2000.0, 1e-6);
  EXPECT_NEAR(map.Sum("running track").out(), 1800.0, 1e-6);
}

TEST(MapAccount, HasThePlatformEdgesThatTracksOfTheMapPass) {
  MadeMap map{{0.0, {}}, {10.0, {}}};
  map.AddPlatformArea(900.0, 1100.0, 2.2, 7.6);
  map.AddPlatformArea(300.0, 400.0, -9.0, -6.0);
  map.Make();
  const AccountRow platforms = map.Sum("platform");
  EXPECT_NEAR(platforms.on_map, 400.0, 1e-6) << "two edges, and none 6 m from a track";
  EXPECT_NEAR(platforms.in_worlds, 400.0, 1.0);
}

TEST(MapAccount, CountsCrossingsSignalsAndBufferStops) {
  MadeMap map{{0.0, {}}, {4.5, {}}};
  map.AddThing({{1900.0, 4.5}}, {{"railway", "buffer_stop"}});
  map.AddThing({{500.0, 0.0}}, {{"railway", "level_crossing"}});
  map.AddThing({{501.0, 4.5}}, {{"railway", "crossing"}});
  map.AddThing({{600.0, 9.0}}, {{"railway", "crossing"}});
  map.AddThing({{800.0, 4.5}}, {{"railway", "signal"}, {"railway:signal:main", "DE-ESO:ks"}});
  map.AddThing({{700.0, 0.0}}, {{"railway", "signal"}});
  map.AddThing({{1500.0, 0.0}}, {{"railway", "buffer_stop"}});
  map.Make();
  ExpectWhole(map);
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

/// The rows of a file of CSV without the first one; commas between quotes divide no fields.
std::vector<std::vector<std::string>> CsvRows(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(ReadFileWhole(file));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    rows.emplace_back(1);
    bool is_quoted = false;
    for (const char letter : line) {
      if (letter == '"') is_quoted = !is_quoted;
      if (letter == ',' && !is_quoted) {
        rows.back().emplace_back();
      } else if (letter != '"') {
        rows.back().back() += letter;
      }
    }
  }
  return rows;
}

/// Sum of a column of CSV.
double SumOfColumn(const std::filesystem::path& file, std::size_t column) {
  double sum = 0.0;
  for (const std::vector<std::string>& row : CsvRows(file)) sum += std::stod(row.at(column));
  return sum;
}

TEST(MapAccount, HasSevenFieldsAlsoOfMapsWhosePlacesHaveCommas) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "ride.gpx";
  const std::filesystem::path out = directory.path() / "out";
  WriteFileWhole(file, R"(<gpx><trk><trkseg><trkpt lat="48.2" lon="15.60"/>
<trkpt lat="48.2" lon="15.61"/><trkpt lat="48.2" lon="15.62"/></trkseg></trk></gpx>)");
  ASSERT_THAT(Generate("import " + file.string() + " --out " + out.string()), ExitsWith(0));
  const std::vector<std::vector<std::string>> rows = CsvRows(out / "account.csv");
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows[0].at(1), "line 1, trkseg");
  for (const std::vector<std::string>& row : rows) EXPECT_THAT(row, ::testing::SizeIs(7));
}

TEST_P(AccountOfSharedMap, IsWhole) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const TemporaryDirectory directory;
  const std::filesystem::path out = directory.path() / "out";
  ASSERT_THAT(
      Generate("import " + file.string() + " " + GetParam().options + " --out " + out.string()),
      ExitsWith(0));
  double on_map_m = 0.0;
  double in_worlds_m = 0.0;
  double num_switches = 0.0;
  for (const std::vector<std::string>& row : CsvRows(out / "account.csv")) {
    ASSERT_THAT(row, ::testing::SizeIs(7)) << row[0] << " " << row[1];
    EXPECT_THAT(row[6], Not(HasSubstr(kNoReason))) << row[0] << " " << row[1];
    if (row[0] == "switch") num_switches = std::stod(row[4]);
    if (!row[0].ends_with("track")) continue;
    on_map_m += std::stod(row[3]);
    in_worlds_m += std::stod(row[4]);
  }
  // The ways of lines are in one world, those beside them in several; lines are as long as their
  // ways to 1 %, and a turnout reaches up to 40 m beyond the points of its branch.
  constexpr double kFit = 0.01;
  constexpr double kTurnout_m = 40.0;
  const double lines_m = SumOfColumn(out / "lines.csv", 1);
  const double num_turnouts = SumOfColumn(out / "tracks.csv", 2);
  EXPECT_GE(in_worlds_m, (1.0 - kFit) * lines_m);
  EXPECT_LE(in_worlds_m, (1.0 + kFit) * (lines_m + SumOfColumn(out / "tracks.csv", 5)) +
                             kTurnout_m * num_turnouts);
  EXPECT_LE(num_switches, num_turnouts + SumOfColumn(out / "tracks.csv", 9));
  if (std::string(GetParam().options).find("--within") != std::string::npos) return;
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  double ways_m = 0.0;
  for (const MapWay& way : map.ways) ways_m += LengthOf_m(map, way);
  EXPECT_NEAR(on_map_m, ways_m, 0.005 * static_cast<double>(map.ways.size()));
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
