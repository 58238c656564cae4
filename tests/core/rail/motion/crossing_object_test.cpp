#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>

#include "core/rail/objects/object_models.h"
#include "core/rail/objects/person.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

std::int64_t Ns(double time_s) {
  return std::llround(time_s * 1e9);
}

// A person 6 m right of a straight track, who crosses it at 2 m/s, reached with 2 m/s^2.
ObjectSpec Crosser() {
  ObjectSpec person = ObjectAt("walker", ObjectType::kPerson, 100.0, -6.0);
  PathSpec path;
  path.points.emplace_back();
  path.points.back().s_m = 100.0;
  path.points.back().d_m = 6.0;
  path.speed_mps = 2.0;
  path.acceleration_mps2 = 2.0;
  person.motion.emplace();
  person.motion->path = path;
  return person;
}

class CrossingObjects : public testing::Test {
 protected:
  CrossingObjects() {
    world_.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 600.0, {}}}};
    vehicle_.start_s_m = 20.0;
    vehicle_.motion.profile = {{0.0, std::nullopt, 10.0}};
  }
  [[nodiscard]] std::shared_ptr<const RailWorld> Make(ObjectSpec object) {
    world_.objects = {std::move(object)};
    return std::make_shared<const RailWorld>(world_, vehicle_, RailLabels(), RailMaterials(), 7);
  }
  /// Where the object is along and left of the track; both as on the map of a line towards east.
  static Eigen::Vector2d PlaceOf(const RailWorld& world, double time_s) {
    const Transform track_from_world = world.alignment().WorldFromTrack(0.0).inverse();
    return (track_from_world * world.WorldFromObject(0, Ns(time_s)).translation()).head<2>();
  }
  static double Heading_rad(const RailWorld& world, double time_s) {
    const Vector3 ahead =
        (world.alignment().WorldFromTrack(0.0).inverse() * world.WorldFromObject(0, Ns(time_s)))
            .linear()
            .col(0);
    return std::atan2(ahead.y(), ahead.x());
  }

  WorldSpec world_;
  VehicleSpec vehicle_;
};

