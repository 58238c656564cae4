#include "generator/extras/import/network/line_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/rail/network/turnout_place.h"
#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/network/moved_run.h"
#include "generator/extras/import/structures/map_account.h"
#include "generator/extras/import/structures/standing_world.h"

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
    line_ = ImportLine(map_, track, {});
    world_ = MakeLineWorld(map_, track, line_);
    AddSideTracks(map_, track, line_, {}, world_);
    for (const WorldTrack& made : world_.tracks) tracks_.push_back(JsonOf(made.draft.spec));
  }

  RailMap map_;
  bool runs_east_ = true;
  ImportedLine line_;
  LineWorld world_;
  std::vector<WorldJson> tracks_;
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
  EXPECT_EQ(world_.quality.num_turnouts, 0U);
}

TEST_F(BesideALine, ARunHasItsNodesWhereItsPointsAreAlsoBehindASteepStep) {
  Add({{400.0, 4.5}, {600.0, 4.5}, {601.0, 6.5}, {700.0, 6.5}, {900.0, 6.5}},
      {{"railway", "rail"}});
  Make();
  ASSERT_THAT(world_.beside.runs, SizeIs(2));
  for (const TrackRun& run : world_.beside.runs) {
    ASSERT_EQ(run.nodes.size(), run.points_m.size());
    for (std::size_t i = 0; i < run.nodes.size(); ++i) {
      const double x_m = map_.nodes[run.nodes[i]].place_m.x();
      EXPECT_NEAR(run.points_m[i].x(), runs_east_ ? x_m : 2000.0 - x_m, 0.1);
    }
  }
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
  EXPECT_EQ(world_.quality.num_turnouts, 1U);
  EXPECT_LT(world_.quality.distances_m.back(), 0.5);
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
  EXPECT_EQ(world_.quality.num_turnouts, 2U);
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
  EXPECT_THAT(world_.switches, SizeIs(5));
  EXPECT_EQ(std::ranges::count(world_.left_out, "switch", &LeftOut::what), 0);
  EXPECT_EQ(world_.quality.num_turnouts, 5U);
  // Places are sought in steps of 1 m, for 1:9-300 as well, and points are fitted to 0.1 m at 1:9.
  constexpr double kOff_m = 2.0;
  EXPECT_THAT(TangentsOn_x_m("main"),
              ElementsAre(DoubleNear(606.5, kOff_m), DoubleNear(943.5, kOff_m),
                          DoubleNear(1206.5, kOff_m)));
  EXPECT_THAT(TangentsOn_x_m("running_1"),
              ElementsAre(DoubleNear(647.0, kOff_m), DoubleNear(903.0, kOff_m)));
}

/// From a track 4.7 m to the left of the line to one on its right, with turnouts 1:9-190 whose
/// nodes are 4 m behind the tips of their blades: their arcs are 21.05 m long and lead 1.162 m
/// aside.
class AcrossALine : public BesideALine {
 protected:
  void AddTracks(bool has_node) {
    Add({{100.0, 4.7}, {951.2, 4.7}, {1900.0, 4.7}}, {{"maxspeed", "80"}});
    Add({{100.0, -4.7}, {1048.8, -4.7}, {1900.0, -4.7}}, {{"maxspeed", "80"}});
    std::vector<Eigen::Vector2d> points_m = {
        {951.2, 4.7}, {968.2, 3.538}, {1000.0, 0.0}, {1031.8, -3.538}, {1048.8, -4.7}};
    if (!has_node) points_m.erase(points_m.begin() + 2);
    Add(points_m, {{"service", "crossover"}});
  }
};

TEST_F(AcrossALine, ACrossoverHasADiamondWhereTheMapHasANode) {
  AddTracks(true);
  Make();
  ASSERT_THAT(world_.crossings, SizeIs(1));
  EXPECT_THAT(world_.crossings[0].tracks, ElementsAre("main", "crossover_1"));
  EXPECT_THAT(world_.switches, SizeIs(3));
  EXPECT_EQ(std::ranges::count(world_.left_out, "switch", &LeftOut::what), 0);
  EXPECT_EQ(MakeStand(line_.alignment, std::nullopt, world_), std::nullopt);
  ASSERT_THAT(world_.crossings, SizeIs(1));
  WorldSpec spec;
  spec.tracks.clear();
  for (const WorldTrack& track : world_.tracks) spec.tracks.push_back(track.draft.spec);
  spec.diamond_crossings = world_.crossings;
  const Network network = MakeNetwork(spec, Alignment(line_.alignment).length_m());
  ASSERT_THAT(network.diamonds, SizeIs(1));
  // A turnout is sought in steps of 1 m, by which the crossing is moved. Points are fitted to 0.3
  // m, the crossing's and those 31.8 m beside it.
  EXPECT_NEAR(network.diamonds[0].s_m, 1000.0, 2.0);
  EXPECT_NEAR(std::abs(network.diamonds[0].angle_rad), std::atan(1.0 / 9.0), 2.0 * 0.3 / 31.8);
}

