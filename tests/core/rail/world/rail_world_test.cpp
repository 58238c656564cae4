#include "railcast/rail_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/rail/catenary/catenary.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

WorldSpec CurvedWorld() {
  WorldSpec world = WorldAlong({{ElementType::kStraight, 200.0, {}},
                                {ElementType::kClothoid, 100.0, {}},
                                {ElementType::kArc, 325.0, 400.0}});
  world.alignment.gradients_permil = {{0.0, 5.0}};
  world.alignment.speed_limits_kmph = {{0.0, 80.0}};
  world.tracks.push_back({.name = "second", .offset_m = 4.0});
  return world;
}

VehicleSpec MovingVehicle() {
  VehicleSpec vehicle;
  vehicle.start_s_m = 30.0;
  vehicle.motion.profile = {{0.0, std::nullopt, 20.0}};
  return vehicle;
}

RailWorld MakeRailWorld(const WorldSpec& world, const VehicleSpec& vehicle) {
  return RailWorld(world, vehicle, RailLabels(), RailMaterials(), 7);
}

std::string WorldFaultOf(const WorldSpec& world, const VehicleSpec& vehicle) {
  return MessageOf([&] { MakeRailWorld(world, vehicle); });
}

Eigen::AlignedBox3d BoundsOf(const Chunk& chunk) {
  Eigen::AlignedBox3d box = chunk.ground.Bounds();
  for (const Placement& placement : chunk.placements) {
    for (const Part& part : placement.model->parts) {
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        box.extend(placement.chunk_from_model * vertex.cast<double>());
      }
    }
  }
  return box;
}

TEST(RailWorld, MovesTheVehicleAlongItsTrack) {
  VehicleSpec vehicle = MovingVehicle();
  vehicle.track = "second";
  const RailWorld world = MakeRailWorld(CurvedWorld(), vehicle);
  const Transform world_from_vehicle = world.WorldFromVehicle(20 * kNsPerS);
  EXPECT_TRUE(world_from_vehicle.translation().isApprox(
      world.alignment().WorldFromTrack(430.0, 4.0).translation(), 1e-12));
  // Its second pivot is on the track, too: 5 m behind on the chord, some 5 m along the line.
  vehicle.pivot_distance_m = 5.0;
  const Vector3 rear = MakeRailWorld(CurvedWorld(), vehicle).WorldFromVehicle(20 * kNsPerS) *
                       Vector3(-5.0, 0.0, 0.0);
  double least_m = 1.0;
  for (double s_m = 424.5; s_m < 425.5; s_m += 1e-4) {
    const Vector3 on_track = world.alignment().WorldFromTrack(s_m, 4.0).translation();
    least_m = std::min(least_m, (on_track - rear).norm());
  }
  EXPECT_LT(least_m, 1e-4);
  EXPECT_EQ(world.HomeChunk(0), 0);
  EXPECT_EQ(world.HomeChunk(1 * kNsPerS), 1);
  EXPECT_EQ(world.HomeChunk(20 * kNsPerS), 8);
}

TEST(RailWorld, LetsAVehicleInReverseLookWhereItGoes) {
  VehicleSpec vehicle = MovingVehicle();
  vehicle.start_s_m = 400.0;
  vehicle.motion.reverse = true;
  const RailWorld world = MakeRailWorld(CurvedWorld(), vehicle);
  const Transform before = world.WorldFromVehicle(0);
  const Transform after = world.WorldFromVehicle(kNsPerS);
  const Vector3 way = (after.translation() - before.translation()).normalized();
  EXPECT_GT(way.dot(before.linear().col(0)), 0.99);
  // Upright as the track is between its pivots: the cant changes by less than 1 mrad over 10 m.
  const Vector3 up = world.alignment().WorldFromTrack(400.0).linear().col(2);
  EXPECT_GT(before.linear().col(2).dot(up), 1.0 - 1e-6);
}

