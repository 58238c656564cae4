#include "generator/import/network/side_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/rail/line/turnout_geometry.h"
#include "generator/import/lines/standing_world.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/network/track_json.h"

namespace railcast {
namespace {

using WorldJson = nlohmann::ordered_json;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::SizeIs;

/// A straight line of 2000 m to the east, and tracks beside it.
class BesideALine : public ::testing::Test {
 protected:
  BesideALine() {
    map_.attribution = "Test";
    std::vector<Eigen::Vector2d> points_m;
    for (double x_m = 0.0; x_m <= 2000.0; x_m += 50.0) points_m.emplace_back(x_m, 0.0);
    Add(points_m, {{"railway", "rail"}, {"maxspeed", "80"}});
  }
  void Add(const std::vector<Eigen::Vector2d>& points_m, const MapTags& tags) {
    MapWay way{static_cast<std::int64_t>(map_.ways.size()), {}, tags};
    for (const Eigen::Vector2d& point_m : points_m) {
      const auto known = std::ranges::find(map_.nodes, point_m, &MapNode::place_m);
      way.nodes.push_back(static_cast<std::size_t>(known - map_.nodes.begin()));
      if (known == map_.nodes.end()) map_.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    map_.ways.push_back(way);
  }
  /// A track that leaves the line by 1:9 from x_m on and runs beside it at y_m up to end_x_m.
  void AddSiding(double x_m, double y_m, double end_x_m, const MapTags& tags) {
    std::vector<Eigen::Vector2d> points_m = {{x_m, 0.0}};
    for (double at_m = 5.0; at_m < 9.0 * y_m; at_m += 5.0) {
      points_m.emplace_back(x_m + at_m, at_m / 9.0);
    }
    for (double at_m = x_m + 9.0 * y_m; at_m <= end_x_m; at_m += 20.0) {
      points_m.emplace_back(at_m, y_m);
    }
    Add(points_m, tags);
  }
  /// Where tangents meet in the turnouts that the world has on a track, ascending.
  [[nodiscard]] std::vector<double> TangentsOn_x_m(const std::string& track) const {
    std::vector<double> places_m;
    for (const WorldJson& other : tracks_) {
      for (const char* end : {"begin", "end"}) {
        if (!other.contains(end) || other[end]["track"] != track) continue;
        const TurnoutType type =
            other[end]["turnout"] == "1:9-300" ? TurnoutType::k9_300 : TurnoutType::k9_190;
        const double forwards = std::string(end) == "begin" ? 1.0 : -1.0;
        const double s_m = other[end]["s_m"].get<double>() + forwards * GeometryOf(type).tangent_m;
        places_m.push_back(runs_east_ ? s_m : 2000.0 - s_m);
      }
    }
    std::ranges::sort(places_m);
    return places_m;
  }
  void Make() {
    const TrackLine track = FindLines(map_, 1000.0).front();
    runs_east_ = map_.nodes[track.nodes.front()].place_m.x() < 1000.0;
    const ImportedLine line = ImportLine(map_, track, {});
    world_ = MakeLineWorld(map_, track, line);
    quality_ = AddSideTracks(map_, track, line, 0.3, world_);
    for (const WorldTrack& made : world_.tracks) tracks_.push_back(JsonOf(made.draft.spec));
  }

  RailMap map_;
  bool runs_east_ = true;
  LineWorld world_;
  std::vector<WorldJson> tracks_;
  SideTrackQuality quality_;
};

TEST_F(BesideALine, ATrackOfItsOwnIsParallel) {
  Add({{200.0, 4.7}, {500.0, 4.8}, {900.0, 4.6}, {1500.0, 4.7}}, {{"electrified", "no"}});
  Make();
  ASSERT_THAT(tracks_, SizeIs(2));
  const WorldJson& track = tracks_[1];
  EXPECT_EQ(track["name"], "running_1");
  EXPECT_NEAR(std::abs(track["offset_m"].get<double>()), 4.7, 0.05);
  EXPECT_NEAR(track["start_s_m"], runs_east_ ? 200.0 : 500.0, 0.5);
  EXPECT_NEAR(track["end_s_m"], runs_east_ ? 1500.0 : 1800.0, 0.5);
  EXPECT_EQ(track["electrified"], false);
  EXPECT_EQ(quality_.num_turnouts, 0U);
}

TEST_F(BesideALine, ASidingBeginsInATurnout) {
  AddSiding(600.0, 4.5, 1200.0, {{"service", "siding"}});
  Make();
  ASSERT_THAT(tracks_, SizeIs(2));
  const WorldJson& track = tracks_[1];
  const WorldJson& turnout = track[runs_east_ ? "begin" : "end"];
  EXPECT_EQ(track["name"], "siding_1");
  EXPECT_EQ(turnout["track"], "main");
  EXPECT_EQ(turnout["turnout"], "1:9-190");
  // The tangents meet at 600 m, 190 tan(atan(1 / 9) / 2) behind the turnout's beginning; points
  // were made to 0.1 m, and where the branch crosses half the offset is known to 0.2 m.
  const double begin_x_m = 600.0 - 10.52;
  EXPECT_NEAR(turnout["s_m"], runs_east_ ? begin_x_m : 2000.0 - begin_x_m, 1.0);
  EXPECT_EQ(quality_.num_turnouts, 1U);
  EXPECT_LT(quality_.distances_m.back(), 0.5);
}

TEST_F(BesideALine, ACrossoverLeadsFromTrackToTrack) {
  Add({{100.0, 4.5}, {700.0, 4.5}, {1300.0, 4.5}, {1900.0, 4.5}}, {{"maxspeed", "80"}});
  Add({{800.0, 0.0}, {820.25, 2.25}, {840.5, 4.5}}, {{"service", "crossover"}});
  Make();
  ASSERT_THAT(tracks_, SizeIs(3));
  const WorldJson& crossover = tracks_[2];
  EXPECT_EQ(crossover["name"], "crossover_1");
  EXPECT_EQ(crossover["begin"]["track"], runs_east_ ? "main" : "running_1");
  EXPECT_EQ(crossover["end"]["track"], runs_east_ ? "running_1" : "main");
  // Tangents of 10.52 m at either end of 40.5 m at 1:9; tracks were fitted to 0.1 m.
  const double from_s_m = crossover["begin"]["s_m"].get<double>();
  EXPECT_NEAR(crossover["end"]["s_m"].get<double>(), from_s_m + 61.54, 6.0);
  EXPECT_EQ(quality_.num_turnouts, 2U);
}

/// Turnouts 1:9-190 whose nodes on the map are 4 m behind the tips of their blades.
TEST_F(BesideALine, EverySwitchOfADoubleTrackWithASidingIsATurnout) {
  Add({{100.0, 4.5}, {400.0, 4.5}, {653.5, 4.5}, {896.5, 4.5}, {1200.0, 4.5}, {1900.0, 4.5}},
      {{"maxspeed", "80"}});
  // Arcs end at 21.05 m and 1.162 m, and tangents meet after 10.52 m.
  Add({{600.0, 0.0}, {617.05, 1.162}, {626.75, 2.25}, {636.5, 3.338}, {653.5, 4.5}},
      {{"service", "crossover"}});
  Add({{896.5, 4.5}, {913.5, 3.338}, {923.25, 2.25}, {932.95, 1.162}, {950.0, 0.0}},
      {{"service", "crossover"}});
  std::vector<Eigen::Vector2d> siding_m = {
      {1200.0, 0.0}, {1217.05, -1.162}, {1228.0, -2.386}, {1236.5, -3.338}};
  for (double x_m = 1260.0; x_m <= 1600.0; x_m += 20.0) siding_m.emplace_back(x_m, -4.5);
  Add(siding_m, {{"service", "siding"}});
  Make();
  EXPECT_EQ(quality_.num_switches, 5U);
  EXPECT_EQ(quality_.num_made, 5U);
  EXPECT_EQ(quality_.num_turnouts, 5U);
  // Places are sought in steps of 1 m, for 1:9-300 as well, and points are fitted to 0.1 m at 1:9.
  constexpr double kOff_m = 2.0;
  EXPECT_THAT(TangentsOn_x_m("main"),
              ElementsAre(DoubleNear(606.5, kOff_m), DoubleNear(943.5, kOff_m),
                          DoubleNear(1206.5, kOff_m)));
  EXPECT_THAT(TangentsOn_x_m("running_1"),
              ElementsAre(DoubleNear(647.0, kOff_m), DoubleNear(903.0, kOff_m)));
}

TEST_F(BesideALine, ATrackThatCannotBeJoinedIsCutAndSaysSo) {
  // It leaves the line too slowly for any turnout, and goes on doing so.
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 300.0; x_m <= 1500.0; x_m += 25.0) {
    points_m.emplace_back(x_m, 2e-5 * std::pow(x_m - 300.0, 2.0));
  }
  Add(points_m, {});
  Make();
  ASSERT_THAT(tracks_, SizeIs(2));
  EXPECT_TRUE(tracks_[1].contains("elements"));
  EXPECT_GE(std::abs(tracks_[1]["offset_m"].get<double>()), 3.0);
  ASSERT_THAT(world_.left_out, SizeIs(2));
  EXPECT_EQ(world_.left_out[0].reason,
            "it is nearer than 3 m to others there, too sharp, or too short");
  EXPECT_EQ(world_.left_out[1].what, "switch");
  EXPECT_EQ(world_.left_out[1].reason,
            "no turnout fits there that leads to the branch, apart from others");
}

TEST_F(BesideALine, EveryPieceOfATrackIsKeptThatComesTooNearInPlaces) {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 100.0; x_m <= 1900.0; x_m += 25.0) {
    const double to_narrow_m = std::min(std::abs(x_m - 600.0), std::abs(x_m - 1400.0));
    points_m.emplace_back(x_m, to_narrow_m < 110.0 ? 2.0 : 4.5);
  }
  Add(points_m, {{"maxspeed", "80"}});
  Make();
  ASSERT_THAT(tracks_, SizeIs(4));
  // Of 1800 m, 200 m are too near in either place, and the fit needs some on either side to get
  // there.
  EXPECT_GT(quality_.length_m, 1800.0 - 2.0 * 330.0);
  ASSERT_THAT(world_.left_out, SizeIs(2));
  for (const LeftOut& thing : world_.left_out) {
    EXPECT_EQ(thing.what, "running track");
    EXPECT_GT(thing.end_s_m - thing.begin_s_m, 190.0);
    EXPECT_LT(thing.end_s_m - thing.begin_s_m, 330.0);
  }
}

/// A line that turns by 90 degrees with 60 m radius, and a track that leads along its first
/// straight 50 m to the left and on around the middle of the curve.
TEST(SideTracks, EndBeforeTheMiddleOfACurve) {
  RailMap map{.nodes = {}, .ways = {}, .things = {}, .attribution = "Test"};
  const auto add = [&](const std::vector<Eigen::Vector2d>& points_m, const MapTags& tags) {
    MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, tags};
    for (const Eigen::Vector2d& point_m : points_m) {
      way.nodes.push_back(map.nodes.size());
      map.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    map.ways.push_back(way);
  };
  const auto bend = [](double radius_m) {
    std::vector<Eigen::Vector2d> points_m;
    for (double x_m = 0.0; x_m < 600.0; x_m += 20.0) points_m.emplace_back(x_m, 60.0 - radius_m);
    for (double rad = 0.0; rad < 1.6; rad += 0.1) {
      points_m.emplace_back(600.0 + radius_m * std::sin(rad), 60.0 - radius_m * std::cos(rad));
    }
    for (double y_m = 80.0; y_m < 400.0; y_m += 20.0) points_m.emplace_back(600.0 + radius_m, y_m);
    return points_m;
  };
  add(bend(60.0), {{"railway", "rail"}, {"maxspeed", "30"}});
  add(bend(12.0), {{"railway", "rail"}, {"service", "yard"}, {"maxspeed", "30"}});
  const TrackLine track = FindLines(map, 500.0).front();
  const ImportedLine line = ImportLine(map, track, {});
  LineWorld world = MakeLineWorld(map, track, line);
  static_cast<void>(AddSideTracks(map, track, line, 0.3, world));
  ASSERT_GE(world.tracks.size(), 3U) << "one on either straight";
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  for (const LeftOut& thing : world.left_out) {
    EXPECT_EQ(thing.reason, "it is nearer than 3 m to others there, too sharp, or too short");
  }
}

}  // namespace
}  // namespace railcast
