#include "core/rail/world/world_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/rail/network/network_draft.h"
#include "railcast/scenario.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr LineMeasures kLine{.length_m = 1000.0, .tightest_radius_m = 300.0};

std::vector<std::string> Faults(const WorldSpec& world, const VehicleSpec& vehicle = {}) {
  WorldFaults faults;
  const NetworkDraft network = DraftNetwork(world, kLine.length_m, faults);
  CheckWorld(world, vehicle, {kLine, network.courses}, faults);
  return faults.errors.lines();
}

ObjectSpec Box(const std::string& name, double s_m) {
  return ObjectAt(name, ObjectType::kBox, s_m);
}

TEST(CheckWorld, AcceptsTheDefaults) {
  EXPECT_THAT(Faults({}), IsEmpty());
}

TEST(CheckWorld, WantsATrack) {
  WorldSpec world;
  world.tracks.clear();
  EXPECT_THAT(Faults(world), ElementsAre("/world/tracks: must have at least one track (got none)"));
}

TEST(CheckWorld, KeepsTracksOnTheLineAndItsGround) {
  WorldSpec world;
  TrackSpec siding{.name = "main", .offset_m = -90.0, .start_s_m = 1000.0, .end_s_m = 1200.0};
  world.tracks.push_back(siding);
  EXPECT_THAT(
      Faults(world),
      ElementsAre("/world/tracks/1/name: must be unique (got \"main\")",
                  "/world/tracks/1/offset_m: must lie within the ground's half width of 80 m "
                  "(got -90)",
                  "/world/tracks/1/start_s_m: must be >= 0 and less than the line's length of "
                  "1000 m (got 1000)",
                  "/world/tracks/1/end_s_m: must be greater than start_s_m and at most the line's "
                  "length of 1000 m (got 1200)"));
}

TEST(CheckWorld, HasTurnoutsAndWagonsOfStandardGaugeOnly) {
  WorldSpec world;
  world.alignment.gauge_mm = 1000.0;
  world.tracks.push_back({.name = "loop",
                          .offset_m = 4.5,
                          .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}}});
  world.diamond_crossings = {{{"main", "loop"}, 600.0}};
  world.objects = {Box("box", 100.0), Box("wagon", 150.0)};
  world.objects[1].type = TypeNamed("tank_wagon");
  EXPECT_THAT(
      Faults(world),
      ElementsAre("/world/diamond_crossings/0/tracks: must be tracks that cross (got "
                  "\"main\" and \"loop\")",
                  "/world/tracks/1/begin: must be absent: there are turnouts of 1435 mm "
                  "only, and gauge_mm is 1000 (got \"1:9-190\")",
                  "/world/diamond_crossings/0: must be absent: there are crossings of 1435 "
                  "mm only, and gauge_mm is 1000 (got one)",
                  "/world/objects/1/type: must not be a rail vehicle: they have wheels of 1435 mm "
                  "only, and gauge_mm is 1000 (got \"tank_wagon\")"));
  world.alignment.gauge_mm = 1435.0;
  world.diamond_crossings.clear();
  EXPECT_THAT(Faults(world), IsEmpty());
}

TEST(CheckWorld, KeepsObjectsOnTheirTrack) {
  WorldSpec world;
  world.tracks.push_back({.name = "siding", .offset_m = 4.5, .start_s_m = 100.0, .end_s_m = 400.0});
  world.objects = {Box("a", 1000.5), Box("b", 50.0), Box("c", 10.0), Box("d", 10.0)};
  world.objects[1].track = "siding";
  world.objects[2].track = "sidng";
  world.objects[3].d_m = 81.0;
  EXPECT_THAT(
      Faults(world),
      ElementsAre("/world/objects/0/s_m: must lie on track \"main\", from 0 to 1000 m (got 1000.5)",
                  "/world/objects/1/s_m: must lie on track \"siding\", from 100 to 400 m (got 50)",
                  "/world/objects/2/track: must be one of \"main\", \"siding\" (got \"sidng\")",
                  "/world/objects/3/d_m: must put it within the ground's half width of 80 m "
                  "(got track offset 0 + d_m 81 = 81)"));
}

