#include "generator/extras/import/lines/speed_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>
#include <vector>

#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"

namespace railcast {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::SizeIs;

/// Two ways of 400 m each along x, with a point every 100 m.
RailMap TwoWays(const MapTags& tags, const MapTags& more_of_second = {}) {
  RailMap map;
  for (int i = 0; i <= 8; ++i) {
    map.nodes.push_back({.place_m = Eigen::Vector2d(100.0 * i, 0.0), .tags = {}});
  }
  map.ways.push_back({1, {0, 1, 2, 3, 4}, tags});
  map.ways.push_back({2, {4, 5, 6, 7, 8}, tags});
  map.ways[1].tags.insert(more_of_second.begin(), more_of_second.end());
  return map;
}

std::vector<double> SpeedsOf_kmph(const RailMap& map) {
  std::vector<double> speeds_kmph;
  for (const StepSpeed& speed : SpeedsAlong(map, FindLines(map, 0.0).front(), 60.0)) {
    speeds_kmph.push_back(speed.speed_kmph);
  }
  return speeds_kmph;
}

TEST(SpeedLimits, AreReadInKilometresAndMilesPerHour) {
  EXPECT_EQ(SpeedOf_kmph("120"), 120.0);
  EXPECT_EQ(SpeedOf_kmph("80 km/h"), 80.0);
  EXPECT_NEAR(*SpeedOf_kmph("50 mph"), 80.47, 0.01);
  EXPECT_NEAR(*SpeedOf_kmph("30 knots"), 55.56, 1e-9);
  for (const char* other :
       {"", "none", "signals", "DE:rural", "80;", "80;none", "80-100", "-5", "0", "inf", "nan",
        "1200", "1e200", "700 mph", "30 parsecs", "80 km/h x"}) {
    EXPECT_EQ(SpeedOf_kmph(other), std::nullopt) << other;
  }
}

/// The limits of a straight of 1000 m with these speeds between these chainages.
std::vector<ChainageValue> LimitsOf(const std::vector<double>& speeds_kmph,
                                    const std::vector<double>& feet_m) {
  std::vector<StepSpeed> speeds;
  for (const double speed_kmph : speeds_kmph) speeds.push_back({speed_kmph, true});
  return SpeedLimitsOf(speeds, feet_m, PlanOf({}, {{ElementType::kStraight, 1000.0, {}}}));
}

TEST(SpeedLimits, HoldForFiftyMetresAndAreNeverRaisedForThat) {
  // A short fast one and a step fall, a slow one grows, also at the end.
  EXPECT_THAT(LimitsOf({80.0, 100.0, 80.0, 60.0, 40.0}, {0.0, 300.0, 312.0, 600.0, 620.0, 1000.0}),
              ElementsAre(ChainageValue{0.0, 80.0}, ChainageValue{600.0, 40.0}));
  EXPECT_THAT(LimitsOf({80.0, 30.0, 80.0}, {0.0, 500.0, 512.0, 1000.0}),
              ElementsAre(ChainageValue{0.0, 80.0}, ChainageValue{481.0, 30.0},
                          ChainageValue{531.0, 80.0}));
  EXPECT_THAT(LimitsOf({80.0, 30.0}, {0.0, 990.0, 1000.0}),
              ElementsAre(ChainageValue{0.0, 80.0}, ChainageValue{950.0, 30.0}));
  EXPECT_THAT(LimitsOf({20.0, 80.0, 30.0, 80.0}, {0.0, 490.0, 500.0, 505.0, 1000.0}),
              ElementsAre(ChainageValue{0.0, 20.0}, ChainageValue{527.5, 80.0}));
}

TEST(SpeedLimits, AreTheLeastOfSeveral) {
  EXPECT_EQ(SpeedOf_kmph("120;100"), 100.0);
  EXPECT_EQ(SpeedOf_kmph("100 | 120 | 110"), 100.0);
  EXPECT_NEAR(*SpeedOf_kmph("100; 50 mph"), 80.47, 0.01);
}

TEST(SpeedLimits, AreTheLesserOfTwoDirections) {
  EXPECT_EQ(SpeedOf_kmph(MapTags{{"maxspeed", "120"}}), 120.0);
  EXPECT_EQ(SpeedOf_kmph(MapTags{{"maxspeed", "120"}, {"maxspeed:backward", "90"}}), 90.0);
  EXPECT_EQ(SpeedOf_kmph(MapTags{{"maxspeed", "80"}, {"maxspeed:forward", "100"}}), 80.0);
  EXPECT_EQ(SpeedOf_kmph(MapTags{
                {"maxspeed", "80"}, {"maxspeed:backward", "90"}, {"maxspeed:forward", "100"}}),
            90.0);
  EXPECT_EQ(SpeedOf_kmph(MapTags{{"maxspeed:forward", "100"}}), 100.0);
  EXPECT_EQ(SpeedOf_kmph(MapTags{{"maxspeed:forward", "signals"}}), std::nullopt);
  EXPECT_EQ(SpeedOf_kmph(MapTags{}), std::nullopt);
  EXPECT_THAT(SpeedsOf_kmph(TwoWays({{"railway", "rail"}, {"maxspeed:forward", "70"}})),
              Each(70.0));
}

TEST(SpeedLimits, AreThoseOfAConditionOnlyIfItAlwaysHolds) {
  const auto speed_kmph = [](const char* conditional) {
    return SpeedOf_kmph(MapTags{{"maxspeed", "80"}, {"maxspeed:conditional", conditional}});
  };
  for (const char* other : {"60 @ (22:00-06:00)", "60 @ wet", "none @ 24/7", ";", "@", "(", ")"}) {
    EXPECT_EQ(speed_kmph(other), 80.0) << other;
  }
  EXPECT_EQ(speed_kmph("60 @ (22:00-06:00); 100 @ (24/7)"), 100.0);
  EXPECT_EQ(speed_kmph("40 mph"), 40.0 * 1.609344);
}

TEST(SpeedLimits, AreToldWhereTheyAreNotTakenAsTheyStand) {
  RailMap map = TwoWays({{"railway", "rail"}}, {{"maxspeed", "DE:rural"}});
  map.ways[0].tags["maxspeed"] = "120;100";
  map.ways[0].tags["maxspeed:forward"] = "90";
  map.ways[0].tags["maxspeed:backward"] = "signals";
  map.ways[0].tags["maxspeed:conditional"] = "60 @ (22:00-06:00; SH off); 50 @ wet; 110";
  map.ways[0].tags["maxspeed:hgv"] = "70";
  map.ways[0].tags["maxspeed:source"] = "sign";
  map.ways[0].tags["tracks"] = "2";
  map.ways[0].place = "way 1";
  TellTags(map);
  EXPECT_EQ(
      map.remarks,
      (std::vector<Remark>{
          {RemarkKind::kSpeedsChosen, "way 1", 1, "\"120;100\""},
          {RemarkKind::kSpeedsUnread, "way 1", 1, "maxspeed:backward=signals"},
          {RemarkKind::kSpeedsChosen, "way 1", 1, "maxspeed:forward=90"},
          {RemarkKind::kTagsUnread, "way 1", 1, "maxspeed:conditional=60 @ (22:00-06:00; SH off)"},
          {RemarkKind::kTagsUnread, "way 1", 1, "maxspeed:conditional=50 @ wet"},
          {RemarkKind::kSpeedsChosen, "way 1", 1, "maxspeed:conditional=110"},
          {RemarkKind::kTagsUnread, "way 1", 1, "maxspeed:hgv=70"},
          {RemarkKind::kTagsUnread, "way 1", 1, "tracks=2"},
          {RemarkKind::kSpeedsUnread, "", 1, "\"DE:rural\""},
      }));
}

TEST(SpeedLimits, AreThoseOfTheNearestWayWhereAWayHasNone) {
  RailMap map = TwoWays({{"railway", "rail"}}, {{"maxspeed", "90"}});
  EXPECT_THAT(SpeedsOf_kmph(map), Each(90.0));
  map.ways[0].tags["maxspeed"] = "50";
  EXPECT_THAT(SpeedsOf_kmph(map),
              ::testing::UnorderedElementsAre(50.0, 50.0, 50.0, 50.0, 90.0, 90.0, 90.0, 90.0));
  EXPECT_THAT(SpeedsOf_kmph(TwoWays({{"railway", "rail"}})), Each(60.0));
}

TEST(SpeedLimits, AreThoseOfTheirKindWithoutAny) {
  EXPECT_EQ(UsualSpeed_kmph({{"railway", "rail"}}, 80.0), 80.0);
  EXPECT_EQ(UsualSpeed_kmph({{"railway", "rail"}, {"service", "yard"}}, 80.0), 40.0);
  EXPECT_EQ(UsualSpeed_kmph({{"railway", "rail"}, {"usage", "industrial"}}, 80.0), 40.0);
  EXPECT_EQ(UsualSpeed_kmph({{"railway", "tram"}}, 120.0), 50.0);
  EXPECT_EQ(UsualSpeed_kmph({{"railway", "subway"}}, 120.0), 80.0);
  EXPECT_THAT(SpeedsOf_kmph(TwoWays({{"railway", "tram"}})), Each(50.0));
}

TEST(SpeedInArc, BalancesCantAndDeficiency) {
  // No cant up to 50 m, (R - 50) / 1.5 mm up to 275 m, 150 mm beyond, and 60 mm of deficiency.
  EXPECT_NEAR(SpeedInArc_kmph(17.0), std::sqrt(17.0 * 60.0 / 11.8), 1e-9);
  EXPECT_NEAR(SpeedInArc_kmph(125.0), std::sqrt(125.0 * 110.0 / 11.8), 1e-9);
  EXPECT_NEAR(SpeedInArc_kmph(500.0), std::sqrt(500.0 * 210.0 / 11.8), 1e-9);
}

/// A straight of 200 m, a quarter of a circle to the left and another straight, with a point every
/// 3 m.
RailMap StreetCorner(double radius_m, const MapTags& tags) {
  constexpr double kStraight_m = 200.0;
  const double arc_m = radius_m * M_PI / 2.0;
  RailMap map;
  MapWay way{1, {}, tags};
  for (double s_m = 0.0; s_m <= 2.0 * kStraight_m + arc_m; s_m += 3.0) {
    const double inside_m = std::clamp(s_m - kStraight_m, 0.0, arc_m);
    const double angle_rad = inside_m / radius_m;
    way.nodes.push_back(map.nodes.size());
    map.nodes.push_back({.place_m = {std::min(s_m, kStraight_m) + radius_m * std::sin(angle_rad),
                                     radius_m * (1.0 - std::cos(angle_rad)) +
                                         std::max(0.0, s_m - kStraight_m - arc_m)},
                         .tags = {}});
  }
  map.ways = {way};
  return map;
}

ImportedLine LineOf(const RailMap& map) {
  return ImportLine(map, FindLines(map, 0.0).front(), {.sigma_m = 0.1});
}

/// No arc asks for more than 1 / 0.8 of the radius that it has.
void ExpectNoFasterThanItsArcs(const ImportedLine& line) {
  EXPECT_GE(line.quality.tightest_radius_m, 0.8 * line.quality.needed_radius_m) << line.name;
}

TEST(SpeedLimits, KeepTramsSlowInStreetCornersWhichHaveNoCant) {
  for (const MapTags& tags :
       {MapTags{{"railway", "tram"}}, MapTags{{"railway", "tram"}, {"maxspeed", "50"}},
        MapTags{{"railway", "rail"}}}) {
    const ImportedLine line = LineOf(StreetCorner(25.0, tags));
    ASSERT_NEAR(line.quality.tightest_radius_m, 25.0, 3.0);
    ExpectNoFasterThanItsArcs(line);
    ASSERT_GE(line.alignment.speed_limits_kmph.size(), 3U);
    EXPECT_EQ(line.alignment.speed_limits_kmph.front().value,
              TagOf(tags, "railway") == "tram" ? 50.0 : 80.0);
    const Alignment alignment(line.alignment);
    for (double s_m = 0.0; s_m < alignment.length_m(); s_m += 1.0) {
      EXPECT_LT(std::abs(1500.0 * std::sin(alignment.At(s_m).cant_rad)), 10.0) << s_m;
    }
  }
}

TEST(SpeedLimits, OfTheMapCountWhereTheirRadiusNearlySuffices) {
  // 80 km/h need 270 m with 150 mm of cant and 130 mm of deficiency, of which 0.8 are 216 m.
  const RailMap map = StreetCorner(240.0, {{"railway", "rail"}, {"maxspeed", "80"}});
  EXPECT_THAT(LineOf(map).alignment.speed_limits_kmph,
              ElementsAre(Field(&ChainageValue::value, 80.0)));
}

/// Trams and sidings about a station, two lines between 1.2 and 1.3 km; the others take longer.
TEST(SpeedLimits, LeaveNoLineOfDarmstadtWithoutTheRadiusThatItNeeds) {
  const std::filesystem::path file = RAILCAST_SHARED_DATA_DIR "/osm_more/da_hbf_2.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  int num_lines = 0;
  for (const TrackLine& track : FindLines(map, 1200.0)) {
    if (LengthOf_m(map, track) > 1300.0) continue;
    ++num_lines;
    const ImportedLine line = ImportLine(map, track, {});
    ExpectNoFasterThanItsArcs(line);
    EXPECT_LT(line.quality.tightest_radius_m, 50.0) << "no street corner";
  }
  EXPECT_EQ(num_lines, 2);
}

bool HasContactLineByRule(RailMap map) {
  FillElectrified(map);
  return HasContactLine(map, FindLines(map, 0.0).front());
}

TEST(ContactLine, IsThereWhereTheMapHasIt) {
  EXPECT_TRUE(
      HasContactLineByRule(TwoWays({{"railway", "rail"}}, {{"electrified", "contact_line"}})));
  EXPECT_FALSE(HasContactLineByRule(TwoWays({{"railway", "tram"}}, {{"electrified", "rail"}})));
}

TEST(ContactLine, MayBeOneOfSeveralValues) {
  for (const auto& [electrified, has_one] :
       {std::pair("contact_line;rail", true), std::pair("rail; contact_line", true),
        std::pair("rail;no", false), std::pair("4th_rail;yes", true)}) {
    const MapTags tags = {{"railway", "rail"}, {"electrified", electrified}};
    EXPECT_EQ(HasContactLineByRule(TwoWays(tags, tags)), has_one) << electrified;
  }
}

TEST(TagValues, ThatAreNotUnderstoodAreTold) {
  RailMap map = TwoWays({{"railway", "tram;rail"},
                         {"electrified", "contact_line;4th_rail"},
                         {"service", "yard"},
                         {"usage", "sightseeing"},
                         {"gauge", "1435;wide"}});
  map.ways.resize(1);
  map.things.push_back({{{15.5, 48.25}}, {}, {{"railway", "platform"}, {"height", "low; 0.55"}}});
  TellTags(map);
  std::vector<std::string> told;
  for (const Remark& remark : map.remarks) {
    EXPECT_EQ(remark.kind, RemarkKind::kTagsUnread);
    told.push_back(remark.detail);
  }
  EXPECT_THAT(told, testing::UnorderedElementsAre("railway=rail", "electrified=4th_rail",
                                                  "usage=sightseeing", "gauge=wide", "height=low"));
  EXPECT_EQ(map.remarks.back().place, "thing at 48.25, 15.5");
  EXPECT_EQ(map.ways[0].tags["railway"], "tram");
  EXPECT_EQ(map.things[0].tags["height"], "0.55");
}

TEST(ContactLine, IsNotThereWithoutATagUnlessItIsUsual) {
  EXPECT_FALSE(HasContactLineByRule(TwoWays({{"railway", "rail"}})));
  EXPECT_TRUE(HasContactLineByRule(TwoWays({{"railway", "tram"}})));
  // Another track of the map, longer than the two ways of 800 m, has the tag.
  for (const auto& [end_x_m, electrified, is_usual] :
       {std::tuple(1000.0, "contact_line", true), std::tuple(1000.0, "no", false),
        std::tuple(700.0, "contact_line", false)}) {
    RailMap map = TwoWays({{"railway", "rail"}});
    map.ways.push_back(
        {3, {9, 10}, {{"railway", "rail"}, {"service", "siding"}, {"electrified", electrified}}});
    map.nodes.push_back({.place_m = {0.0, 50.0}, .tags = {}});
    map.nodes.push_back({.place_m = {end_x_m, 50.0}, .tags = {}});
    EXPECT_EQ(HasContactLineByRule(map), is_usual) << end_x_m << electrified;
  }
}

}  // namespace
}  // namespace railcast
