#include "generator/extras/import/network/line_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/divided_line.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/standing_world.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using ::testing::SizeIs;

using WorldJson = nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

/// 0.01 degrees of longitude in m, 48.2 degrees to the north.
constexpr double kStep_m = 743.6;

/// A line to the east of four steps with a bridge over the second and a tunnel over the third, and
/// what stands on it and beside it.
constexpr const char* kLine = R"(
  {"type": "node", "id": 1, "lon": 15.60, "lat": 48.20, "tags": {"railway": "buffer_stop"}},
  {"type": "node", "id": 2, "lon": 15.61, "lat": 48.20},
  {"type": "node", "id": 3, "lon": 15.62, "lat": 48.20},
  {"type": "node", "id": 4, "lon": 15.63, "lat": 48.20},
  {"type": "node", "id": 5, "lon": 15.64, "lat": 48.20},
  {"type": "way", "id": 11, "nodes": [1, 2], "tags": {"railway": "rail", "electrified": "no"}},
  {"type": "way", "id": 12, "nodes": [2, 3],
   "tags": {"railway": "rail", "bridge": "yes", "electrified": "contact_line"}},
  {"type": "way", "id": 13, "nodes": [3, 4],
   "tags": {"railway": "rail", "tunnel": "yes", "electrified": "contact_line",
            "railway:ballastless": "yes"}},
  {"type": "way", "id": 14, "nodes": [4, 5],
   "tags": {"railway": "rail", "electrified": "contact_line", "gauge": "760"}})";

class OfOneLine : public ::testing::Test {
 protected:
  void Make(const std::string& more) { MakeMap(std::string(kLine) + more); }
  void MakeMap(const std::string& elements) {
    WriteFileWhole(directory_.path() / "map.json", R"({"elements": [)" + elements + "]}");
    RailMap map = ReadMap(directory_.path() / "map.json");
    static_cast<void>(ProjectMap("", map));
    const TrackLine track = FindLines(map, 0.0).front();
    runs_east_ = map.nodes[track.nodes.front()].place_m.x() < 0.0;
    line_ = ImportLine(map, track, {});
    world_ = MakeLineWorld(map, track, line_);
    AddStructures(map, track, line_, world_);
    structures_.clear();
    for (const StructureSpec& structure : world_.structures) {
      structures_.push_back(JsonOf(structure));
    }
  }
  /// Chainage of a place that is some steps from the western end.
  [[nodiscard]] double At_m(double steps) const {
    return (runs_east_ ? steps : 4.0 - steps) * kStep_m;
  }
  [[nodiscard]] const WorldJson& Only(const std::string& type) const {
    static const WorldJson none;
    const WorldJson* found = &none;
    for (const WorldJson& structure : structures_) {
      if (structure["type"] == type) found = &structure;
    }
    return *found;
  }
  void ExpectStretch(const std::string& type, double from_steps, double to_steps) const {
    const WorldJson& found = Only(type);
    ASSERT_FALSE(found.is_null()) << type;
    // The line was fitted to the points, and a step is known to 0.1 m.
    EXPECT_NEAR(found["begin_s_m"], std::min(At_m(from_steps), At_m(to_steps)), 1.0) << type;
    EXPECT_NEAR(found["end_s_m"], std::max(At_m(from_steps), At_m(to_steps)), 1.0) << type;
  }

  TemporaryDirectory directory_;
  bool runs_east_ = true;
  ImportedLine line_;
  LineWorld world_;
  std::vector<WorldJson> structures_;
};

TEST_F(OfOneLine, HasBridgesTunnelsAndSlabTrackFromItsWays) {
  Make("");
  ExpectStretch("bridge", 1.0, 2.0);
  ExpectStretch("tunnel", 2.0, 3.0);
  ExpectStretch("slab_track", 2.0, 3.0);
  EXPECT_EQ(world_.tracks[0].draft.spec.electrified, true) << "three steps of four";
  ASSERT_THAT(world_.left_out, SizeIs(2));
  EXPECT_EQ(world_.left_out[0].reason, "the map has 760 mm, the world 1435 mm");
  EXPECT_EQ(world_.left_out[1].what, "speed");
  EXPECT_EQ(world_.left_out[1].reason, "the map has none, the world 80 km/h");
  EXPECT_NEAR(world_.left_out[1].end_s_m, 4.0 * kStep_m, 1.0);
}

TEST_F(OfOneLine, TellsNoOtherSpeedWhereTheMapHasOneForEachDirection) {
  MakeMap(R"(
  {"type": "node", "id": 1, "lon": 15.60, "lat": 48.20},
  {"type": "node", "id": 2, "lon": 15.61, "lat": 48.20},
  {"type": "way", "id": 11, "nodes": [1, 2],
   "tags": {"railway": "rail", "maxspeed:forward": "60", "maxspeed:backward": "70"}})");
  EXPECT_THAT(world_.left_out, SizeIs(0));
}