TEST(CheckWorld, AddsTheTracksOffsetToTheObjects) {
  WorldSpec world;
  world.tracks.push_back({.name = "siding", .offset_m = 4.5, .end_s_m = {}});
  world.objects = {Box("a", 10.0), Box("b", 10.0)};
  world.objects[0].d_m = world.objects[1].d_m = 78.0;
  world.objects[1].track = "siding";
  EXPECT_THAT(Faults(world),
              ElementsAre("/world/objects/1/d_m: must put it within the ground's half width of "
                          "80 m (got track offset 4.5 + d_m 78 = 82.5)"));
}

TEST(CheckWorld, KeepsTracksBesideEachOtherThreeMetresApart) {
  WorldSpec world;
  world.tracks.push_back({.name = "left", .offset_m = 3.0, .end_s_m = 500.0});
  world.tracks.push_back({.name = "beyond", .offset_m = 3.5, .start_s_m = 500.0, .end_s_m = {}});
  EXPECT_THAT(Faults(world), IsEmpty());
  world.tracks.push_back({.name = "both", .offset_m = 5.5, .start_s_m = 400.0, .end_s_m = {}});
  EXPECT_THAT(
      Faults(world),
      ElementsAre("/world/tracks/3/offset_m: must be at least 3 m from track \"left\" at 3 m, "
                  "beside which it runs from 400 to 500 m (got 5.5)"));
}

TEST(CheckWorld, SaysNothingOfWhatFollowsFromAnUnknownValue) {
  WorldSpec world;
  world.tracks.push_back({.name = "siding", .offset_m = 4.5, .end_s_m = 400.0});
  world.objects = {Box("a", 450.0), Box("b", 1200.0)};
  world.objects[0].track = "siding";
  world.objects[1].d_m = 90.0;
  WorldFaults faults;
  faults.unknown.Add("/world/tracks/1/end_s_m");
  faults.unknown.Add("/world/terrain/half_width_m");
  const NetworkDraft network = DraftNetwork(world, kLine.length_m, faults);
  CheckWorld(world, {}, {kLine, network.courses}, faults);
  EXPECT_THAT(faults.errors.lines(),
              ElementsAre("/world/objects/1/s_m: must lie on track \"main\", from 0 to 1000 m "
                          "(got 1200)"));
}

TEST(CheckWorld, WantsUniqueObjectNames) {
  WorldSpec world;
  world.objects = {Box("a", 1.0), Box("a", 2.0), Box("ego", 3.0)};
  EXPECT_THAT(Faults(world),
              ElementsAre("/world/objects/1/name: must be unique (got \"a\")",
                          "/world/objects/2/name: must be unique, and ego is the vehicle itself "
                          "(got \"ego\")"));
}

