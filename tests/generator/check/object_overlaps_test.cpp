#include "generator/check/object_overlaps.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/scene/shapes.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Returns a cube that extends `half_size_m` from its centre to each side.
std::shared_ptr<const Model> Cube(double half_size_m = 0.5) {
  const Vector3 corner_m = Vector3::Constant(half_size_m);
  return std::make_shared<const Model>(Model{"cube", {{MakeBox({-corner_m, corner_m}), 1, 9}}});
}

std::shared_ptr<const Model> Ball(double radius_m) {
  return std::make_shared<const Model>(Model{"ball", {{MakeSphere(radius_m, 60, 60), 1, 9}}});
}

Transform At(double x_m, double y_m, double z_m) {
  return MakeTransform(Eigen::Matrix3d::Identity(), {x_m, y_m, z_m});
}

std::vector<ObjectOverlap> OverlapsOf(const std::shared_ptr<const Model>& one,
                                      const std::shared_ptr<const Model>& other,
                                      const Transform& one_from_other) {
  SimpleWorld world;
  // Coordinates as large as in a national grid.
  world.world_from_chunk = At(2'600'000.0, 1'200'000.0, 450.0);
  world.AddObject(one, Transform::Identity());
  world.AddObject(other, one_from_other);
  return FindOverlaps(world, 0);
}

const std::vector<ObjectOverlap> none;
const std::vector<ObjectOverlap> cut{{0, 1, false}};

TEST(ObjectOverlaps, BoxesOverlapFromACentimetreOn) {
  EXPECT_EQ(OverlapsOf(Cube(), Cube(), At(0.98, 0.0, 0.0)), cut);
  EXPECT_EQ(OverlapsOf(Cube(), Cube(), At(0.98, 0.3, 0.3)), cut);
  EXPECT_EQ(OverlapsOf(Cube(), Cube(), At(1.02, 0.0, 0.0)), none);
}

TEST(ObjectOverlaps, WhatStandsOnSomethingOnlyTouches) {
  EXPECT_EQ(OverlapsOf(Cube(), Cube(), At(0.0, 0.0, 1.0)), none);
  EXPECT_EQ(OverlapsOf(Cube(2.0), Cube(), At(0.3, -0.7, 2.5)), none);
  EXPECT_EQ(OverlapsOf(Cube(2.0), Cube(), At(0.3, -0.7, 2.48)), cut);
}

TEST(ObjectOverlaps, BoxesAroundThemMayOverlapWhereTheyDoNot) {
  // Diagonally across the corner of their boxes, the centres of two balls of 1 m radius are 2.4 m
  // apart.
  EXPECT_EQ(OverlapsOf(Ball(1.0), Ball(1.0), At(1.7, 1.7, 0.0)), none);
  EXPECT_EQ(OverlapsOf(Ball(1.0), Ball(1.0), At(1.3, 1.3, 0.0)), cut);
}

TEST(ObjectOverlaps, EdgesOfEitherMayCutTheFacesOfTheOther) {
  // A beam passes through the middle of a cube's faces, so the cube's edges meet nothing.
  const auto beam = std::make_shared<const Model>(
      Model{"beam", {{MakeBox({Vector3(-3.0, -0.1, -0.1), Vector3(3.0, 0.1, 0.1)}), 1, 9}}});
  EXPECT_EQ(OverlapsOf(Cube(), beam, Transform::Identity()), cut);
  EXPECT_EQ(OverlapsOf(beam, Cube(), Transform::Identity()), cut);
}

TEST(ObjectOverlaps, FindsWhatIsInsideAnother) {
  EXPECT_EQ(OverlapsOf(Ball(1.5), Cube(), Transform::Identity()),
            (std::vector<ObjectOverlap>{{1, 0, true}}));
  EXPECT_EQ(OverlapsOf(Cube(), Ball(1.5), Transform::Identity()),
            (std::vector<ObjectOverlap>{{0, 1, true}}));
}

TEST(ObjectOverlaps, AnOpenTroughDoesNotEncloseItsLoad) {
  Mesh trough = MakeFloor(-1.0F, 2.0F);
  for (int side = 0; side < 4; ++side) {
    trough.Append(MakeWall(2.0F, 2.0F),
                  Transform(Eigen::AngleAxisd(0.5 * std::numbers::pi * side, Vector3::UnitZ())));
  }
  const auto model = std::make_shared<const Model>(Model{"trough", {{trough, 1, 9}}});
  EXPECT_EQ(OverlapsOf(model, Cube(), Transform::Identity()), none);
  // The cube stands on the floor.
  EXPECT_EQ(OverlapsOf(model, Cube(), At(0.3, 0.2, -0.5)), none);
  EXPECT_EQ(OverlapsOf(Cube(), model, At(-0.3, -0.2, 0.5)), none);
  EXPECT_EQ(OverlapsOf(model, Cube(), At(0.3, 0.2, -0.52)), cut);
}

TEST(ObjectOverlaps, FindsEveryPairOnceAtItsMoment) {
  SimpleWorld world;
  world.AddObject(Cube(), At(50.0, 0.0, 0.0), Vector3(-10.0, 0.0, 0.0));
  world.AddObject(Cube(), At(0.2, 0.0, 0.0));
  world.AddObject(Cube(), At(0.9, 0.0, 0.0));
  EXPECT_EQ(FindOverlaps(world, 0), (std::vector<ObjectOverlap>{{1, 2, false}}));
  constexpr std::int64_t kMet_ns = 5'000'000'000;
  EXPECT_EQ(FindOverlaps(world, kMet_ns),
            (std::vector<ObjectOverlap>{{0, 1, false}, {0, 2, false}, {1, 2, false}}));
}

}  // namespace
}  // namespace railcast
