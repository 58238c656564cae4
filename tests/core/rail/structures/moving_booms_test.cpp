#include "core/rail/structures/structures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/structures/lineside_models.h"
#include "railcast/rail_world.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// A road 6 m wide whose barriers close from 2 s to 8 s.
LevelCrossingSpec ClosingCrossing() {
  LevelCrossingSpec crossing = CrossingAt(122.0);
  crossing.barrier_angles_deg = {{2.0, 90.0}, {8.0, 0.0}};
  return crossing;
}

WorldSpec LineWith(const LevelCrossingSpec& crossing) {
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {crossing};
  return spec;
}

/// The boom is 3.5 m long, from a pedestal 0.5 m beside the road and 4 m from the axis; its axis is
/// 0.95 m above the road, which is level there.
Vector3 TipAt(double angle_rad, double side) {
  const Vector3 axis(122.0 - side * 3.5, side * 4.0, 0.95);
  const double length_m = 3.5;
  // The boom runs 0.20 m before its pedestal, towards the track.
  return axis + Vector3(side * length_m * std::cos(angle_rad), -side * 0.20,
                        length_m * std::sin(angle_rad));
}

TEST(MovingBoom, HasItsTipWhereTheAngleOfThatTimePutsIt) {
  const TestLine line(LineWith(ClosingCrossing()));
  const std::vector<MovingBoom> booms = MovingBoomsOf(line.Context(2), ClosingCrossing());
  ASSERT_EQ(booms.size(), 2U);
  for (const auto& [time_ns, angle_deg] :
       {std::pair(0 * kNsPerS, 90.0), std::pair(2 * kNsPerS, 90.0), std::pair(4 * kNsPerS, 60.0),
        std::pair(7'500'000'000L, 7.5), std::pair(8 * kNsPerS, 0.0),
        std::pair(99 * kNsPerS, 0.0)}) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector3 tip = booms[i].WorldFromBoom(time_ns) * Vector3(3.5, -0.20, 0.0);
      const double side = i == 0 ? -1.0 : 1.0;
      EXPECT_LT((tip - TipAt(RadFromDeg(angle_deg), side)).norm(), 1e-9) << time_ns << " " << side;
    }
  }
  // The model reaches as far, and lies as a closed boom does.
  const Eigen::AlignedBox3d box_m = booms[0].model->Bounds();
  EXPECT_NEAR(box_m.max().x(), 3.5, 1e-6);
  EXPECT_LT(box_m.max().z(), 0.13);
}

TEST(MovingBoom, StandsWhereAStandingBarrierOfThatAngleHasIt) {
  LevelCrossingSpec standing = ClosingCrossing();
  standing.barrier_angles_deg.clear();
  standing.barrier_angle_deg = 60.0;
  const StructureProbe probe(LineWith(standing));
  // 2 m along the boom, in the fourth stripe of 0.58 m.
  const SurfaceClass& white = probe.line().surfaces().structures.lineside.barrier_white;
  const auto section = probe.SectionOf(white, 119.5);
  ASSERT_FALSE(section.empty());
  // 1 m from its axis, the middle of the boom is tan(60 deg) m higher.
  EXPECT_NEAR(0.5 * (LeastOf(section, 1) + MostOf(section, 1)), 0.95 + std::sqrt(3.0), 1e-3);
  const StructureProbe moving(LineWith(ClosingCrossing()));
  EXPECT_TRUE(moving.SectionOf(white, 119.5).empty());
}

RailWorld WorldOf(const WorldSpec& spec, bool has_ego) {
  VehicleSpec vehicle;
  vehicle.start_s_m = 30.0;
  if (has_ego) vehicle.ego_boxes_m = {{-18.0, -1.45, 0.3, 2.0, 1.45, 3.9}};
  return RailWorld(spec, vehicle, RailLabels(), RailMaterials(), 7);
}

TEST(MovingBoom, IsAnObjectOfTheWorldAfterAllOthers) {
  WorldSpec spec = LineWith(ClosingCrossing());
  const ObjectSpec person = ObjectAt("person", ObjectType::kPerson, 80.0, 3.0);
  spec.objects = {person};
  const RailWorld world = WorldOf(spec, true);
  ASSERT_EQ(world.objects().size(), 4U);
  EXPECT_EQ(world.objects()[1].name, "ego");
  EXPECT_EQ(world.objects()[2].name, "crossing/right");
  EXPECT_EQ(world.objects()[3].name, "crossing/left");
  for (std::size_t i = 2; i < 4; ++i) {
    EXPECT_EQ(world.objects()[i].instance, i + 1);
    EXPECT_EQ(world.objects()[i].label, RailLabels().Id("level_crossing"));
    EXPECT_TRUE(world.objects()[i].moves);
    EXPECT_EQ(world.object_track(i).name, "main");
    EXPECT_EQ(world.ObjectChainage_m(i, 5 * kNsPerS), 122.0);
  }
  const Vector3 tip = world.WorldFromObject(3, 4 * kNsPerS) * Vector3(3.5, -0.20, 0.0);
  EXPECT_LT((tip - TipAt(RadFromDeg(60.0), 1.0)).norm(), 1e-9);
  EXPECT_THROW((void)world.WithoutObject("crossing/left"), InputError);
  EXPECT_EQ(world.WithoutObject("person")->objects().size(), 3U);
}

TEST(MovingBoom, StandsStillWithoutAnglesOverTime) {
  LevelCrossingSpec crossing = ClosingCrossing();
  crossing.barrier_angles_deg.clear();
  EXPECT_TRUE(WorldOf(LineWith(crossing), false).objects().empty());
}

}  // namespace
}  // namespace railcast
