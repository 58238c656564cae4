#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/objects/mesh_object.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kArcRadius_m = 300.0;

/// A straight of 300 m and an arc to the left, with a second track on its outside.
WorldSpec LineWithTrain(const std::string& track, double s_m) {
  WorldSpec world =
      WorldAlong({{ElementType::kStraight, 300.0, {}}, {ElementType::kArc, 400.0, kArcRadius_m}});
  world.tracks.push_back({.name = "second", .offset_m = -4.5});
  TrainSpec train{.name = "freight",
                  .track = track,
                  .s_m = s_m,
                  .vehicles = {{TypeNamed("tank_wagon"), {}, false},
                               {TypeNamed("flat_wagon"), "container", false},
                               {TypeNamed("open_wagon"), {}, true}}};
  world.trains = {train};
  return world;
}

ObjectSpec BoxNamed(const std::string& name) {
  ObjectSpec box = ObjectAt(name, ObjectType::kBox, 50.0);
  box.size_m = {1.0, 1.0, 1.0};
  return box;
}

RailWorld WorldOf(const WorldSpec& world, const VehicleSpec& vehicle = {}) {
  return {world, vehicle, RailLabels(), RailMaterials(), 7};
}

std::string TrainFaultOf(const WorldSpec& world, const VehicleSpec& vehicle = {}) {
  return MessageOf([&] { WorldOf(world, vehicle); });
}

/// Where the buffers of a vehicle meet those of its neighbours: in the middle of its ends.
Vector3 EndOf(const RailWorld& world, std::size_t object, ObjectType type, double end) {
  return world.WorldFromObject(object, 0) * Vector3(end * 0.5 * MeasuresOf(type).length_m, 0, 0);
}

TEST(Trains, StandInTheirOrderWithTouchingBuffers) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.objects = {BoxNamed("box")};
  const RailWorld world = WorldOf(spec);
  ASSERT_THAT(world.objects(), SizeIs(4));
  std::vector<std::string> named;
  for (const SceneObject& object : world.objects()) {
    named.push_back(object.name + " " + std::to_string(object.instance) + " " + object.type);
  }
  EXPECT_THAT(named, ElementsAre("box 1 box", "freight/1 2 tank_wagon", "container 3 flat_wagon",
                                 "freight/3 4 open_wagon"));
  // Lengths over buffers are 16.0, 19.74 and 14.04 m.
  EXPECT_NEAR(world.WorldFromObject(1, 0).translation().x(), 250.0 - 8.0, 1e-9);
  EXPECT_NEAR(world.WorldFromObject(2, 0).translation().x(), 250.0 - 16.0 - 9.87, 1e-9);
  EXPECT_NEAR(world.WorldFromObject(3, 0).translation().x(), 250.0 - 16.0 - 19.74 - 7.02, 1e-9);
  // The last one is turned.
  EXPECT_NEAR(world.WorldFromObject(1, 0).linear()(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(world.WorldFromObject(3, 0).linear()(0, 0), -1.0, 1e-12);
  // Nothing bends on the straight.
  for (const SceneObject& object : world.objects()) EXPECT_THAT(object.pieces, IsEmpty());
}

// Beside the curve, 19.74 m of track are only 19.45 m of chainage. Two equal vehicles of length L
// meet where the tangents at their middles do, 2 R tan(t) = L, instead of 2 R t = L: the gap is
// below L^3 / 12 R^2, 7 mm. Vehicles whose pivots are a and b apart are thrown inwards by a^2 / 8 R
// and b^2 / 8 R, which sets their ends off against each other by another 42 mm at most.
TEST(Trains, TouchWithTheirBuffersBesideACurve) {
  const RailWorld world = WorldOf(LineWithTrain("second", 500.0));
  const Vector3 rear_of_first = EndOf(world, 0, TypeNamed("tank_wagon"), -1.0);
  const Vector3 front_of_second = EndOf(world, 1, TypeNamed("flat_wagon"), 1.0);
  const Vector3 rear_of_second = EndOf(world, 1, TypeNamed("flat_wagon"), -1.0);
  const Vector3 front_of_third = EndOf(world, 2, TypeNamed("open_wagon"), -1.0);  // Turned.
  const Vector3 along = world.WorldFromObject(1, 0).linear().col(0);
  EXPECT_NEAR((rear_of_first - front_of_second).dot(along), 0.0, 0.01);
  EXPECT_NEAR((rear_of_second - front_of_third).dot(along), 0.0, 0.01);
  EXPECT_LT((rear_of_first - front_of_second).norm(), 0.05);
  EXPECT_LT((rear_of_second - front_of_third).norm(), 0.05);
}

TEST(Trains, TurnTheBogiesOfStandingVehiclesInACurve) {
  const RailWorld world = WorldOf(LineWithTrain("main", 500.0));
  ASSERT_THAT(world.objects().at(1).pieces, SizeIs(3));
  const std::vector<Transform> pieces = world.WorldFromPieces(1, 0);
  ASSERT_THAT(pieces, SizeIs(3));
  EXPECT_TRUE(pieces[0].isApprox(world.WorldFromObject(1, 0), 1e-15));
  const double half_m = 0.5 * MeasuresOf(TypeNamed("flat_wagon")).pivot_distance_m;
  const Eigen::Matrix3d body_from_front = pieces[0].linear().transpose() * pieces[1].linear();
  EXPECT_NEAR(std::asin(body_from_front(1, 0)), std::asin(half_m / kArcRadius_m), 1e-6);
  // Body, front bogie and rear bogie are all of the vehicle.
  std::size_t num_triangles = 0;
  for (const auto& piece : world.objects()[1].pieces) num_triangles += piece->num_triangles();
  EXPECT_EQ(num_triangles, world.objects()[1].model->num_triangles());
}

TEST(Trains, RunAsOne) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains[0].motion = MotionSpec{.profile = {{0.0, std::nullopt, 10.0}}};
  const RailWorld world = WorldOf(spec);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(world.objects()[i].moves);
    EXPECT_THAT(world.objects()[i].pieces, SizeIs(3));
    EXPECT_NEAR(world.ObjectChainage_m(i, 3 * kNsPerS) - world.ObjectChainage_m(i, 0), 30.0, 1e-9);
  }
}