TEST_F(CrossingObjects, WalkAcrossTheTrackFacingWhereTheyGo) {
  const auto world = Make(Crosser());
  EXPECT_TRUE(world->objects().front().moves);
  EXPECT_LT((PlaceOf(*world, 0.0) - Eigen::Vector2d(100.0, -6.0)).norm(), 1e-9);
  // 1 m in the first second, then 2 m/s: on the axis after 3.5 s.
  EXPECT_LT((PlaceOf(*world, 3.5) - Eigen::Vector2d(100.0, 0.0)).norm(), 1e-6);
  EXPECT_LT((PlaceOf(*world, 60.0) - Eigen::Vector2d(100.0, 6.0)).norm(), 1e-6);
  EXPECT_NEAR(Heading_rad(*world, 3.5), 0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(world->ObjectChainage_m(0, Ns(3.5)), 100.0, 1e-6);
}

TEST_F(CrossingObjects, StandOnTheGroundAllTheWay) {
  const auto walking = Make(Crosser());
  for (const double time_s : {0.0, 1.0, 2.0, 3.5, 5.0, 7.0}) {
    const Eigen::Vector2d place_m = PlaceOf(*walking, time_s);
    ObjectSpec standing = Crosser();
    standing.motion.reset();
    standing.d_m = place_m.y();
    standing.heading_deg = 90.0;
    const auto still = Make(standing);
    // Their footprints differ by the length of a stride, and the ground is rough.
    EXPECT_NEAR(walking->WorldFromObject(0, Ns(time_s)).translation().z(),
                still->WorldFromObject(0, 0).translation().z(), 5e-3)
        << time_s;
  }
}

TEST_F(CrossingObjects, SetOffWhenTheVehicleComes) {
  ObjectSpec person = Crosser();
  person.motion->path->start_at_vehicle_s_m = 70.0;  // After 5 s.
  const auto world = Make(person);
  EXPECT_NEAR(PlaceOf(*world, 5.0).y(), -6.0, 1e-9);
  EXPECT_NEAR(PlaceOf(*world, 8.5).y(), 0.0, 1e-6);
}

TEST_F(CrossingObjects, SetOffLaterIfTheVehicleComesLater) {
  ObjectSpec person = Crosser();
  person.motion->path->start_at_vehicle_s_m = 70.0;
  const auto world = Make(person);
  // From 30 m on at 5 m/s, reached at once but for 0.5 s: 37.5 m are covered in 0.5 s.
  const auto slowed = world->WithVehicleSpeed(Ns(1.0), 5.0, 10.0);
  const double trigger_s = 1.5 + (70.0 - 33.75) / 5.0;
  EXPECT_NEAR(slowed->VehicleChainage_m(Ns(trigger_s)), 70.0, 1e-6);
  EXPECT_NEAR(PlaceOf(*slowed, trigger_s).y(), -6.0, 1e-6);
  EXPECT_NEAR(PlaceOf(*slowed, trigger_s + 3.5).y(), 0.0, 1e-5);
  // Who walks already does not care.
  const auto slowed_later = world->WithVehicleSpeed(Ns(6.0), 5.0, 10.0);
  EXPECT_NEAR(PlaceOf(*slowed_later, 8.5).y(), 0.0, 1e-6);
  // Before a vehicle that stops short, nobody sets off.
  const auto stopped = world->WithVehicleSpeed(Ns(1.0), 0.0, 5.0);
  EXPECT_NEAR(PlaceOf(*stopped, 1000.0).y(), -6.0, 1e-9);
}

TEST_F(CrossingObjects, HaveTimesOfTheirOwnWhenAdded) {
  const auto world = Make(Crosser());
  ObjectSpec second = Crosser();
  second.name = "second";
  const auto more = world->WithObject(second, Ns(10.0));
  const Transform world_from_second = more->WorldFromObject(1, Ns(13.5));
  EXPECT_NEAR(
      (more->alignment().WorldFromTrack(100.0).inverse() * world_from_second).translation().y(),
      0.0, 1e-6);
}

TEST_F(CrossingObjects, MoveTheirLimbsByTheDistanceWalked) {
  const ObjectSpec spec = Crosser();
  const auto world = Make(spec);
  const WalkingPerson walker(PersonBuildOf(spec));
  const SceneObject& person = world->objects().front();
  ASSERT_GT(person.pieces.size(), 10U);
  // After 3.5 s the person has walked 6 m and goes at 2 m/s.
  const std::vector<Transform> limbs = world->WorldFromPieces(0, Ns(3.5));
  const std::vector<Transform> expected = walker.ObjectFromPieces(6.0, 2.0);
  ASSERT_EQ(limbs.size(), expected.size());
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    EXPECT_LT(
        (limbs[i].matrix() - (world->WorldFromObject(0, Ns(3.5)) * expected[i]).matrix()).norm(),
        1e-6)
        << i;
  }
}

TEST_F(CrossingObjects, DoNotSlideOnTheFootTheyStandOn) {
  const auto world = Make(Crosser());
  const SceneObject& person = world->objects().front();
  // The lowest point of the person in each moment is on the foot that bears it.
  constexpr double kStep_s = 0.01;
  double slid_m = 0.0;
  double walked_m = 0.0;
  for (double time_s = 2.0; time_s < 5.0; time_s += kStep_s) {
    const std::vector<Transform> now = world->WorldFromPieces(0, Ns(time_s));
    const std::vector<Transform> next = world->WorldFromPieces(0, Ns(time_s + kStep_s));
    Vector3 lowest_m = Vector3::Constant(1e9);
    Vector3 later_m = lowest_m;
    for (std::size_t i = 0; i < now.size(); ++i) {
      for (const Part& part : person.pieces[i]->parts) {
        for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
          const Vector3 place_m = now[i] * vertex.cast<double>();
          if (place_m.z() >= lowest_m.z()) continue;
          lowest_m = place_m;
          later_m = next[i] * vertex.cast<double>();
        }
      }
    }
    slid_m += (later_m - lowest_m).head<2>().norm();
    walked_m += 2.0 * kStep_s;
  }
  EXPECT_LT(slid_m, 0.25 * walked_m);
}

