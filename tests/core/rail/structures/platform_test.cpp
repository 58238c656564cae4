#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/rail/clearance/cleared.h"
#include "core/rail/structures/standing_height.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/structures.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Chords may be as far from their arcs; the coordinates of chunks are float32.
constexpr double kSweep_m = 1e-3 + 1e-5;

PlatformSpec PlatformOn(TrackSide side) {
  return StructureBeside<PlatformSpec>(side, "platform", 60.0, 190.0);
}

WorldSpec CurveWith(const PlatformSpec& platform) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.structures = {platform};
  return spec;
}

TEST(Platform, HasItsEdgeAtItsDistanceAndHeightInACantedCurve) {
  for (const TrackSide side : {TrackSide::kLeft, TrackSide::kRight}) {
    const StructureProbe probe(CurveWith(PlatformOn(side)));
    const auto& surfaces = probe.line().surfaces().structures;
    for (const double s_m : {61.3, 99.9, 143.7}) {
      const auto section = probe.CantedSectionOf(surfaces.platform, s_m);
      ASSERT_FALSE(section.empty());
      // The corner nearest to where the edge should be.
      // On the outside, the nose's lower corner is that far from the axis.
      const double lean = probe.line().alignment().At(s_m).cant_rad;
      const double back_m = side == TrackSide::kRight ? -0.12 * std::sin(lean) : 0.0;
      const Eigen::Vector2d edge(SignOf(side) * (1.65 + 3.75 / 400.0 + back_m), 0.76);
      double nearest_m = 1.0;
      for (const auto& point : section) nearest_m = std::min(nearest_m, (point - edge).norm());
      EXPECT_LE(nearest_m, kSweep_m) << s_m;
    }
  }
}

/// The platform's edge seen from the axis, in the middle of a straight, a clothoid and an arc.
TEST(Platform, IsFartherFromTheAxisTheTighterTheCurve) {
  for (const auto& [radius_m, side, in_arc_m, half_way_m] :
       {std::tuple(300.0, TrackSide::kLeft, 3.75 / 300.0, 3.75 / 600.0),
        std::tuple(-300.0, TrackSide::kLeft, 3.75 / 300.0, 3.75 / 600.0),
        std::tuple(190.0, TrackSide::kLeft, 50.0 / 190.0 - 0.185, 3.75 / 380.0),
        std::tuple(190.0, TrackSide::kRight, 60.0 / 190.0 - 0.225, 3.75 / 380.0)}) {
    WorldSpec spec = WorldAlong({{ElementType::kStraight, 100.0, {}},
                                 {ElementType::kClothoid, 80.0, {}},
                                 {ElementType::kArc, 120.0, radius_m}});
    PlatformSpec platform = PlatformOn(side);
    platform.end_s_m = 270.0;
    spec.structures = {platform};
    const StructureProbe probe(spec);
    const SurfaceClass& concrete = probe.line().surfaces().structures.platform;
    for (const auto& [s_m, wider_m] : {std::pair(80.3, 0.0), std::pair(140.0, half_way_m),
                                       std::pair(220.4, in_arc_m), std::pair(251.7, in_arc_m)}) {
      const auto section = probe.SectionOf(concrete, s_m);
      const double edge_m = side == TrackSide::kLeft ? LeastOf(section, 0) : -MostOf(section, 0);
      // Chords are measured at the back of the platform, 3 m farther in.
      EXPECT_NEAR(edge_m, 1.65 + wider_m, 1.02 * kSweep_m) << radius_m << " " << s_m;
    }
  }
}

TEST(Platform, IsLevelAcrossAndAsWideAsSpecified) {
  const StructureProbe probe(CurveWith(PlatformOn(TrackSide::kLeft)));
  const auto section = probe.SectionOf(probe.line().surfaces().structures.platform, 120.4);
  const double cant_rad = probe.line().alignment().At(120.4).cant_rad;
  ASSERT_LT(cant_rad, -0.09);
  const double beside_m = 1.65 + 3.75 / 400.0;
  const double edge_m = beside_m * std::cos(cant_rad) - 0.76 * std::sin(cant_rad);
  const double top_m = beside_m * std::sin(cant_rad) + 0.76 * std::cos(cant_rad);
  EXPECT_NEAR(LeastOf(section, 0), edge_m, kSweep_m);
  EXPECT_NEAR(MostOf(section, 0), edge_m + 3.0, kSweep_m);
  EXPECT_NEAR(MostOf(section, 1), top_m, kSweep_m);
}