TEST(Trains, FaceFallingChainageInReverse) {
  WorldSpec spec = LineWithTrain("main", 100.0);
  spec.trains[0].motion = MotionSpec{.profile = {{0.0, std::nullopt, 10.0}}, .reverse = true};
  const RailWorld world = WorldOf(spec);
  EXPECT_NEAR(world.ObjectChainage_m(0, 0), 108.0, 1e-9);
  EXPECT_NEAR(world.ObjectChainage_m(2, 0), 100.0 + 16.0 + 19.74 + 7.02, 1e-9);
  EXPECT_NEAR(world.ObjectChainage_m(2, kNsPerS), 90.0 + 16.0 + 19.74 + 7.02, 1e-9);
  EXPECT_NEAR(world.WorldFromObject(0, 0).linear()(0, 0), -1.0, 1e-12);
  EXPECT_NEAR(world.WorldFromObject(2, 0).linear()(0, 0), 1.0, 1e-12);
}

TEST(Trains, MustBeOnTheirTracks) {
  EXPECT_EQ(
      TrainFaultOf(LineWithTrain("main", 40.0)),
      "/world/trains/0/s_m: must leave room for the train's 49.78 m on track \"main\", from 0 "
      "to 700 m (got 40)");
  EXPECT_EQ(TrainFaultOf(LineWithTrain("main", 701.0)),
            "/world/trains/0/s_m: must lie on track \"main\", from 0 to 700 m (got 701)");
  EXPECT_EQ(TrainFaultOf(LineWithTrain("third", 300.0)),
            "/world/trains/0/track: must be one of \"main\", \"second\" (got \"third\")");
  WorldSpec spec = LineWithTrain("main", 300.0);
  spec.trains[0].vehicles.resize(50, {TypeNamed("flat_wagon"), {}, false});
  EXPECT_EQ(TrainFaultOf(spec),
            "/world/trains/0/vehicles: must be at most as long together as track \"main\", 700 m "
            "(got 977.56 m)");
  spec = LineWithTrain("main", 40.0);
  spec.trains[0].motion = MotionSpec{.profile = {{0.0, std::nullopt, 10.0}}, .reverse = true};
  EXPECT_EQ(TrainFaultOf(spec), "no error");
}

// Those of an open wagon are 9 m apart.
TEST(Trains, HavePivotsThatFitIntoTheirCurves) {
  WorldSpec spec = LineWithTrain("main", 300.0);
  spec.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 700.0, 12.0}}};
  spec.terrain.half_width_m = 5.0;
  spec.tracks.pop_back();
  spec.trains[0].vehicles = {{TypeNamed("open_wagon"), {}, false},
                             {TypeNamed("flat_wagon"), {}, false}};
  const ObjectSpec coach = ObjectAt("coach", TypeNamed("coach"), 400.0);
  spec.objects = {coach};
  VehicleSpec vehicle;
  vehicle.pivot_distance_m = 13.0;
  EXPECT_EQ(TrainFaultOf(spec, vehicle),
            "/world/objects/0/type: must have pivots at most its track's tightest radius of 12 m "
            "apart (got \"coach\" with 19 m)\n"
            "/world/trains/0/vehicles/1/type: must have pivots at most its track's tightest radius "
            "of 12 m apart (got \"flat_wagon\" with 14.2 m)\n"
            "/vehicle/pivot_distance_m: must be at most its track's tightest radius of 12 m (got "
            "13)");
}

