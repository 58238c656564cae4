#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/catenary/catenary.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

// A straight of 600 m with a wagon at 100 m; the vehicle starts at 30 m at 20 m/s.
std::shared_ptr<const RailWorld> Make(bool vehicle_moves = true) {
  WorldSpec world = WorldAlong({{ElementType::kStraight, 600.0, {}}});
  world.objects = {ObjectAt("wagon", TypeNamed("open_wagon"), 100.0)};
  VehicleSpec vehicle;
  vehicle.start_s_m = 30.0;
  if (vehicle_moves) vehicle.motion.profile = {{0.0, std::nullopt, 20.0}};
  vehicle.ego_boxes_m = {{-4.0, -1.5, 0.2, 0.5, 1.5, 2.0}};
  return std::make_shared<const RailWorld>(world, vehicle, RailLabels(), RailMaterials(), 7);
}

std::vector<std::string> NamesAndInstances(const RailWorld& world) {
  std::vector<std::string> names;
  for (const SceneObject& object : world.objects()) {
    names.push_back(object.name + " " + std::to_string(object.instance));
  }
  return names;
}

template <typename Change>
std::string FaultOf(const Change& change) {
  return MessageOf([&] { static_cast<void>(change()); });
}

TEST(ChangedWorld, ChangesTheVehiclesWayFromThatTimeOn) {
  const auto world = Make();
  const auto braked = world->WithVehicleSpeed(2 * kNsPerS, 0.0, 2.0);
  EXPECT_DOUBLE_EQ(braked->VehicleChainage_m(2 * kNsPerS), 70.0);
  // It stops after 100 m and 10 s.
  EXPECT_DOUBLE_EQ(braked->VehicleChainage_m(12 * kNsPerS), 170.0);
  EXPECT_DOUBLE_EQ(braked->VehicleChainage_m(90 * kNsPerS), 170.0);
  EXPECT_EQ(braked->VehicleSpeed_mps(90 * kNsPerS), 0.0);
  EXPECT_EQ(braked->HomeChunk(90 * kNsPerS), 3);
  // Its own boxes move with it; the original world is unchanged.
  EXPECT_TRUE(
      braked->WorldFromObject(1, 90 * kNsPerS).isApprox(braked->WorldFromVehicle(90 * kNsPerS)));
  EXPECT_DOUBLE_EQ(world->VehicleChainage_m(12 * kNsPerS), 270.0);
  EXPECT_FALSE(world->has_changed_vehicle_speed());
  EXPECT_TRUE(braked->has_changed_vehicle_speed());
}

TEST(ChangedWorld, AStandingVehicleThatIsToldToGoMoves) {
  const auto world = Make(false);
  EXPECT_FALSE(world->objects().at(1).moves);
  const auto going = world->WithVehicleSpeed(kNsPerS, 5.0, 1.0);
  EXPECT_TRUE(going->objects().at(1).moves);
  EXPECT_FALSE(world->objects().at(1).moves);
  EXPECT_DOUBLE_EQ(going->VehicleChainage_m(7 * kNsPerS), 30.0 + 12.5 + 5.0);
}

TEST(ChangedWorld, NeverGivesAnInstanceIdAgain) {
  const auto world = Make();
  const auto one = world->WithObject(ObjectAt("a", ObjectType::kPerson, 200.0), 0);
  EXPECT_EQ(NamesAndInstances(*one), (std::vector<std::string>{"wagon 1", "ego 2", "a 3"}));
  const auto none = one->WithoutObject("a")->WithoutObject("wagon");
  EXPECT_EQ(NamesAndInstances(*none), (std::vector<std::string>{"ego 2"}));
  const auto other = none->WithObject(ObjectAt("a", ObjectType::kPerson, 200.0), 0);
  EXPECT_EQ(NamesAndInstances(*other), (std::vector<std::string>{"ego 2", "a 4"}));
  EXPECT_EQ(NamesAndInstances(*world), (std::vector<std::string>{"wagon 1", "ego 2"}));
}

TEST(ChangedWorld, HasNoInstanceIdsForEver) {
  auto world = Make();
  ObjectSpec box = ObjectAt("a", ObjectType::kBox, 200.0);
  box.size_m = {1.0, 1.0, 1.0};
  for (std::uint32_t instance = 3; instance < kFirstMastInstance; ++instance) {
    world = world->WithObject(box, 0);
    ASSERT_EQ(world->objects().back().instance, instance);
    world = world->WithoutObject("a");
  }
  EXPECT_EQ(FaultOf([&] { return world->WithObject(box, 0); }),
            "/object: must be one of at most 19999 objects of a run, those that were removed "
            "included");
}