TEST_F(CrossingObjects, LieOnTheSlopeOfTheGroundIfTheyFollowIt) {
  // A plate across the shoulder of the ballast lies on it as the ground falls.
  ObjectSpec plate = ObjectAt("plate", ObjectType::kBox, 100.0, 2.2);
  plate.size_m = {{0.5, 0.5, 0.02}};
  const auto height_m = [&](double d_m) {
    ObjectSpec probe = plate;
    probe.d_m = d_m;
    probe.size_m = {{0.01, 0.01, 0.02}};
    return Make(probe)->WorldFromObject(0, 0).translation().z();
  };
  plate.follow = Follow::kGround;
  const double slope = (height_m(2.45) - height_m(1.95)) / 0.5;
  ASSERT_LT(slope, -0.3);
  const Transform world_from_plate = Make(plate)->WorldFromObject(0, 0);
  const Vector3 left = world_from_plate.linear().col(1);
  EXPECT_NEAR(left.z() / left.head<2>().norm(), slope, 0.05);
  plate.follow = Follow::kUpright;
  EXPECT_NEAR(Make(plate)->WorldFromObject(0, 0).linear().col(2).z(), 1.0, 1e-12);
}

TEST_F(CrossingObjects, LieOnTheGroundEvenIfTheyHaveNoWidth) {
  ObjectSpec plate;
  plate.name = "plate";
  plate.type = ObjectType::kMesh;
  const TemporaryDirectory folder;
  plate.file = (folder.path() / "plate.obj").string();
  std::ofstream(*plate.file) << "v 0 -1 0\nv 0 1 0\nv 0 0 2\nf 1 2 3\n";
  plate.s_m = 100.0;
  plate.follow = Follow::kGround;
  EXPECT_TRUE(Make(plate)->WorldFromObject(0, 0).matrix().allFinite());
}

TEST_F(CrossingObjects, LetARailVehicleThatLeansLieOnTheGround) {
  ObjectSpec wagon = ObjectAt("wagon", TypeNamed("open_wagon"), 100.0, 8.0);
  EXPECT_NEAR(Make(wagon)->WorldFromObject(0, 0).translation().z(), 0.0, 1e-9);
  wagon.roll_deg = 80.0;
  EXPECT_LT(Make(wagon)->WorldFromObject(0, 0).translation().z(), -0.5);
}

TEST_F(CrossingObjects, AreRefusedWhereTheyTurnRoundAtOnce) {
  ObjectSpec person = Crosser();
  person.motion->path->points.push_back(person.motion->path->points.front());
  person.motion->path->points.back().d_m = -2.0;
  EXPECT_EQ(MessageOf([&] { static_cast<void>(Make(person)); }),
            "/world/objects/0/motion/path/points/0: must not lead straight back: let the path "
            "end there and give turns_back");
}

TEST_F(CrossingObjects, FollowTheTracksGradientIfTold) {
  world_.alignment.gradients_permil = {{0.0, 20.0}};
  ObjectSpec cart = ObjectAt("cart", ObjectType::kBox, 300.0);
  cart.size_m = {{2.0, 1.5, 1.0}};
  cart.h_m = 0.0;
  cart.follow = Follow::kTrack;
  const Vector3 ahead = Make(cart)->WorldFromObject(0, 0).linear().col(0);
  EXPECT_NEAR(ahead.z() / ahead.head<2>().norm(), 0.02, 1e-9);
}

}  // namespace
}  // namespace railcast