TEST(Trains, ConsistOfRailVehiclesWithNamesOfTheirOwn) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.objects = {BoxNamed("freight/3"), BoxNamed("container")};
  spec.trains[0].vehicles[0].type = ObjectType::kPerson;
  EXPECT_EQ(TrainFaultOf(spec),
            "/world/trains/0/vehicles/0/type: must be a vehicle that runs on rails (got "
            "\"person\")\n"
            "/world/trains/0/vehicles/1/name: must be unique (got \"container\")\n"
            "/world/trains/0/vehicles/2/name: must be unique (got \"freight/3\")");
  spec = LineWithTrain("main", 250.0);
  spec.trains[0].vehicles.clear();
  EXPECT_EQ(TrainFaultOf(spec),
            "/world/trains/0/vehicles: must have at least one vehicle (got none)");
}

TEST(Trains, LoseNoSingleVehicle) {
  const RailWorld world = WorldOf(LineWithTrain("main", 250.0));
  EXPECT_EQ(MessageOf([&] { static_cast<void>(world.WithoutObject("container")); }),
            "/name: must not be a vehicle of a train (got \"container\")");
}

/// A locomotive-like flat wagon that carries the sensor, between a tank wagon ahead and an open
/// wagon behind.
VehicleSpec OwnTrain() {
  VehicleSpec vehicle;
  vehicle.start_s_m = 450.0;
  vehicle.consist = {{TypeNamed("tank_wagon"), {}, false},
                     {TypeNamed("flat_wagon"), {}, false},
                     {TypeNamed("open_wagon"), {}, false}};
  vehicle.sensor_vehicle = 1;
  return vehicle;
}

TEST(OwnTrain, ConsistsOfItsVehicles) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains.clear();
  const RailWorld world = WorldOf(spec, OwnTrain());
  std::vector<std::string> named;
  for (const SceneObject& object : world.objects()) {
    named.push_back(object.name + " " + std::to_string(object.instance));
    EXPECT_TRUE(object.is_ego);
    EXPECT_THAT(object.pieces, SizeIs(3));
  }
  EXPECT_THAT(named, ElementsAre("ego/1 1", "ego 2", "ego/3 3"));
  // The vehicle's origin is at the front pivot: 14.2 m apart, of 19.74 m over buffers.
  const Transform world_from_vehicle = world.WorldFromVehicle(0);
  EXPECT_TRUE(world_from_vehicle.isApprox(world.WorldFromObject(1, 0), 1e-15));
  EXPECT_TRUE(world_from_vehicle.translation().isApprox(
      world.alignment().WorldFromTrack(450.0).translation(), 1e-12));
  const Eigen::AlignedBox3d box_m = world.objects()[1].model->Bounds();
  EXPECT_NEAR(box_m.max().x(), 0.5 * (19.74 - 14.2), 1e-5);
  EXPECT_NEAR(box_m.min().x(), -14.2 - 0.5 * (19.74 - 14.2), 1e-5);
  EXPECT_NEAR(world.ObjectChainage_m(0, 0), 450.0 + 0.5 * (19.74 - 14.2) + 8.0, 1e-3);
  EXPECT_NEAR(world.ObjectChainage_m(2, 0), 450.0 - 14.2 - 0.5 * (19.74 - 14.2) - 7.02, 1e-3);
}

// Rear bogie of the vehicle with the sensor: on the track, with the track's tangent.
TEST(OwnTrain, HasItsBogiesOnTheTrack) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains.clear();
  const RailWorld world = WorldOf(spec, OwnTrain());
  const std::vector<Transform> pieces = world.WorldFromPieces(1, 0);
  EXPECT_TRUE(pieces[0].isApprox(world.WorldFromVehicle(0), 1e-15));
  EXPECT_TRUE(pieces[1].isApprox(world.alignment().WorldFromTrack(450.0), 1e-12));
  const Vector3 centre = world.alignment().WorldFromTrack(450.0) * Vector3(0, kArcRadius_m, 0);
  EXPECT_NEAR((pieces[2].translation() - centre).norm(), kArcRadius_m, 1e-6);
  EXPECT_TRUE(pieces[2].translation().isApprox(pieces[0] * Vector3(-14.2, 0, 0), 1e-12));
}