TEST(ChangedWorld, BeginsAnObjectsMotionWhenItIsPlaced) {
  ObjectSpec walker = ObjectAt("walker", ObjectType::kPerson, 200.0);
  walker.motion = MotionSpec{{{0.0, std::nullopt, 0.0}, {2.0, std::nullopt, 2.0}}};
  const auto world = Make()->WithObject(walker, 10 * kNsPerS);
  EXPECT_TRUE(world->objects().at(2).moves);
  EXPECT_DOUBLE_EQ(world->ObjectChainage_m(2, 10 * kNsPerS), 200.0);
  EXPECT_DOUBLE_EQ(world->ObjectChainage_m(2, 13 * kNsPerS), 204.0);
  EXPECT_EQ(world->object_track(2).name, "main");
}

TEST(ChangedWorld, PutsAnObjectWhereAScenarioWouldPutIt) {
  WorldSpec spec = WorldAlong({{ElementType::kStraight, 600.0, {}}});
  ObjectSpec person = ObjectAt("person", ObjectType::kPerson, 200.0);
  person.d_m = -3.0;
  person.heading_deg = 40.0;
  spec.objects = {person};
  const RailWorld written(spec, {}, RailLabels(), RailMaterials(), 7);
  spec.objects = {};
  const RailWorld empty(spec, {}, RailLabels(), RailMaterials(), 7);
  const auto placed = empty.WithObject(person, 5 * kNsPerS);
  EXPECT_EQ(placed->WorldFromObject(0, 0).matrix(), written.WorldFromObject(0, 0).matrix());
}

TEST(ChangedWorld, KeepsItsChunks) {
  const auto world = Make();
  const auto changed = world->WithObject(ObjectAt("a", ObjectType::kPerson, 200.0), 0)
                           ->WithVehicleSpeed(kNsPerS, 0.0, 1.0);
  EXPECT_EQ(changed->ChunksInReach(3, 100.0), world->ChunksInReach(3, 100.0));
  const Chunk chunk = changed->BuildChunk(3);
  const Chunk before = world->BuildChunk(3);
  ASSERT_EQ(chunk.placements.size(), before.placements.size());
  for (std::size_t i = 0; i < chunk.placements.size(); ++i) {
    // Models are shared, not copied, except cantilevers, which each chunk builds itself.
    const bool is_own = before.placements[i].model->name == "cantilever";
    ASSERT_EQ(chunk.placements[i].model == before.placements[i].model, !is_own);
  }
}

TEST(ChangedWorld, RefusesWhatAScenarioMayNotHold) {
  const auto world = Make();
  const auto placing = [&](const ObjectSpec& object) {
    return FaultOf([&] { return world->WithObject(object, 0); });
  };
  ObjectSpec object = ObjectAt("a", ObjectType::kPerson, 200.0);
  object.track = "siding";
  EXPECT_EQ(placing(object), "/object/track: must be one of \"main\" (got \"siding\")");
  EXPECT_EQ(placing(ObjectAt("a", ObjectType::kPerson, 601.0)),
            "/object/s_m: must lie on track \"main\", from 0 to 600 m (got 601)");
  object = ObjectAt("a", ObjectType::kPerson, 200.0);
  object.d_m = 81.0;
  EXPECT_EQ(placing(object),
            "/object/d_m: must put it within the ground's half width of 80 m (got track offset 0 "
            "+ d_m 81 = 81)");
  EXPECT_EQ(placing(ObjectAt("wagon", ObjectType::kPerson, 200.0)),
            "/object/name: must be unique (got \"wagon\")");
  EXPECT_EQ(placing(ObjectAt("ego", ObjectType::kPerson, 200.0)),
            "/object/name: must be unique, and ego is the vehicle itself (got \"ego\")");
  EXPECT_EQ(placing(ObjectAt("a", ObjectType::kBox, 200.0)),
            "/object: size_m: required for type \"box\"");
  object = ObjectAt("a", ObjectType::kPerson, 200.0);
  object.label = "ghost";
  EXPECT_EQ(placing(object), "/object: label: must be in the label table (got \"ghost\")");
  const auto removing = [&](const std::string& name) {
    return FaultOf([&] { return world->WithoutObject(name); });
  };
  EXPECT_EQ(removing("nobody"),
            "/name: must be the name of an object that is there (got \"nobody\")");
  EXPECT_EQ(removing("ego"), "/name: must be the name of an object that is there (got \"ego\")");
}

TEST(ChangedWorld, RefusesToRemoveABarrier) {
  WorldSpec world = WorldAlong({{ElementType::kStraight, 600.0, {}}});
  LevelCrossingSpec crossing = CrossingAt(300.0);
  crossing.barrier_angles_deg = {{2.0, 90.0}, {8.0, 0.0}};
  world.structures = {crossing};
  const RailWorld made(world, VehicleSpec{}, RailLabels(), RailMaterials(), 7);
  EXPECT_EQ(FaultOf([&] { return made.WithoutObject("crossing/left"); }),
            "/name: must not be a barrier of a level crossing (got \"crossing/left\")");
}

}  // namespace
}  // namespace railcast
