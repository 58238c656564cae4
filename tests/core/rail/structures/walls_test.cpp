#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/structures.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Chords may be as far from their arcs; the coordinates of chunks are float32.
constexpr double kChord_m = 1e-3 + 1e-5;

template <class Structure>
Structure Beside(TrackSide side) {
  Structure structure;
  structure.name = "it";
  structure.side = side;
  structure.begin_s_m = 60.0;
  structure.end_s_m = 190.0;
  return structure;
}

WorldSpec CurveWithStructure(const StructureSpec& structure) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.structures = {structure};
  return spec;
}

std::size_t TrianglesPer100m(const StructureSpec& structure) {
  const StructureProbe probe(CurveWithStructure(structure));
  Chunk chunk;
  for (const int index : {2, 3}) AddStructures(probe.line().Context(index), chunk);
  return chunk.ground.num_triangles();
}

TEST(NoiseWall, HasItsFaceAtItsDistanceUpToItsHeight) {
  for (const TrackSide side : {TrackSide::kLeft, TrackSide::kRight}) {
    const StructureProbe probe(CurveWithStructure(Beside<NoiseWallSpec>(side)));
    for (const double s_m : {77.1, 99.99, 150.3}) {
      const auto section = probe.SectionOf(probe.line().surfaces().structures.noise_wall, s_m);
      const double near_m = side == TrackSide::kLeft ? LeastOf(section, 0) : MostOf(section, 0);
      EXPECT_NEAR(near_m, SignOf(side) * 3.8, kChord_m);
      EXPECT_NEAR(MostOf(section, 1), 3.0, kChord_m);
    }
    EXPECT_EQ(probe.LabelSeen({120.0, 0.0, 2.0}, {122.0, SignOf(side) * 3.86, 1.5}),
              probe.line().surfaces().structures.noise_wall.label);
  }
}

TEST(RetainingWall, LeansAwayFromTheTrackByATenth) {
  const StructureProbe probe(CurveWithStructure(Beside<RetainingWallSpec>(TrackSide::kRight)));
  const SurfaceClass& masonry = probe.line().surfaces().structures.retaining_wall;
  const auto section = probe.SectionOf(masonry, 123.4);
  // The foot, 1.7 m below top of rail, and the back of the top 2 m above it, 0.4 m thick.
  EXPECT_NEAR(MostOf(section, 0), -(4.0 - 0.17), kChord_m);
  EXPECT_NEAR(LeastOf(section, 0), -(4.0 + 0.2 + 0.4), kChord_m);
  EXPECT_NEAR(MostOf(section, 1), 2.0, kChord_m);
  EXPECT_EQ(probe.LabelSeen({120.0, 0.0, 2.0}, {122.0, -4.3, 1.0}), masonry.label);
}

/// Height of the ground of the built chunk straight below a place, above top of rail of the line;
/// far down if there is none.
double GroundBelow_m(const StructureProbe& probe, double s_m, double d_m, bool is_coarse = false) {
  return probe.HeightBelow_m(probe.line().surfaces().ground, {s_m, d_m, 60.0}, is_coarse)
      .value_or(-1000.0);
}

WorldSpec SmoothCurveWithWalls(const std::vector<RetainingWallSpec>& walls) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  spec.structures.assign(walls.begin(), walls.end());
  return spec;
}

TEST(RetainingWall, HasTheGroundBehindItAtItsTopAndThatBeforeItAtTheFormation) {
  for (const TrackSide side : {TrackSide::kLeft, TrackSide::kRight}) {
    const StructureProbe probe(SmoothCurveWithWalls({Beside<RetainingWallSpec>(side)}));
    for (const bool is_coarse : {false, true}) {
      for (const double s_m : {90.3, 120.0, 149.9}) {
        // The back stands 4.6 m from the axis; the face at the formation's height 3.93 m.
        for (const double d_m : {3.0, 3.9}) {
          EXPECT_NEAR(GroundBelow_m(probe, s_m, SignOf(side) * d_m, is_coarse), -0.7, 1e-4);
        }
        for (const double behind_m : {0.02, 0.3, 1.0, 3.0}) {
          // Down to the land at 1:1.5, between columns of 0.5 m.
          EXPECT_NEAR(GroundBelow_m(probe, s_m, SignOf(side) * (4.6 + behind_m), is_coarse),
                      1.95 - behind_m / 1.5, 0.02)
              << s_m << " " << behind_m;
        }
        EXPECT_NEAR(GroundBelow_m(probe, s_m, SignOf(side) * 9.5, is_coarse), -0.7, 1e-4);
      }
    }
  }
}