TEST(OwnTrain, FollowsCommands) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains.clear();
  const RailWorld world = WorldOf(spec, OwnTrain());
  for (const SceneObject& object : world.objects()) EXPECT_FALSE(object.moves);
  const auto going = world.WithVehicleSpeed(kNsPerS, 5.0, 1.0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(going->objects()[i].moves);
    EXPECT_NEAR(going->ObjectChainage_m(i, 7 * kNsPerS) - world.ObjectChainage_m(i, 0), 17.5, 1e-9);
  }
}

TEST(OwnTrain, ShakesItsBodyButNotItsBogies) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains.clear();
  VehicleSpec vehicle = OwnTrain();
  vehicle.motion.profile = {{0.0, std::nullopt, 20.0}};
  const RailWorld smooth = WorldOf(spec, vehicle);
  vehicle.ride = RideSpec{TrackQuality::kPoor};
  const RailWorld shaken = WorldOf(spec, vehicle);
  const std::int64_t time_ns = 2 * kNsPerS;
  const double moved_m = (shaken.WorldFromVehicle(time_ns).translation() -
                          smooth.WorldFromVehicle(time_ns).translation())
                             .norm();
  // Standard deviations are some 5 mm.
  EXPECT_GT(moved_m, 1e-4);
  EXPECT_LT(moved_m, 0.03);
  const std::vector<Transform> pieces = shaken.WorldFromPieces(1, time_ns);
  EXPECT_TRUE(pieces[0].isApprox(shaken.WorldFromVehicle(time_ns), 1e-15));
  EXPECT_TRUE(pieces[0].isApprox(shaken.WorldFromObject(1, time_ns), 1e-15));
  EXPECT_TRUE(pieces[1].isApprox(smooth.WorldFromPieces(1, time_ns)[1], 1e-15));
  EXPECT_TRUE(pieces[2].isApprox(smooth.WorldFromPieces(1, time_ns)[2], 1e-15));
  // Other vehicles keep to the track.
  EXPECT_TRUE(
      shaken.WorldFromObject(0, time_ns).isApprox(smooth.WorldFromObject(0, time_ns), 1e-15));
  vehicle.consist.clear();
  vehicle.sensor_vehicle = 0;
  vehicle.pivot_distance_m = 0.0;
  EXPECT_EQ(TrainFaultOf(spec, vehicle),
            "/vehicle/ride: must be absent: without pivots there is no body on springs (got "
            "pivot_distance_m 0)");
}

// From front to rear 16, 19.74 and 14.04 m; the front pivot of the second is 18.77 m behind the
// foremost buffers.
TEST(OwnTrain, MustBeOnItsTrack) {
  const auto fault_at = [](double start_s_m, bool reverse) {
    WorldSpec spec = LineWithTrain("main", 250.0);
    spec.trains.clear();
    VehicleSpec vehicle = OwnTrain();
    vehicle.start_s_m = start_s_m;
    vehicle.motion.reverse = reverse;
    return TrainFaultOf(spec, vehicle);
  };
  const auto rule = [](const std::string& got) {
    return "/vehicle/start_s_m: must leave room for the train's 49.78 m on track \"main\", from 0 "
           "to 700 m (got " +
           got + ")";
  };
  EXPECT_EQ(fault_at(31.1, false), "no error");
  EXPECT_EQ(fault_at(30.9, false), rule("30.9"));
  EXPECT_EQ(fault_at(681.2, false), "no error");
  EXPECT_EQ(fault_at(681.3, false), rule("681.3"));
  EXPECT_EQ(fault_at(18.7, true), rule("18.7"));
  EXPECT_EQ(fault_at(18.8, true), "no error");
}

TEST(OwnTrain, NamesItsFaults) {
  WorldSpec spec = LineWithTrain("main", 250.0);
  spec.trains.clear();
  VehicleSpec vehicle = OwnTrain();
  vehicle.consist[0].type = ObjectType::kBox;
  vehicle.sensor_vehicle = 3;
  spec.objects = {BoxNamed("ego/3")};
  EXPECT_EQ(TrainFaultOf(spec, vehicle),
            "/vehicle/consist/0/type: must be a vehicle that runs on rails (got \"box\")\n"
            "/world/objects/0/name: must be unique (got \"ego/3\")");
  VehicleSpec short_train = OwnTrain();
  short_train.sensor_vehicle = 3;
  EXPECT_EQ(TrainFaultOf(LineWithTrain("main", 250.0), short_train),
            "/vehicle/sensor_vehicle: must be the index of a vehicle in consist (got 3)");
}

}  // namespace
}  // namespace railcast
