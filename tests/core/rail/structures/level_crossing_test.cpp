#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/crossing_road.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "railcast/rail_world.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Chords may be 1 mm from their arcs; the coordinates of chunks are float32.
constexpr double kRoadChord_m = 1e-3 + 1e-5;

LevelCrossingSpec Crossing() {
  return CrossingAt(122.0);
}

WorldSpec TwoTracksWith(const LevelCrossingSpec& crossing) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.tracks.push_back({.name = "second", .offset_m = 4.0});
  spec.structures = {crossing};
  return spec;
}

TEST(LevelCrossing, LaysItsSlabInThePlaneOfTheRailsWithAFlangewayAtEach) {
  const StructureProbe probe(TwoTracksWith(Crossing()));
  const SurfaceClass& slab = probe.line().surfaces().structures.lineside.slab;
  const auto section = probe.CantedSectionOf(slab, 120.3);
  ASSERT_FALSE(section.empty());
  for (const Eigen::Vector2d& point : section) {
    if (std::abs(point.x()) > 1.7) continue;  // The other track.
    EXPECT_LE(point.y(), kRoadChord_m);
    // From 60 mm inside of the gauge face to the outside of the head, only the flangeway's floor.
    const bool is_at_rail =
        std::abs(point.x()) > 0.6575 + kRoadChord_m && std::abs(point.x()) < 0.79;
    if (is_at_rail) {
      EXPECT_LE(point.y(), -0.08 + kRoadChord_m);
    }
  }
  EXPECT_TRUE(probe.SectionOf(slab, 118.9).empty());
  EXPECT_FALSE(probe.SectionOf(slab, 119.1).empty());
  EXPECT_FALSE(probe.SectionOf(slab, 124.9).empty());
  EXPECT_TRUE(probe.SectionOf(slab, 125.1).empty());
}

TEST(LevelCrossing, JoinsTheSlabsOfNeighbouringTracksWithoutAGap) {
  const StructureProbe probe(TwoTracksWith(Crossing()));
  const LinesideSurfaces& surfaces = probe.line().surfaces().structures.lineside;
  const auto asphalt = probe.SectionOf(surfaces.asphalt, 122.4);
  for (const double edge_m : {-1.6, 1.6, 2.4, 5.6}) {
    const auto slab = probe.SectionOf(surfaces.slab, 122.4);
    const auto distance_m = [&](const auto& points) {
      double nearest_m = 1.0;
      for (const auto& point : points) {
        // Cant moves the edges by less than 20 mm in plan.
        nearest_m = std::min(nearest_m, std::abs(point.x() - edge_m));
      }
      return nearest_m;
    };
    EXPECT_LT(distance_m(asphalt), 0.02) << edge_m;
    EXPECT_LT(distance_m(slab), 0.02) << edge_m;
  }
}

TEST(LevelCrossing, ShowsNothingButItsRoadAndTheRailsFromAbove) {
  WorldSpec spec = TwoTracksWith(Crossing());
  const StructureProbe probe(spec);
  const RailSurfaces& surfaces = probe.line().surfaces();
  const LinesideSurfaces& lineside = surfaces.structures.lineside;
  int num_road = 0;
  for (double d_m = -19.5; d_m < 20.0; d_m += 0.53) {
    for (const double s_m : {119.2, 121.1, 122.7, 124.8}) {
      const std::uint32_t label = probe.LabelSeen({s_m, d_m, 4.0}, {s_m, d_m, -3.0});
      EXPECT_TRUE(label == lineside.slab.label || label == surfaces.rail_head.label ||
                  label == surfaces.cantilever.label || label == surfaces.fastening.label ||
                  label == lineside.barrier_red.label)
          << label << " at " << s_m << ", " << d_m;
      num_road += label == lineside.slab.label ? 1 : 0;
    }
  }
  EXPECT_GT(num_road, 270);  // Of 300; the others meet rails, flangeways and booms.
}

TEST(LevelCrossing, ComesDownToTheGroundWithinItsLength) {
  const WorldSpec spec = TwoTracksWith(Crossing());
  const TestLine line(spec);
  const ChunkContext context = line.Context(2);
  const CrossingRoad road(context, Crossing());
  for (const double d_m : {-19.0, -17.5, 21.0 - 1.5}) {
    double mean_m = 0.0;
    for (int i = 0; i < 50; ++i) {
      mean_m += GroundPoint(context, 119.1 + 0.118 * i, d_m).z() / 50.0;
    }
    // 0.1 m above the mean, which 15 samples estimate: three times 0.04 m / sqrt(15).
    EXPECT_NEAR(road.PointAt(122.0, d_m).z(), mean_m + 0.1, 0.04) << d_m;
  }
  // Level with the rails for 3 m beyond the slab.
  const double edge_m = road.PanelEdge(road.lanes().front(), -1.0, 122.0).z();
  EXPECT_NEAR(road.PointAt(122.0, -4.5).z(), edge_m, 1e-9);
}