TEST(Platform, HasRampsDownToTheSleepersAtItsEnds) {
  WorldSpec spec = StraightLine(300.0);
  PlatformSpec platform = PlatformOn(TrackSide::kLeft);
  platform.has_ramps = true;
  spec.structures = {platform};
  const StructureProbe probe(spec);
  const SurfaceClass& concrete = probe.line().surfaces().structures.platform;
  // The ramps are 12 (0.76 + 0.08) = 10.08 m long.
  for (const auto& [from_end_m, height_m] :
       {std::pair(0.01, -0.08 + 0.01 / 12.0), std::pair(6.0, -0.08 + 0.5),
        std::pair(10.0, -0.08 + 10.0 / 12.0), std::pair(10.2, 0.76), std::pair(50.0, 0.76)}) {
    for (const double s_m : {60.0 + from_end_m, 190.0 - from_end_m}) {
      const auto section = probe.SectionOf(concrete, s_m);
      EXPECT_NEAR(MostOf(section, 1), height_m, 1e-5) << s_m;
      EXPECT_NEAR(LeastOf(section, 0), 1.65, 1e-5) << s_m;
    }
  }
  const SurfaceClass& strip = probe.line().surfaces().structures.platform_strip;
  EXPECT_TRUE(probe.SectionOf(strip, 69.0).empty());
  EXPECT_FALSE(probe.SectionOf(strip, 71.0).empty());
}

TEST(Platform, EndsWhereItEnds) {
  const StructureProbe probe(CurveWith(PlatformOn(TrackSide::kLeft)));
  const SurfaceClass& concrete = probe.line().surfaces().structures.platform;
  EXPECT_TRUE(probe.SectionOf(concrete, 59.99).empty());
  EXPECT_FALSE(probe.SectionOf(concrete, 60.01).empty());
  EXPECT_FALSE(probe.SectionOf(concrete, 189.99).empty());
  EXPECT_TRUE(probe.SectionOf(concrete, 190.01).empty());
}

TEST(Platform, HasAStripThatBeginsTwoAndAHalfMetresFromTheAxis) {
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {PlatformOn(TrackSide::kRight)};
  const StructureProbe probe(spec);
  const auto section = probe.SectionOf(probe.line().surfaces().structures.platform_strip, 100.3);
  EXPECT_NEAR(MostOf(section, 0), -2.5, 1e-5);
  EXPECT_NEAR(LeastOf(section, 0), -2.8, 1e-5);
  EXPECT_NEAR(MostOf(section, 1), 0.764, 1e-5);
}

TEST(Platform, IsSeenByBeamsAtItsMiddleAndItsRoof) {
  PlatformSpec platform = PlatformOn(TrackSide::kLeft);
  platform.roof = PlatformRoofSpec{};
  const StructureProbe probe(CurveWith(platform));
  const std::uint32_t label = probe.line().surfaces().structures.platform.label;
  EXPECT_EQ(probe.LabelSeen({120.0, 0.0, 2.5}, {125.0, 3.15, 0.6}), label);
  EXPECT_EQ(probe.LabelSeen({120.0, 0.0, 2.5}, {125.0, 3.15, 4.4}), label);
  EXPECT_NE(probe.LabelSeen({120.0, 0.0, 2.5}, {125.0, -3.15, 0.0}), label);
}

TEST(Platform, CarriesItsRoofOnColumnsNoFartherApartThanSpecified) {
  PlatformSpec platform = PlatformOn(TrackSide::kLeft);
  platform.roof = PlatformRoofSpec{.begin_s_m = 80.0, .end_s_m = 170.0};
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {platform};
  const StructureProbe probe(spec);
  const SurfaceClass& steel = probe.line().surfaces().structures.platform_roof;
  double last_column_m = 80.0;
  int num_columns = 0;
  for (double s_m = 75.05; s_m < 175.0; s_m += 0.1) {
    const auto section = probe.SectionOf(steel, s_m);
    EXPECT_EQ(section.empty(), s_m < 80.0 || s_m > 170.0) << s_m;
    // A column stands on the platform.
    if (section.empty() || LeastOf(section, 1) > 0.8) continue;
    if (s_m - last_column_m > 0.5) ++num_columns;
    EXPECT_LE(s_m - last_column_m, 8.1);
    last_column_m = s_m;
  }
  EXPECT_EQ(num_columns, 12);  // 88 m between the first and the last: 11 gaps of 8 m.
}

TEST(Platform, KeepsPlantsAndMastsOff) {
  const WorldSpec spec = CurveWith(PlatformOn(TrackSide::kLeft));
  for (const Clearing what : {Clearing::kTree, Clearing::kGrass, Clearing::kMast}) {
    EXPECT_TRUE(IsCleared(spec, 100.0, 3.0, what));
    EXPECT_FALSE(IsCleared(spec, 100.0, -3.0, what));
    EXPECT_FALSE(IsCleared(spec, 200.0, 3.0, what));
  }
  EXPECT_FALSE(IsCleared(spec, 100.0, 3.0, Clearing::kBallast));
}

/// Height of the mesh's highest point on the vertical through (x, y); minus infinity if there is
/// none.
double TopAt(const Mesh& mesh, const Transform& world_from_mesh, const Eigen::Vector2d& at_m) {
  double top_m = -std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](int i) -> Vector3 {
      return world_from_mesh * mesh.vertices[triangle[static_cast<std::size_t>(i)]].cast<double>();
    };
    Eigen::Matrix3d corners;
    corners << corner(0), corner(1), corner(2);
    Eigen::Matrix3d plan = corners;
    plan.row(2).setOnes();
    if (std::abs(plan.determinant()) < 1e-9) continue;
    const Vector3 weights = plan.inverse() * Vector3(at_m.x(), at_m.y(), 1.0);
    if (weights.minCoeff() < 0.0) continue;
    top_m = std::max(top_m, corners.row(2).dot(weights));
  }
  return top_m;
}