TEST(RailWorld, KnowsWhereTheVehicleIsInItsHomeChunk) {
  VehicleSpec vehicle = MovingVehicle();
  vehicle.track = "second";
  const RailWorld world = MakeRailWorld(CurvedWorld(), vehicle);
  const std::vector<Transform> poses = world.VehiclePosesIn(8);  // From 400 to 450 m.
  for (std::size_t i = 1; i < poses.size(); ++i) {
    // On the outside of an arc of 400 m, 1 m of chainage is 1.01 m long.
    EXPECT_LE((poses[i].translation() - poses[i - 1].translation()).norm(), 1.011);
  }
  // The vehicle leaves s = 30 m at 20 m/s.
  const auto expect_at = [&](const Transform& pose, double s_m) {
    const auto time_ns = static_cast<std::int64_t>((s_m - 30.0) / 20.0 * 1e9);
    EXPECT_TRUE(pose.isApprox(world.WorldFromVehicle(time_ns), 1e-9)) << s_m;
  };
  expect_at(poses.front(), 400.0);
  expect_at(poses.at(poses.size() / 2), 425.0);
  expect_at(poses.back(), 450.0);
}

TEST(RailWorld, NumbersItsObjectsAndPutsTheVehicleLast) {
  WorldSpec spec = CurvedWorld();
  spec.objects = {ObjectAt("wagon", TypeNamed("open_wagon"), 100.0),
                  ObjectAt("walker", ObjectType::kPerson, 120.0)};
  spec.objects[1].motion = MotionSpec{{{0.0, std::nullopt, 1.5}}};
  VehicleSpec vehicle = MovingVehicle();
  vehicle.ego_boxes_m = {{-4.0, -1.5, 0.2, 0.5, 1.5, 2.0}, {-4.0, -1.5, 2.0, -1.0, 1.5, 4.0}};
  const RailWorld world = MakeRailWorld(spec, vehicle);
  ASSERT_EQ(world.objects().size(), 3U);
  const SceneObject& wagon = world.objects()[0];
  EXPECT_EQ(wagon.instance, 1U);
  EXPECT_EQ(wagon.label, RailLabels().Id("wagon"));
  EXPECT_FALSE(wagon.moves);
  const SceneObject& walker = world.objects()[1];
  EXPECT_EQ(walker.instance, 2U);
  EXPECT_EQ(walker.label, RailLabels().Id("person"));
  EXPECT_TRUE(walker.moves);
  const SceneObject& ego = world.objects()[2];
  EXPECT_EQ(ego.name, "ego");
  EXPECT_EQ(ego.instance, 3U);
  EXPECT_TRUE(ego.is_ego);
  EXPECT_TRUE(ego.moves);
  EXPECT_EQ(ego.model->num_triangles(), 24U);
  EXPECT_TRUE(ego.model->Bounds().min().isApprox(Vector3(-4.0, -1.5, 0.2), 1e-6));
  EXPECT_TRUE(world.WorldFromObject(2, kNsPerS).isApprox(world.WorldFromVehicle(kNsPerS), 1e-12));
}

TEST(RailWorld, PlacesObjectsByTheirTrack) {
  WorldSpec spec = CurvedWorld();
  spec.objects = {ObjectAt("wagon", TypeNamed("tank_wagon"), 500.0),
                  ObjectAt("walker", ObjectType::kPerson, 500.0)};
  spec.objects[0].track = "second";
  spec.objects[1].d_m = -2.0;
  spec.objects[1].heading_deg = 90.0;
  const RailWorld world = MakeRailWorld(spec, {});
  const Alignment& alignment = world.alignment();
  // Its pivots, 10.5 m apart, throw the wagon's middle inwards by their distance squared over 8 R.
  const Transform axis_from_wagon =
      alignment.WorldFromTrack(500.0, 4.0).inverse() * world.WorldFromObject(0, 0);
  const double throw_m = 10.5 * 10.5 / 8.0 * alignment.At(500.0).curvature_per_m;
  EXPECT_NEAR(axis_from_wagon.translation().y(), throw_m, 2e-3);
  EXPECT_NEAR(axis_from_wagon.translation().x(), 0.0, 1e-3);
  EXPECT_TRUE(axis_from_wagon.linear().isApprox(Eigen::Matrix3d::Identity(), 2e-3));
  const Transform world_from_walker = world.WorldFromObject(1, 0);
  EXPECT_TRUE(world_from_walker.translation().head<2>().isApprox(
      alignment.WorldFromTrack(500.0, -2.0).translation().head<2>(), 1e-12));
  EXPECT_TRUE(world_from_walker.linear().col(2).isApprox(Vector3::UnitZ(), 1e-12));
  EXPECT_NEAR(
      world_from_walker.linear().col(0).dot(alignment.WorldFromTrack(500.0).linear().col(0)), 0.0,
      0.01);  // Across the track, except for gradient and cant.
}