TEST_F(AcrossALine, ACrossoverWithoutANodeThereIsOnAnotherLevelAndCut) {
  AddTracks(false);
  Make();
  EXPECT_THAT(world_.crossings, SizeIs(0));
  EXPECT_EQ(MakeStand(line_.alignment, std::nullopt, world_), std::nullopt);
}

/// As on the yard in Karlsruhe: of a branch that turns with 80 m radius, the first 30 m run along
/// the line. They are too short for two arcs, of at least 120 m, that end in its direction.
TEST_F(BesideALine, AShortBranchLeavesItsTurnoutInOneArcAtEitherEnd) {
  for (const double forwards : {1.0, -1.0}) {
    Add({{1000.0 + forwards * 300.0, 0.0},
         {1000.0 + forwards * 318.7, 1.56},
         {1000.0 + forwards * 323.3, 2.68},
         {1000.0 + forwards * 329.6, 4.65},
         {1000.0 + forwards * 335.0, 7.73}},
        {{"service", "yard"}, {"maxspeed", "10"}});
  }
  Make();
  EXPECT_THAT(world_.switches, SizeIs(2));
  EXPECT_EQ(MakeStand(line_.alignment, std::nullopt, world_), std::nullopt);
  ASSERT_THAT(tracks_, SizeIs(3));
  for (std::size_t i = 1; i < tracks_.size(); ++i) {
    ASSERT_THAT(tracks_[i]["elements"], SizeIs(1));
    EXPECT_GE(std::abs(tracks_[i]["elements"][0]["radius_m"].get<double>()), 120.0);
    // It ends 0.9 m beside the branch at most.
    const TrackCourse& course = world_.tracks[i].draft.course;
    const double free_s_m = tracks_[i].contains("begin") ? course.end_s_m() : course.begin_s_m();
    EXPECT_NEAR(std::abs(course.OffsetAt(free_s_m).d_m), 4.65, 0.9 + 0.3);
    EXPECT_NEAR(std::abs(free_s_m - 1000.0), 329.6, 1.0);
  }
}

TEST_F(BesideALine, ACrossoverMoreSlenderThanAnyTurnoutBeginsAndEndsWithinItself) {
  Add({{100.0, 4.7}, {500.0, 4.7}, {1000.0, 4.7}, {1500.0, 4.7}, {1900.0, 4.7}},
      {{"maxspeed", "100"}});
  // Arcs of 1200 m radius for 65 m and 1:18.5 between them.
  const auto y_m = [](double x_m) {
    return x_m < 65.0 ? x_m * x_m / 2400.0 : 1.76 + (x_m - 65.0) / 18.5;
  };
  constexpr double kLength_m = 151.8;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i <= 20; ++i) {
    const double x_m = kLength_m * i / 20.0;
    points_m.emplace_back(800.0 + x_m, i <= 10 ? y_m(x_m) : 4.7 - y_m(kLength_m - x_m));
  }
  points_m.back().y() = 4.7;
  Add(points_m, {{"service", "crossover"}, {"maxspeed", "100"}});
  map_.ways[1].nodes.insert(map_.ways[1].nodes.begin() + 2, map_.ways[2].nodes.back());
  Make();
  EXPECT_THAT(world_.switches, SizeIs(2));
}

TEST_F(BesideALine, ATrackThatLeavesTooSlowlyIsMovedToWhereATurnoutLeads) {
  // Such a branch is 3.15 m from the line after 400 m, and no turnout is as slender.
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 300.0; x_m <= 1500.0; x_m += 25.0) {
    points_m.emplace_back(x_m, 2e-5 * std::pow(x_m - 300.0, 2.0));
  }
  Add(points_m, {});
  Make();
  ASSERT_THAT(tracks_, SizeIs(2));
  EXPECT_TRUE(tracks_[1].contains("elements"));
  const std::vector<MovedTrack> moved = MovedTracksOf(world_);
  ASSERT_THAT(moved, SizeIs(1));
  // Between a turnout with the arcs behind it, 100 m or less, and where the map has 2.75 m.
  EXPECT_NEAR(moved[0].end_s_m - moved[0].begin_s_m, 300.0, 60.0);
  EXPECT_NEAR(moved[0].most_m, kMovedApart_m - 2e-5 * kMeeting_m * kMeeting_m, kMostRaised_m);
}

/// Offsets of a track of the world at every metre of it.
std::vector<double> OffsetsOf_m(const TrackDraft& track) {
  std::vector<double> offsets_m;
  for (double s_m = track.course.begin_s_m(); s_m <= track.course.end_s_m(); ++s_m) {
    offsets_m.push_back(std::abs(track.course.OffsetAt(s_m).d_m));
  }
  return offsets_m;
}