TEST(CheckWorld, LeavesInstanceIdsForMasts) {
  WorldSpec world;
  for (int i = 0; i < 19'999; ++i) world.objects.push_back(Box(std::to_string(i), 1.0));
  EXPECT_THAT(Faults(world), ElementsAre("/world/objects: must be at most 19998 (got 19999)"));
}

TEST(CheckWorld, KeepsTheVehicleOnItsTrackAndItsBoxesFull) {
  VehicleSpec vehicle;
  vehicle.start_s_m = -5.0;
  vehicle.ego_boxes_m = {{0, 0, 0, 1, 1, 1}, {0, 1, 0, 1, 1, 1}};
  EXPECT_THAT(
      Faults({}, vehicle),
      ElementsAre("/vehicle/start_s_m: must lie on track \"main\", from 0 to 1000 m (got -5)",
                  "/vehicle/ego_boxes_m/1/4: must be greater than the box's least of 1 (got 1)"));
  vehicle.track = "none";
  EXPECT_THAT(Faults({}, vehicle),
              testing::Contains("/vehicle/track: must be one of \"main\" (got \"none\")"));
}

WorldSpec StraightKilometre() {
  return WorldAlong({{ElementType::kStraight, 1000.0, {}}});
}

std::vector<std::string> DraftFaults(const WorldSpec& world,
                                     const VehicleSpec& vehicle = {},
                                     const UnknownPlaces& unknown = {}) {
  WorldFaults faults{{}, unknown};
  static_cast<void>(DraftWorld({world, vehicle, RailLabels(), RailMaterials()}, faults));
  return faults.errors.lines();
}

TEST(DraftWorld, MakesEveryPartOfASoundWorld) {
  const WorldSpec world = StraightKilometre();
  WorldFaults faults;
  const WorldDraft draft = DraftWorld({world, {}, RailLabels(), RailMaterials()}, faults);
  EXPECT_THAT(faults.errors.lines(), IsEmpty());
  EXPECT_TRUE(draft.alignment && draft.surfaces && draft.vehicle_path && draft.catenary_plan);
}

TEST(DraftWorld, FindsFaultsOfEveryPart) {
  WorldSpec world = StraightKilometre();
  world.alignment.gradients_permil = {{50.0, 1.0}};
  world.catenary.system_height_m = 0.1;
  world.objects.resize(1);
  world.objects[0].name = "a";
  world.objects[0].type = ObjectType::kBox;
  VehicleSpec vehicle;
  vehicle.start_s_m = 1001.0;
  EXPECT_THAT(
      DraftFaults(world, vehicle),
      ElementsAre("/world/alignment/gradients_permil/0/s_m: must be 0, the beginning of the line "
                  "(got 50)",
                  "/vehicle/start_s_m: must lie on track \"main\", from 0 to 1000 m (got 1001)",
                  "/world/objects/0: size_m: required for type \"box\"",
                  testing::StartsWith("/world/catenary/system_height_m: must be >= ")));
}

TEST(DraftWorld, MakesNothingOfWhatIsUnknown) {
  WorldSpec world = StraightKilometre();
  world.catenary.system_height_m = 0.1;
  world.objects.resize(1);
  world.objects[0].name = "a";
  world.objects[0].s_m = 2000.0;
  UnknownPlaces unknown;
  unknown.Add("/world/alignment/course/elements/0/length_m");
  unknown.Add("/world/catenary/max_span_m");
  unknown.Add("/world/objects/0/type");
  EXPECT_THAT(DraftFaults(world, {}, unknown), IsEmpty());
}

TEST(DraftWorld, NamesEachMissingLabelAndMaterialOnce) {
  const WorldSpec world = StraightKilometre();
  WorldFaults faults;
  static_cast<void>(DraftWorld({world, {}, LabelTable(), MaterialLibrary()}, faults));
  const std::vector<std::string>& lines = faults.errors.lines();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "/labels: the table must hold \"rail\""), 1);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "/materials: the library must hold \"leaf\""),
            1);
}

/// The ground narrows to 40 m in the curve and is 80 m wide far from it.
TEST(DraftWorld, HoldsTracksToTheGroundWhereTheyAre) {
  WorldSpec world = WorldAlong({{ElementType::kStraight, 600.0, {}},
                                {ElementType::kArc, 80.0, 50.0},
                                {ElementType::kStraight, 600.0, {}}});
  world.tracks.push_back({.name = "beside", .offset_m = 60.0, .end_s_m = 400.0});
  EXPECT_THAT(DraftFaults(world), IsEmpty());
  world.tracks[1].end_s_m = 640.0;
  EXPECT_THAT(DraftFaults(world),
              ElementsAre(testing::StartsWith(
                  "/world/tracks/1/offset_m: must leave 4.5 m to the edge of the ground, which "
                  "narrows to 40 m in a curve (got 60)")));
}

}  // namespace
}  // namespace railcast