TEST(RetainingWall, LeavesNoGapToTheGroundOnEitherSide) {
  const StructureProbe probe(SmoothCurveWithWalls({Beside<RetainingWallSpec>(TrackSide::kLeft)}));
  const SurfaceClass& masonry = probe.line().surfaces().structures.retaining_wall;
  for (const double s_m : {90.3, 120.1}) {
    // The wall is seen straight down wherever the ground is not.
    for (double d_m = 3.7; d_m < 5.2; d_m += 0.013) {
      const double wall_m = probe.HeightBelow_m(masonry, {s_m, d_m, 60.0}, false).value_or(-1000.0);
      EXPECT_GT(std::max(GroundBelow_m(probe, s_m, d_m), wall_m), -0.71) << s_m << " " << d_m;
    }
  }
}

TEST(RetainingWall, PassesToTheOrdinaryGroundTowardsItsEnds) {
  const StructureProbe probe(SmoothCurveWithWalls({Beside<RetainingWallSpec>(TrackSide::kLeft)}));
  for (const double from_end_m : {0.75, 1.5, 3.0}) {
    // From rows 0.5 m apart.
    EXPECT_NEAR(GroundBelow_m(probe, 60.0 + from_end_m, 4.7), -0.7 + from_end_m / 1.5, 0.05);
    EXPECT_NEAR(GroundBelow_m(probe, 190.0 - from_end_m, 4.7), -0.7 + from_end_m / 1.5, 0.05);
  }
  // A wall that goes on in another one has no such end.
  RetainingWallSpec first = Beside<RetainingWallSpec>(TrackSide::kLeft);
  first.end_s_m = 120.0;
  RetainingWallSpec second = first;
  second.name = "second";
  second.begin_s_m = 120.0;
  second.end_s_m = 190.0;
  const StructureProbe both(SmoothCurveWithWalls({first, second}));
  for (const double s_m : {119.2, 119.9, 120.1, 120.8}) {
    EXPECT_NEAR(GroundBelow_m(both, s_m, 4.9), 1.95 - 0.3 / 1.5, 0.02) << s_m;
  }
}

TEST(RetainingWall, IsNotContinuedByOneBehindIt) {
  // Two terraces of the same length, and one behind the end of the other.
  RetainingWallSpec first = Beside<RetainingWallSpec>(TrackSide::kLeft);
  RetainingWallSpec behind = first;
  behind.name = "behind";
  behind.distance_m = first.distance_m + 4.0;
  RetainingWallSpec after = behind;
  after.begin_s_m = 190.0;
  after.end_s_m = 240.0;
  for (const RetainingWallSpec& other : {behind, after}) {
    const StructureProbe probe(SmoothCurveWithWalls({first, other}));
    EXPECT_NEAR(GroundBelow_m(probe, 190.0 - 0.75, 4.7), -0.7 + 0.75 / 1.5, 0.05);
  }
}

TEST(RetainingWall, LeavesATrackBehindItOnItsFormation) {
  WorldSpec spec = SmoothCurveWithWalls({Beside<RetainingWallSpec>(TrackSide::kLeft)});
  spec.tracks.push_back({.name = "upper", .offset_m = 10.5, .end_s_m = {}});
  const StructureProbe probe(spec);
  EXPECT_NEAR(GroundBelow_m(probe, 120.0, 7.5), -0.7, 1e-4);
  EXPECT_GT(GroundBelow_m(probe, 120.0, 4.7), -0.3);
}

TEST(Fence, StandsOnTheGroundAtItsDistance) {
  for (const FenceType type : {FenceType::kWires, FenceType::kMesh}) {
    FenceSpec fence = Beside<FenceSpec>(TrackSide::kLeft);
    fence.fence = type;
    const StructureProbe probe(CurveWithStructure(fence));
    const TestLine& line = probe.line();
    const AxisPoint axis = line.alignment().At(110.0);
    // A post stands every 2.5 m from 60 m on.
    const auto section = probe.SectionOf(line.surfaces().structures.fence, 110.0);
    ASSERT_FALSE(section.empty());
    const Vector3 ground_m = line.WorldFromChunk(2) * GroundPoint(line.Context(2), 110.0, 6.0);
    EXPECT_NEAR(LeastOf(section, 0), 5.97, kChord_m);
    EXPECT_NEAR(MostOf(section, 0), 6.03, kChord_m);
    EXPECT_NEAR(MostOf(section, 1), ground_m.z() - axis.position_m.z() + 1.83, kChord_m);
  }
}