TEST_F(BesideALine, ATrackThatComesTooNearInPlacesIsMovedAwayThereAndSaysSo) {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 100.0; x_m <= 1900.0; x_m += 25.0) {
    const double to_narrow_m = std::min(std::abs(x_m - 600.0), std::abs(x_m - 1400.0));
    points_m.emplace_back(x_m, to_narrow_m < 110.0 ? 2.0 : 4.5);
  }
  Add(points_m, {{"maxspeed", "80"}});
  Make();
  ASSERT_THAT(world_.tracks, SizeIs(2)) << "one whole track";
  EXPECT_NEAR(world_.quality.length_m, 1800.0, 1.0);
  EXPECT_THAT(world_.left_out, ::testing::IsEmpty());
  const std::vector<double> offsets_m = OffsetsOf_m(world_.tracks[1].draft);
  EXPECT_GE(std::ranges::min(offsets_m), 3.0);
  EXPECT_LT(std::ranges::max(offsets_m), 4.5 + 0.4);
  ASSERT_THAT(MovedTracksOf(world_), SizeIs(2));
  for (const MovedTrack& moved : MovedTracksOf(world_)) {
    EXPECT_EQ(moved.name, "running_1");
    // Drawn at 2 m for 200 m, and S-curves of 100 m at either end are more than 0.5 m off.
    EXPECT_NEAR(moved.end_s_m - moved.begin_s_m, 300.0, 101.0);
    // The fit rounds the corners of the map by 0.1 m.
    EXPECT_GT(moved.most_m, kMovedApart_m - 2.0 - 0.1);
    EXPECT_LT(moved.most_m, kMovedApart_m - 2.0 + 0.1 + kMostRaised_m);
  }
}

TEST_F(BesideALine, TracksAreMovedOneAfterTheOther) {
  Add({{50.0, 2.5}, {1950.0, 2.5}}, {{"maxspeed", "80"}});
  Add({{100.0, 5.0}, {1900.0, 5.0}}, {{"maxspeed", "80"}});
  Make();
  ASSERT_THAT(world_.tracks, SizeIs(3));
  EXPECT_THAT(OffsetsOf_m(world_.tracks[1].draft), ::testing::Each(DoubleNear(3.25, 0.1)));
  EXPECT_THAT(OffsetsOf_m(world_.tracks[2].draft), ::testing::Each(DoubleNear(6.5, 0.2)));
  EXPECT_THAT(world_.left_out, ::testing::IsEmpty());
}

TEST_F(BesideALine, ATrackBetweenTwoOthersWithoutRoomIsCutThereAndSaysSo) {
  // Two tracks 9 m from each other, and nearer in the middle, where a third one is between them.
  Add({{50.0, 9.0}, {800.0, 9.0}, {900.0, 5.5}, {1100.0, 5.5}, {1200.0, 9.0}, {1950.0, 9.0}},
      {{"maxspeed", "80"}});
  Add({{100.0, 4.5}, {850.0, 4.5}, {900.0, 2.7}, {1100.0, 2.7}, {1150.0, 4.5}, {1900.0, 4.5}},
      {{"maxspeed", "80"}});
  Make();
  ASSERT_THAT(tracks_, SizeIs(4)) << "a piece on either side";
  ASSERT_THAT(world_.left_out, SizeIs(1));
  EXPECT_THAT(world_.left_out[0].reason,
              ::testing::MatchesRegex("it is nearer than 3.15 m to track (main|running_1) and has "
                                      "no room beside it"));
  EXPECT_GT(world_.left_out[0].end_s_m - world_.left_out[0].begin_s_m, 200.0);
  EXPECT_LT(world_.left_out[0].end_s_m - world_.left_out[0].begin_s_m, 400.0);
}

TEST_F(BesideALine, ATrackInATunnelBelowTheLineIsNotAtItsHeight) {
  // It crosses the line below ground: at the line's height there is neither track nor tunnel.
  const auto at = [](double x_m) { return Eigen::Vector2d(x_m, 0.1 * (x_m - 1000.0)); };
  Add({at(500.0), at(600.0), at(700.0)}, {});
  Add({at(700.0), at(900.0), at(1100.0), at(1300.0)}, {{"tunnel", "yes"}});
  Add({at(1300.0), at(1400.0), at(1500.0)}, {});
  Make();
  ASSERT_THAT(world_.tracks, SizeIs(3)) << "before and behind the tunnel";
  for (std::size_t i = 1; i < 3; ++i) {
    for (const double offset_m : OffsetsOf_m(world_.tracks[i].draft)) EXPECT_GT(offset_m, 29.0);
  }
  std::vector<std::string> left_out;
  for (const LeftOut& thing : world_.left_out) {
    EXPECT_EQ(thing.reason,
              "it runs below track main, and all tracks of a world have the height of their line");
    EXPECT_NEAR(thing.end_s_m - thing.begin_s_m, 600.0, 1.0);
    left_out.push_back(thing.what);
  }
  EXPECT_THAT(left_out, ::testing::UnorderedElementsAre("running track", "tunnel"));
}