/// Height of the surfaces that the chunk draws.
double DrawnHeight_m(const TestLine& line, int chunk, const Eigen::Vector2d& at_m) {
  const Chunk built = line.Build(chunk);
  const Transform world_from_chunk = line.WorldFromChunk(chunk);
  return std::max(TopAt(MeshOfSurface(built, line.surfaces().ground), world_from_chunk, at_m),
                  TopAt(MeshOfSurface(built, line.surfaces().ballast), world_from_chunk, at_m));
}

// Tolerances: ballast has grains of sigma 20 mm on a grid of 0.2 m and hollows around sleepers;
// ground roughness has a wavelength of 2 m on a grid of 0.5 m and coarser.
TEST(StandingHeight, IsThatOfTheDrawnSurfaceOnTheTrackBesideItAndInTheField) {
  for (const WorldSpec& spec : {StraightLine(300.0), CantedArc(300.0, 400.0)}) {
    const TestLine line(spec);
    ChunkContext context = line.Context(2);
    context.chunk_from_world = Transform::Identity();
    for (const double d_m : {0.0, 2.0, 2.6, -3.2, 5.0, -9.0, 14.0, 40.0}) {
      const double s_m = 122.3;
      const StandingPlace point{s_m, d_m, 0.0, {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()}};
      const Vector3 place = line.alignment().WorldFromTrack(s_m, d_m).translation();
      EXPECT_NEAR(StandingHeight_m(context, point), DrawnHeight_m(line, 2, place.head<2>()), 0.08)
          << d_m;
    }
  }
}

TEST(StandingHeight, TakesTheLowestCornerOnASlope) {
  const TestLine line(StraightLine(300.0));
  ChunkContext context = line.Context(2);
  context.chunk_from_world = Transform::Identity();
  // Across the ballast's slope of 1:1.5.
  const StandingPlace wide{
      122.3, 2.0, 0.0, {Eigen::Vector2d(-0.1, -0.2), Eigen::Vector2d(0.1, 0.2)}};
  const StandingPlace lower{
      122.3, 2.2, 0.0, {Eigen::Vector2d(-0.1, 0.0), Eigen::Vector2d(0.1, 0.0)}};
  EXPECT_NEAR(StandingHeight_m(context, wide), StandingHeight_m(context, lower), 1e-9);
  // Turned by 90 degrees, it extends as far to the side as it is long.
  StandingPlace turned = wide;
  turned.heading_rad = std::numbers::pi / 2.0;
  EXPECT_GT(StandingHeight_m(context, turned), StandingHeight_m(context, wide) + 0.05);
}

TEST(RailWorld, StandsObjectsOnTheGroundUnlessAHeightIsGiven) {
  WorldSpec spec = StraightLine(300.0);
  for (const double h_m : {0.0, 1.5}) {
    ObjectSpec object =
        ObjectAt(h_m == 0.0 ? "standing" : "hanging", ObjectType::kPerson, 120.0, -8.0);
    if (h_m > 0.0) object.h_m = h_m;
    spec.objects.push_back(object);
  }
  ObjectSpec wagon = spec.objects.front();
  wagon.name = "wagon";
  wagon.type = TypeNamed("flat_wagon");
  spec.objects.push_back(wagon);
  const RailWorld world(spec, {}, RailLabels(), RailMaterials(), 1);
  const double top_of_rail_m = world.alignment().At(120.0).position_m.z();
  EXPECT_NEAR(world.WorldFromObject(0, 0).translation().z(), top_of_rail_m - 0.7, 0.25);
  EXPECT_NEAR(world.WorldFromObject(1, 0).translation().z(), top_of_rail_m + 1.5, 1e-9);
  EXPECT_NEAR(world.WorldFromObject(2, 0).translation().z(), top_of_rail_m, 1e-9);
}

TEST(StandingHeight, IsThatOfThePlatformOnOne) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.structures = {StructureBeside<PlatformSpec>(TrackSide::kRight, "platform", 0.0, 300.0)};
  const TestLine line(spec);
  ChunkContext context = line.Context(2);
  context.chunk_from_world = Transform::Identity();
  const Eigen::AlignedBox2d feet(Eigen::Vector2d(-0.2, -0.2), Eigen::Vector2d(0.2, 0.2));
  // In the curve, the edge is farther from the axis by 3.75 m^2 / R, and by what its nose leans.
  const double lean = line.alignment().At(120.0).cant_rad;
  const double beside_m = 1.65 + 3.75 / 400.0 - 0.12 * std::sin(lean);
  const double edge_m =
      (line.alignment().WorldFromTrack(120.0) * Vector3(0.0, -beside_m, 0.76)).z();
  EXPECT_NEAR(StandingHeight_m(context, {120.0, -3.0, 0.0, feet}), edge_m, 1e-6);
  // On the other side of the track, on the ground.
  EXPECT_LT(StandingHeight_m(context, {120.0, 3.0, 0.0, feet}), edge_m - 1.0);
}

}  // namespace
}  // namespace railcast
