#include "core/rail/world/world_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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