TEST(Fence, CostsFewTriangles) {
  FenceSpec fence = Beside<FenceSpec>(TrackSide::kLeft);
  fence.begin_s_m = 0.0;
  fence.end_s_m = 300.0;
  EXPECT_LT(TrianglesPer100m(fence), 20'000U);
  fence.fence = FenceType::kWires;
  EXPECT_LT(TrianglesPer100m(fence), 3'000U);
}

TEST(Fence, HasRodsAsThickAsSpecifiedSeenFromAllSides) {
  // Seen from all sides on average, a prism is as wide as its outline is long, divided by pi.
  FenceSpec fence = Beside<FenceSpec>(TrackSide::kLeft);
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {fence};
  const StructureProbe probe(spec);
  Chunk chunk;
  AddStructures(probe.line().Context(2), chunk);
  const Mesh& mesh = MeshOf(probe.line().surfaces().structures.fence, chunk.ground);
  double width_m = 0.0;
  std::size_t num_rods = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); ++i) {
    // Upright rods are the only triangles that are tall and narrow without being a post.
    const auto& [a, b, c] = mesh.triangles[i];
    const Vector3 p = mesh.vertices[a].cast<double>();
    const Vector3 q = mesh.vertices[b].cast<double>();
    const Vector3 r = mesh.vertices[c].cast<double>();
    const double height_m = std::max({p.z(), q.z(), r.z()}) - std::min({p.z(), q.z(), r.z()});
    const double side_m = ((q - p).cross(r - p)).norm() / height_m;
    if (height_m < 1.5 || side_m > 0.02) continue;
    width_m += 0.5 * side_m;  // Two triangles a face.
    ++num_rods;
  }
  ASSERT_GT(num_rods, 0U);
  const double num_prisms = static_cast<double>(num_rods) / 6.0;
  EXPECT_NEAR(width_m / num_prisms, std::numbers::pi * 0.006, 1e-4);
}

TEST(CableTrough, HasItsLidAboveTheFormation) {
  const StructureProbe probe(CurveWithStructure(Beside<CableTroughSpec>(TrackSide::kRight)));
  const SurfaceClass& trough = probe.line().surfaces().structures.cable_trough;
  const auto section = probe.SectionOf(trough, 101.7);
  EXPECT_NEAR(MostOf(section, 0), -2.6, kChord_m);
  EXPECT_NEAR(LeastOf(section, 0), -3.0, kChord_m);
  EXPECT_NEAR(MostOf(section, 1), -0.6, kChord_m);
  EXPECT_EQ(probe.LabelSeen({101.0, -2.0, 2.0}, {101.7, -2.8, -0.6}), trough.label);
}

TEST(ThirdRail, HasItsContactSurfaceWhereShoesRunInTheTracksPlane) {
  const StructureProbe probe(CurveWithStructure(Beside<ThirdRailSpec>(TrackSide::kLeft)));
  const SurfaceClass& rail = probe.line().surfaces().structures.third_rail;
  const auto section = probe.CantedSectionOf(rail, 140.4);
  EXPECT_NEAR(MostOf(section, 1), 0.076, kChord_m);
  EXPECT_NEAR(0.5 * (MostOf(section, 0) + LeastOf(section, 0)), 1.124, kChord_m);
  ThirdRailSpec below = Beside<ThirdRailSpec>(TrackSide::kLeft);
  below.contact = ContactSide::kBottom;
  const StructureProbe covered(CurveWithStructure(below));
  const auto bottom = covered.CantedSectionOf(rail, 140.4);
  EXPECT_NEAR(LeastOf(bottom, 1), 0.16, kChord_m);
  EXPECT_EQ(covered.LabelSeen({140.0, 1.6, 2.0}, {140.4, 1.6, 0.2}), rail.label);
}

TEST(SlabTrack, ReplacesTheBallastOfItsTrackOnly) {
  const SlabTrackSpec slab = StructureAlong<SlabTrackSpec>("slab", 60.0, 190.0);
  WorldSpec spec = CurveWithStructure(slab);
  spec.tracks.push_back({.name = "second", .offset_m = 4.5, .end_s_m = {}});
  const StructureProbe probe(spec);
  const RailSurfaces& surfaces = probe.line().surfaces();
  const auto section = probe.CantedSectionOf(surfaces.structures.slab_track, 120.1);
  EXPECT_NEAR(MostOf(section, 1), -0.205, kChord_m);
  // Between two sleepers, outside the rails.
  EXPECT_EQ(probe.LabelSeen({120.3, 1.1, 2.0}, {120.3, 1.1, -0.2}),
            surfaces.structures.slab_track.label);
  EXPECT_EQ(probe.LabelSeen({120.3, 5.6, 2.0}, {120.3, 5.6, -0.2}), surfaces.ballast.label);
  EXPECT_EQ(probe.LabelSeen({40.5, 1.1, 2.0}, {40.5, 1.1, -0.2}), surfaces.ballast.label);
}

}  // namespace
}  // namespace railcast