TEST(GaugeOf, IsTheStandardOneOfSeveralOrTheFirst) {
  EXPECT_EQ(GaugeOf_mm("760"), 760.0);
  EXPECT_EQ(GaugeOf_mm("1000;1435"), 1435.0);
  EXPECT_EQ(GaugeOf_mm("1000; 1668"), 1000.0);
  EXPECT_EQ(GaugeOf_mm("narrow; 1668"), 1668.0);
  for (const char* none : {"", "narrow", "381", "1435 mm", "nan", ";"}) {
    EXPECT_EQ(GaugeOf_mm(none), std::nullopt) << none;
  }
}

TEST_F(OfOneLine, HasTheGaugeOfItsGreatestPart) {
  Make("");
  EXPECT_EQ(line_.alignment.gauge_mm, 1435.0);
  EXPECT_THAT(AlignmentFileText(line_, {}), Not(HasSubstr("gauge_mm")));
  std::string narrow = kLine;
  narrow.replace(narrow.find(R"(, "gauge": "760")"), 16, "");
  for (std::size_t at = 0; (at = narrow.find(R"("railway": "rail")", at)) != std::string::npos;) {
    narrow.replace(at, 17, R"("gauge": "1000", "railway": "rail")");
    at += 34;
  }
  MakeMap(narrow);
  EXPECT_EQ(line_.alignment.gauge_mm, 1000.0);
  EXPECT_THAT(AlignmentFileText(line_, {}), HasSubstr(R"("gauge_mm": 1000.0)"));
}

TEST_F(OfOneLine, HasABufferStopAtItsEnd) {
  Make("");
  EXPECT_EQ(Only("buffer_stop")["at"], runs_east_ ? "begin" : "end");
}

TEST_F(OfOneLine, HasAPlatformWhereTheMapHasOne) {
  // 0.00002 degrees of latitude are 2.2 m, 0.00006 are 6.7 m.
  Make(R"(,
  {"type": "node", "id": 21, "lon": 15.602, "lat": 48.20002},
  {"type": "node", "id": 22, "lon": 15.604, "lat": 48.20002},
  {"type": "node", "id": 23, "lon": 15.604, "lat": 48.20006},
  {"type": "node", "id": 24, "lon": 15.602, "lat": 48.20006},
  {"type": "way", "id": 31, "nodes": [21, 22, 23, 24, 21],
   "tags": {"railway": "platform", "height": "0.55", "covered": "yes"}})");
  ExpectStretch("platform", 0.2, 0.4);
  EXPECT_EQ(Only("platform")["side"], runs_east_ ? "left" : "right");
  EXPECT_EQ(Only("platform")["height_m"], 0.55);
  EXPECT_NEAR(Only("platform")["width_m"], 4.45, 0.1);
  EXPECT_TRUE(Only("platform").contains("roof"));
}

TEST_F(OfOneLine, HasCrossingsSignalsAndBoardsOnlyWhereTheyStandOnIt) {
  // 0.0001 degrees of latitude are 11 m.
  Make(R"(,
  {"type": "node", "id": 41, "lon": 15.605, "lat": 48.20, "tags": {"railway": "level_crossing"}},
  {"type": "node", "id": 42, "lon": 15.606, "lat": 48.2001, "tags": {"railway": "level_crossing"}},
  {"type": "node", "id": 43, "lon": 15.607, "lat": 48.20, "tags": {"railway": "milestone"}},
  {"type": "node", "id": 44, "lon": 15.635, "lat": 48.20, "tags": {"railway": "signal",
   "railway:signal:main": "AT-V2:hauptsignal", "railway:signal:direction": "backward"}},
  {"type": "node", "id": 45, "lon": 15.636, "lat": 48.20, "tags": {"railway": "signal"}})");
  EXPECT_NEAR(Only("level_crossing")["s_m"], At_m(0.5), 1.0);
  EXPECT_EQ(Only("level_crossing")["name"], "level_crossing_1") << "the other is 11 m beside";
  EXPECT_EQ(Only("board")["kind"], "kilometre");
  EXPECT_EQ(Only("signal")["kind"], "main");
  EXPECT_EQ(Only("signal")["direction"], runs_east_ ? "falling" : "rising");
  EXPECT_THAT(LeftOutCsv({}, {line_}, {world_}),
              HasSubstr("the map does not say which kind it is"));
}

TEST_F(OfOneLine, IsAWorldFile) {
  Make("");
  const WorldJson world = WorldJson::parse(WorldFileText(line_, world_, true));
  EXPECT_EQ(world["alignment"], "line.alignment.json");
  EXPECT_EQ(world["terrain"]["elevation"]["file"], "line.elevation.asc");
  EXPECT_EQ(world["tracks"][0]["name"], "main");
  EXPECT_THAT(world["structures"], SizeIs(4));
}