TEST(LevelCrossing, HoldsTheGroundBelowItsRoad) {
  WorldSpec spec = TwoTracksWith(Crossing());
  spec.terrain.roughness_sigma_m = 0.1;
  const TestLine line(spec);
  for (const bool is_coarse : {false, true}) {
    Chunk chunk = line.Build(2, is_coarse);
    const ChunkContext context = line.Context(2);
    const CrossingRoad road(context, Crossing());
    const Transform axis_from_chunk =
        (context.chunk_from_world * line.alignment().WorldFromTrack(122.0)).inverse();
    for (const Eigen::Vector3f& vertex : MeshOfSurface(chunk, line.surfaces().ground).vertices) {
      const Vector3 place = axis_from_chunk * vertex.cast<double>();
      const double s_m = 122.0 + place.x();
      // The road is 3 m wide to either side, less by d / R inside the curve: no shoulders here.
      if (std::abs(place.x()) > 2.8 || std::abs(place.y()) > 15.0) continue;
      EXPECT_LT(vertex.z(), road.PointAt(s_m, place.y()).z() - 0.05) << place.transpose();
    }
  }
}

TEST(LevelCrossing, ClosesTheRightHalfOfTheRoadToEitherSide) {
  LevelCrossingSpec crossing = Crossing();
  WorldSpec spec = TwoTracksWith(crossing);
  const StructureProbe closed(spec);
  const LinesideSurfaces& surfaces = closed.line().surfaces().structures.lineside;
  const std::uint32_t label = surfaces.barrier_red.label;
  // 0.95 m above the slab's edges, which cant of 0.1 moves by 0.16 m.
  constexpr double kLeftBoom_m = 0.95 - 0.16;
  constexpr double kRightBoom_m = 0.95 + 0.16;
  // From the left, traffic keeps to lower chainages; the outer track's axis is at 4 m.
  EXPECT_EQ(closed.LabelSeen({120.5, 14.0, 1.0}, {120.5, 7.8, kLeftBoom_m}), label);
  EXPECT_NE(closed.LabelSeen({123.5, 14.0, 1.0}, {123.5, 7.8, kLeftBoom_m}), label);
  EXPECT_EQ(closed.LabelSeen({123.5, -12.0, 1.0}, {123.5, -3.8, kRightBoom_m}), label);
  EXPECT_NE(closed.LabelSeen({120.5, -12.0, 1.0}, {120.5, -3.8, kRightBoom_m}), label);
  crossing.barriers = BarrierState::kOpen;
  const StructureProbe open(TwoTracksWith(crossing));
  EXPECT_NE(open.LabelSeen({120.5, 14.0, 1.0}, {120.5, 7.8, kLeftBoom_m}), label);
  crossing.barrier_angle_deg = 0.0;
  const StructureProbe moving(TwoTracksWith(crossing));
  EXPECT_EQ(moving.LabelSeen({120.5, 14.0, 1.0}, {120.5, 7.8, kLeftBoom_m}), label);
}

TEST(LevelCrossing, ShowsItsCrossToDriversFromBothSides) {
  const StructureProbe probe(TwoTracksWith(Crossing()));
  const std::uint32_t label = probe.line().surfaces().structures.lineside.barrier_white.label;
  const auto sees = [&](double from_d_m, double s_m, double d_m) {
    const Vector3 eye(s_m, from_d_m, 3.2);
    const Vector3 cross(s_m, d_m, 3.4);
    return probe.LabelSeen(eye, cross) == label;
  };
  EXPECT_TRUE(sees(20.0, 117.8, 8.6));
  EXPECT_TRUE(sees(-15.0, 126.2, -4.6));
  EXPECT_FALSE(sees(20.0, 126.2, 8.6));
}

TEST(LevelCrossing, CarriesPersonsOnItsRoad) {
  const WorldSpec spec = TwoTracksWith(Crossing());
  const TestLine line(spec);
  const ChunkContext context = line.Context(2);
  const Eigen::AlignedBox2d feet(Eigen::Vector2d(-0.1, -0.1), Eigen::Vector2d(0.1, 0.1));
  const double world_m = line.alignment().At(122.0).position_m.z();
  EXPECT_NEAR(StandingHeight_m(context, {122.0, 0.0, 0.0, feet}), world_m, 0.02);
  EXPECT_LT(StandingHeight_m(context, {128.0, 0.0, 0.0, feet}), world_m - 0.15);
}

TEST(LevelCrossing, KeepsPlantsAndMastsOffItsRoad) {
  const WorldSpec spec = TwoTracksWith(Crossing());
  for (const Clearing what : {Clearing::kTree, Clearing::kGrass, Clearing::kMast}) {
    EXPECT_TRUE(IsCleared(spec, 122.0, 15.0, what));
    EXPECT_TRUE(IsCleared(spec, 119.5, -15.0, what));
    EXPECT_FALSE(IsCleared(spec, 130.0, 15.0, what));
  }
}

TEST(LevelCrossing, TakesFewHundredTriangles) {
  const TestLine line(TwoTracksWith(Crossing()));
  Chunk chunk;
  AddStructures(line.Context(2), chunk);
  EXPECT_LT(chunk.ground.num_triangles(), 1600U);
  EXPECT_EQ(chunk.placements.size(), 0U);
}

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
