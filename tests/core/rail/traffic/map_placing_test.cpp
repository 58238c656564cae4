#include "core/rail/traffic/object_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/rail/line/map_place.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

// Places are found to 1 um, over some hundred steps of rounding.
constexpr double kPlaced_m = 1e-5;

/// A quarter of a circle to the left after a straight, on a map whose origin is not the world's,
/// with a track that branches off to the right.
class PlacedOnAMap : public testing::Test {
 protected:
  PlacedOnAMap() {
    AlignmentSpec& line = world_.alignment;
    line.course = AlignmentElementsSpec{{{ElementType::kStraight, 300.0, {}},
                                         {ElementType::kClothoid, 40.0, {}},
                                         {ElementType::kArc, 200.0, kRadius_m}}};
    line.origin_m = {700.0, -400.0, 3.0};
    line.heading_deg = 25.0;
    line.speed_limits_kmph = {{0.0, 50.0}};
    line.map = MapSpec{{-5000.0, 340'000.0}, 15.63, 48.21, {}};
    TrackSpec branch{.name = "branch",
                     .begin = TurnoutSpec{"main", 100.0, TurnoutType::k9_190, {}, {}}};
    branch.offset_m = -4.5;
    world_.tracks.push_back(branch);
  }

  static ObjectSpec Person(const std::string& track, double s_m, double d_m) {
    ObjectSpec person = ObjectAt("person", ObjectType::kPerson, s_m, d_m);
    person.track = track;
    person.heading_deg = 30.0;
    return person;
  }
  [[nodiscard]] std::shared_ptr<const RailWorld> Make(ObjectSpec object) const {
    WorldSpec world = world_;
    world.objects = {std::move(object)};
    return std::make_shared<const RailWorld>(world, VehicleSpec{}, RailLabels(), RailMaterials(),
                                             7);
  }
  [[nodiscard]] std::string FaultOf(const ObjectSpec& object) const {
    return MessageOf([&] { static_cast<void>(Make(object)); });
  }
  /// The same object where it is in the world, by the projection or by longitude and latitude.
  [[nodiscard]] ObjectSpec ByProjection(const ObjectSpec& object,
                                        const Eigen::Vector2d& world_m) const {
    ObjectSpec placed = object;
    placed.s_m = placed.d_m = 0.0;
    placed.x_m = world_m.x() + world_.alignment.map->origin_m[0];
    placed.y_m = world_m.y() + world_.alignment.map->origin_m[1];
    return placed;
  }
  [[nodiscard]] ObjectSpec ByLongitude(const ObjectSpec& object,
                                       const Eigen::Vector2d& world_m) const {
    constexpr double kMetresPerDegree_m = 111'000.0;
    Eigen::Vector2d there_deg(world_.alignment.map->longitude_deg,
                              world_.alignment.map->latitude_deg);
    for (int step = 0; step < 20; ++step) {
      const Eigen::Vector2d off_m =
          world_m - WorldFromGeographic(*world_.alignment.map, there_deg.x(), there_deg.y());
      there_deg.x() += off_m.x() / (kMetresPerDegree_m * std::cos(RadFromDeg(there_deg.y())));
      there_deg.y() += off_m.y() / kMetresPerDegree_m;
    }
    ObjectSpec placed = object;
    placed.s_m = placed.d_m = 0.0;
    placed.longitude_deg = there_deg.x();
    placed.latitude_deg = there_deg.y();
    return placed;
  }

  static constexpr double kRadius_m = 130.0;
  WorldSpec world_;
};

TEST_F(PlacedOnAMap, ObjectsStandWhereTheyDoByChainageAndDistance) {
  // From where the branch begins, over its turnout and the tight curve, to the end of the line.
  for (const char* track : {"main", "branch"}) {
    for (const double s_m : {100.0, 118.0, 290.0, 320.0, 400.0, 540.0}) {
      for (const double d_m : {-20.0, -0.5, 0.0, 3.0, 60.0}) {
        const ObjectSpec person = Person(track, s_m, d_m);
        const Transform world_from_person = Make(person)->WorldFromObject(0, 0);
        const Eigen::Vector2d place_m = world_from_person.translation().head<2>();
        for (const ObjectSpec& placed :
             {ByProjection(person, place_m), ByLongitude(person, place_m)}) {
          const Transform found = Make(placed)->WorldFromObject(0, 0);
          EXPECT_LT((found.translation() - world_from_person.translation()).norm(), kPlaced_m)
              << track << " " << s_m << " " << d_m;
          EXPECT_LT((found.linear() - world_from_person.linear()).norm(), kPlaced_m)
              << track << " " << s_m << " " << d_m;
        }
      }
    }
  }
}

TEST_F(PlacedOnAMap, ObjectsOfAWorldWithoutAMapStandAtItsOwnCoordinates) {
  world_.alignment.map.reset();
  ObjectSpec person = Person("main", 0.0, 0.0);
  // 100 m along the straight, which leads 25 degrees to the north from (700, -400).
  person.x_m = 700.0 + 100.0 * std::cos(RadFromDeg(25.0));
  person.y_m = -400.0 + 100.0 * std::sin(RadFromDeg(25.0));
  EXPECT_NEAR(Make(person)->ObjectChainage_m(0, 0), 100.0, kPlaced_m);
  person.x_m.reset();
  person.y_m.reset();
  person.longitude_deg = 15.7;
  person.latitude_deg = 48.2;
  EXPECT_EQ(FaultOf(person),
            "/world/objects/0/longitude_deg: must not be given: the alignment has no map that says "
            "where the world lies (got 15.7)");
}

TEST_F(PlacedOnAMap, RailVehiclesStandOnTheAxisOfTheirTrack) {
  ObjectSpec wagon = Person("branch", 250.0, 0.0);
  wagon.type = TypeNamed("flat_wagon");
  wagon.heading_deg = 0.0;
  const Transform world_from_wagon = Make(wagon)->WorldFromObject(0, 0);
  const auto beside_m = [&](double d_m) -> Eigen::Vector2d {
    return (world_from_wagon.translation() + d_m * world_from_wagon.linear().col(1)).head<2>();
  };
  const Transform found = Make(ByProjection(wagon, beside_m(1.4)))->WorldFromObject(0, 0);
  EXPECT_LT((found.translation() - world_from_wagon.translation()).norm(), kPlaced_m);
  EXPECT_EQ(FaultOf(ByProjection(wagon, beside_m(2.25))),
            "/world/objects/0/x_m: must lie with y_m within 1.5 m of the axis of track \"branch\", "
            "on which it stands (got 2.25 m)");
}

TEST_F(PlacedOnAMap, ObjectsMustLieOnTheGroundBesideTheirTrackAndAtOnePlaceOfIt) {
  const auto place_m = [&](double s_m, double d_m) -> Eigen::Vector2d {
    return Alignment(world_.alignment).WorldFromTrack(s_m, d_m).translation().head<2>();
  };
  const ObjectSpec person = Person("main", 0.0, 0.0);
  EXPECT_EQ(FaultOf(ByProjection(person, place_m(200.0, 90.0))),
            "/world/objects/0/x_m: must lie with y_m on the ground, within 80 m of the line (got "
            "90 m)");
  EXPECT_EQ(FaultOf(ByProjection(person, place_m(-3.5, 2.0))),
            "/world/objects/0/x_m: must lie with y_m beside track \"main\", from 0 to 540 m (got "
            "chainage -3.5 m)");
  EXPECT_EQ(FaultOf(ByProjection(Person("branch", 0.0, 0.0), place_m(90.0, 2.0))),
            "/world/objects/0/x_m: must lie with y_m beside track \"branch\", from 100 to 540 m "
            "(got chainage 90 m)");
  world_.terrain.half_width_m = 140.0;
  EXPECT_THAT(FaultOf(ByLongitude(person, place_m(400.0, kRadius_m))),
              testing::MatchesRegex("/world/objects/0/longitude_deg: must lie with latitude_deg "
                                    "nearer to one place of the line than to any other \\(got 130 "
                                    "m from 3[0-9.]+ and 5[0-9.]+ m\\)"));
}

TEST_F(PlacedOnAMap, MustLieWithinAQuarterOfATurn) {
  ObjectSpec person = Person("main", 0.0, 0.0);
  person.longitude_deg = -90.0;
  person.latitude_deg = 48.0;
  EXPECT_EQ(FaultOf(person),
            "/world/objects/0/longitude_deg: must lie within 90 degrees of the map's, 15.63 (got "
            "-90)");
}

TEST_F(PlacedOnAMap, PathsLeadThroughPlacesOfTheMap) {
  ObjectSpec walker = Person("main", 200.0, -6.0);
  const Eigen::Vector2d end_m =
      Make(Person("main", 210.0, 7.0))->WorldFromObject(0, 0).translation().head<2>();
  PathSpec path;
  path.points.emplace_back();
  path.speed_mps = 2.0;
  const auto end_of_path = [&] {
    walker.motion.emplace();
    walker.motion->path = path;
    return Make(walker)->WorldFromObject(0, 600 * kNsPerS).translation().head<2>().eval();
  };
  const ObjectSpec by_projection = ByProjection(walker, end_m);
  path.points[0].x_m = by_projection.x_m;
  path.points[0].y_m = by_projection.y_m;
  EXPECT_LT((end_of_path() - end_m).norm(), kPlaced_m);
  const ObjectSpec by_longitude = ByLongitude(walker, end_m);
  path.points[0] = {};
  path.points[0].longitude_deg = by_longitude.longitude_deg;
  path.points[0].latitude_deg = by_longitude.latitude_deg;
  EXPECT_LT((end_of_path() - end_m).norm(), kPlaced_m);

  world_.alignment.map.reset();
  EXPECT_THAT(FaultOf(walker),
              testing::StartsWith("/world/objects/0/motion/path/points/0/longitude_deg: must not "
                                  "be given: the alignment has no map"));
}

TEST_F(PlacedOnAMap, ObjectsOfCommandsStandThereToo) {
  const ObjectSpec person = Person("main", 400.0, 5.0);
  const auto with_one = Make(person);
  const Transform expected = with_one->WorldFromObject(0, 0);
  ObjectSpec placed = ByLongitude(person, expected.translation().head<2>());
  placed.name = "other";
  const auto with_two = with_one->WithObject(placed, 0);
  EXPECT_LT((with_two->WorldFromObject(1, 0).translation() - expected.translation()).norm(),
            kPlaced_m);
  placed.name = "third";
  placed.latitude_deg = 49.0;
  EXPECT_THAT(MessageOf([&] { static_cast<void>(with_two->WithObject(placed, 0)); }),
              testing::MatchesRegex("/object/longitude_deg: must lie with "
                                    "latitude_deg on the ground, within 80 m of "
                                    "the line \\(got [0-9.]+ m\\)"));
}

}  // namespace
}  // namespace railcast