TEST(RailWorld, LaysADragShoeOnTheRail) {
  WorldSpec spec = CurvedWorld();
  spec.objects = {ObjectAt("shoe", TypeNamed("drag_shoe"), 500.0)};
  spec.objects[0].d_m = 0.753;
  const RailWorld world = MakeRailWorld(spec, {});
  EXPECT_TRUE(world.WorldFromObject(0, 0).translation().isApprox(
      world.alignment().WorldFromTrack(500.0, 0.753).translation(), 1e-9));
}

TEST(RailWorld, FillsEveryChunkWithGroundTracksAndMasts) {
  const RailWorld world = MakeRailWorld(CurvedWorld(), {});
  const int last = world.HomeChunk(3600 * kNsPerS) + 12;
  bool has_mast = false;
  for (int chunk = 0; chunk <= last; ++chunk) {
    const Chunk built = world.BuildChunk(chunk);
    const Eigen::AlignedBox3d box = BoundsOf(built);
    const double length_m = chunk == last ? 25.0 : 50.0;
    EXPECT_NEAR(box.sizes().x(), length_m, 20.0) << chunk;
    EXPECT_NEAR(box.sizes().y(), 160.0, 20.0) << chunk;
    for (const Placement& placement : built.placements) {
      has_mast = has_mast || placement.instance >= kFirstMastInstance;
    }
  }
  EXPECT_TRUE(has_mast);
}

TEST(RailWorld, BuildsTheSameChunkEveryTime) {
  const RailWorld world = MakeRailWorld(CurvedWorld(), {});
  const RailWorld again = MakeRailWorld(CurvedWorld(), {});
  ExpectSameChunk(world.BuildChunk(5), again.BuildChunk(5));
}

TEST(RailWorld, ReachesAllChunksThatABeamMayHit) {
  const RailWorld world = MakeRailWorld(CurvedWorld(), {});
  // From chunk 0: 100 m range, 8 m overhang, 7.5 m slack.
  EXPECT_THAT(world.ChunksInReach(0, 100.0), testing::ElementsAre(0, 1, 2, 3));
}

TEST(RailWorld, ReportsTheFaultsOfLinePlacesAndProfilesTogether) {
  WorldSpec world = CurvedWorld();
  world.alignment.gradients_permil = {{3.0, 1.0}};
  world.objects = {ObjectAt("a", ObjectType::kPerson, 10.0),
                   ObjectAt("b", ObjectType::kPerson, 10.0)};
  world.objects[0].motion = MotionSpec{{{0.0, std::nullopt, -1.0}}};
  world.objects[1].track = "third";
  VehicleSpec vehicle = MovingVehicle();
  vehicle.motion.profile.push_back({std::nullopt, 50.0, 1.0});
  EXPECT_EQ(
      WorldFaultOf(world, vehicle),
      "/world/alignment/gradients_permil/0/s_m: must be 0, the beginning of the line (got 3)\n"
      "/world/objects/1/track: must be one of \"main\", \"second\" (got \"third\")\n"
      "/vehicle/motion/profile/1: must be at a time_s like the first point (got s_m)\n"
      "/world/objects/0/motion/profile/0/speed_mps: must be >= 0 (got -1)");
}

TEST(RailWorld, ReportsTheFaultsOfAllObjectsTogether) {
  WorldSpec world = CurvedWorld();
  world.objects = {ObjectAt("a", ObjectType::kBox, 10.0), ObjectAt("b", ObjectType::kMesh, 10.0)};
  EXPECT_EQ(WorldFaultOf(world, {}),
            "/world/objects/0: size_m: required for type \"box\"\n"
            "/world/objects/1: file: required for type \"mesh\"");
}

}  // namespace
}  // namespace railcast