TEST_F(BesideALine, ThereAreNoTurnoutsOfAnotherGaugeWhichEachSwitchSays) {
  for (MapWay& way : map_.ways) way.tags["gauge"] = "1520";
  AddSiding(600.0, 4.5, 1200.0, {{"service", "siding"}, {"gauge", "1520"}});
  Make();
  EXPECT_THAT(world_.switches, ::testing::IsEmpty());
  ASSERT_THAT(tracks_, SizeIs(2));
  const auto of_switch = std::ranges::find(world_.left_out, "switch", &LeftOut::what);
  ASSERT_NE(of_switch, world_.left_out.end());
  EXPECT_EQ(of_switch->reason,
            "there are turnouts of 1435 mm gauge only, and the line has 1520 mm");
}

/// The speeds of a run beside the line, from point to point.
TEST_F(BesideALine, TracksHaveTheSpeedOfTheirKindAndTheirCurves) {
  Add({{100.0, 10.0}, {900.0, 10.0}}, {{"railway", "tram"}});
  Add({{100.0, 20.0}, {800.0, 20.0}}, {{"railway", "rail"}, {"service", "yard"}});
  Add({{100.0, 30.0}, {700.0, 30.0}}, {{"railway", "rail"}, {"maxspeed", "100"}});
  Add({{100.0, 40.0}, {600.0, 40.0}}, {{"railway", "rail"}});
  std::vector<Eigen::Vector2d> bend_m;  // To 100 m radius and back, within 200 m.
  for (double x_m = 0.0; x_m <= 120.0; x_m += 10.0) {
    bend_m.emplace_back(1200.0 + x_m, 20.0 + 20.0 * (1.0 - std::cos(2.0 * M_PI * x_m / 280.0)));
  }
  Add(bend_m, {{"railway", "rail"}});
  const TrackLine track = FindLines(map_, 1500.0).front();
  const ImportedLine line = ImportLine(map_, track, {});
  const LinePlaces places(map_, track, line);
  std::map<std::string, std::vector<double>> speeds_kmph;
  for (const TrackRun& run : FindRuns(map_, track, places, 60.0).runs) {
    const double y_m = map_.nodes[run.nodes.front()].place_m.y();
    const bool is_bend = map_.nodes[run.nodes.front()].place_m.x() > 1100.0;
    speeds_kmph[is_bend ? "bend" : std::to_string(std::lround(y_m))] = run.speeds_kmph;
  }
  EXPECT_THAT(speeds_kmph["10"], ElementsAre(50.0));
  EXPECT_THAT(speeds_kmph["20"], ElementsAre(40.0));
  EXPECT_THAT(speeds_kmph["30"], ElementsAre(100.0));
  EXPECT_THAT(speeds_kmph["40"], ElementsAre(60.0));
  ASSERT_FALSE(speeds_kmph["bend"].empty());
  EXPECT_LT(std::ranges::min(speeds_kmph["bend"]), 55.0);
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
  AddSideTracks(map, track, line, {}, world);
  ASSERT_GE(world.tracks.size(), 3U) << "one on either straight";
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  for (const LeftOut& thing : world.left_out) {
    EXPECT_THAT(thing.reason, ::testing::AnyOf("its radius would be too small",
                                               "it leaves the ground of the line"));
  }
}

/// A double track in tunnels, which the map draws 0.4 to 8 m from each other. Of 5.72 km of the
/// second track, 1.9 km were missing when it was cut wherever it is too near.
TEST(SideTracks, AreMadeOfNearlyAllOfTheSecondTrackOfMonaco) {
  const std::filesystem::path file = RAILCAST_SHARED_DATA_DIR "/osm_more/monaco.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  const TrackLine track = FindLines(map, 1000.0).front();
  const ImportedLine line = ImportLine(map, track, {});
  LineWorld world = MakeLineWorld(map, track, line);
  AddSideTracks(map, track, line, {}, world);
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  double run_m = 0.0;
  double left_out_m = 0.0;
  for (const TrackRun& run : world.beside.runs) {
    run_m += run.points_m.back().x() - run.points_m.front().x();
  }
  for (const LeftOut& thing : world.left_out) {
    if (thing.what.ends_with(" track")) left_out_m += thing.end_s_m - thing.begin_s_m;
  }
  EXPECT_NEAR(run_m, 5720.0, 50.0);
  EXPECT_LT(left_out_m, 0.05 * run_m);
}

}  // namespace
}  // namespace railcast