TEST_F(OfOneLine, KeepsInItsFileWhatItsTracksAndAlignmentAre) {
  Make("");
  world_.tracks[0].draft.spec.sleeper = SleeperType::kWood;
  line_.alignment.cant_max_mm = 130.0;
  const WorldJson world = WorldJson::parse(WorldFileText(line_, world_, false));
  EXPECT_EQ(world["tracks"][0].value("sleeper", "none"), "wood");
  const WorldJson alignment = WorldJson::parse(AlignmentFileText(line_, {}));
  EXPECT_EQ(alignment.value("cant_max_mm", 0.0), 130.0);
}

/// A map of one way, and the line that it makes.
struct OneLine {
  explicit OneLine(const std::vector<Eigen::Vector2d>& points_m) {
    MapWay way{1, {}, {{"railway", "tram"}, {"maxspeed", "30"}}};
    for (const Eigen::Vector2d& point_m : points_m) {
      way.nodes.push_back(map.nodes.size());
      line.nodes.push_back(map.nodes.size());
      map.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    line.ways.assign(points_m.size() - 1, 0);
    map.ways.push_back(std::move(way));
  }

  RailMap map{.nodes = {}, .ways = {}, .things = {}, .attribution = "Test"};
  TrackLine line;
};

void AddArc(const Eigen::Vector2d& middle_m,
            double radius_m,
            double from_rad,
            double to_rad,
            std::vector<Eigen::Vector2d>& points_m) {
  const int num_steps = static_cast<int>(std::ceil(std::abs(to_rad - from_rad) / 0.2));
  for (int i = 0; i <= num_steps; ++i) {
    const double rad = std::lerp(from_rad, to_rad, 1.0 * i / num_steps);
    points_m.emplace_back(middle_m + radius_m * Eigen::Vector2d(std::cos(rad), std::sin(rad)));
  }
}

/// Out for 500 m, around a loop of 20 m radius, and back beside the first track, 4 m from it.
std::vector<Eigen::Vector2d> TramWithLoop_m() {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m < 460.0; x_m += 20.0) points_m.emplace_back(x_m, 0.0);
  AddArc({500.0, 2.0}, 20.0, -0.75 * std::numbers::pi, 0.75 * std::numbers::pi, points_m);
  for (double x_m = 460.0; x_m > 0.0; x_m -= 20.0) points_m.emplace_back(x_m, 4.0);
  return points_m;
}

TEST(DividedLine, IsCutInTheMiddleOfALoopBeforeWhichItRunsBesideItself) {
  const OneLine tram(TramWithLoop_m());
  const std::vector<TrackLine> parts = DividedWhereItMeetsItself(tram.map, tram.line);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_EQ(parts[0].nodes.back(), parts[1].nodes.front());
  EXPECT_NEAR(tram.map.nodes[parts[0].nodes.back()].place_m.x(), 520.0, 5.0);
  EXPECT_NEAR(LengthOf_m(tram.map, parts[0]) + LengthOf_m(tram.map, parts[1]),
              LengthOf_m(tram.map, tram.line), 1e-9);
}

TEST(DividedLine, HasPartsWithWorldsThatStandThoughTheWholeHasNone) {
  const OneLine tram(TramWithLoop_m());
  const auto fault_of = [&](const TrackLine& line) {
    const ImportedLine imported = ImportLine(tram.map, line, {});
    LineWorld world = MakeLineWorld(tram.map, line, imported);
    return MakeStand(imported.alignment, std::nullopt, world);
  };
  EXPECT_NE(fault_of(tram.line), std::nullopt);
  for (const TrackLine& part : DividedWhereItMeetsItself(tram.map, tram.line)) {
    EXPECT_EQ(fault_of(part), std::nullopt);
  }
}

TEST(DividedLine, StaysWholeIfItKeepsClearOfItself) {
  std::vector<Eigen::Vector2d> straight_m;
  for (double x_m = 0.0; x_m <= 1000.0; x_m += 1.0) straight_m.emplace_back(x_m, 0.3 * (x_m > 500));
  std::vector<Eigen::Vector2d> ring_m;
  AddArc({0.0, 0.0}, 300.0, 0.0, 2.0 * std::numbers::pi, ring_m);
  // The smallest turn that a line may have, back to 20 m beside itself.
  std::vector<Eigen::Vector2d> hairpin_m = {{0.0, -10.0}, {200.0, -10.0}};
  AddArc({400.0, 0.0}, 10.0, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi, hairpin_m);
  hairpin_m.emplace_back(0.0, 10.0);
  for (const auto& points_m : {straight_m, ring_m, hairpin_m}) {
    const OneLine line(points_m);
    EXPECT_THAT(DividedWhereItMeetsItself(line.map, line.line), SizeIs(1));
  }
}

}  // namespace
}  // namespace railcast
