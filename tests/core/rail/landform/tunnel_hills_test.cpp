// The ground above and before tunnels.
#include "core/rail/landform/ground_rise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "tests/core/rail/structures/structure_probe.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

constexpr double kMouth_s_m = 158.0;
/// Of the vault for one track below a contact line, and of the portal (docs/structures.md).
constexpr double kVaultRadius_m = 5.1;
constexpr double kPortalTop_m = 1.8 + 5.1 + 1.5;

/// A straight line through level land so high above top of rail, with a tunnel from kMouth_s_m on.
WorldSpec LineBelow(double land_m) {
  const std::string file = testing::TempDir() + "/" +
                           testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
                           std::to_string(std::lround(10.0 * land_m)) + ".asc";
  std::ofstream stream(file);
  stream << "ncols 20\nnrows 10\nxllcorner -100\nyllcorner -250\ncellsize 50\n";
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 20; ++column) stream << land_m << ' ';
    stream << '\n';
  }
  WorldSpec spec = StraightLine(600.0);
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  spec.terrain.elevation = ElevationSpec{file, {0.0, 0.0, 0.0}};
  spec.structures = {StructureAlong<TunnelSpec>("tunnel", kMouth_s_m, 442.0)};
  return spec;
}

TEST(TunnelHills, AreAsHighAsTheTerrainAboveTheTunnel) {
  const StructureProbe probe(LineBelow(30.0));
  const SurfaceClass& ground = probe.line().surfaces().ground;
  for (const bool is_coarse : {false, true}) {
    for (const double s_m : {251.3, 300.0, 333.3}) {
      for (double d_m = -30.0; d_m < 30.0; d_m += 0.37) {
        const auto height_m = probe.HeightBelow_m(ground, {s_m, d_m, 60.0}, is_coarse);
        ASSERT_TRUE(height_m) << s_m << " " << d_m;
        EXPECT_NEAR(*height_m, 30.0, 1e-4) << s_m << " " << d_m;
      }
    }
  }
}

TEST(TunnelHills, RiseBehindAPortalFromItsUpperEdge) {
  const StructureProbe probe(LineBelow(30.0));
  const SurfaceClass& ground = probe.line().surfaces().ground;
  // The portal is 1 m deep and shows by 0.2 m.
  for (const double behind_m : {0.5, 3.0, 10.0}) {
    EXPECT_NEAR(probe.HeightBelow_m(ground, {kMouth_s_m + 1.0 + behind_m, 0.0, 60.0}).value_or(0.0),
                kPortalTop_m - 0.2 + behind_m / 1.5, 0.02);
  }
}

TEST(TunnelHills, LeaveTheInsideOfTheTunnelFree) {
  // Above the vault, half way up it, about its niches, and below top of rail.
  for (const double land_m : {30.0, 7.0, 1.0, -4.0}) {
    const StructureProbe probe(LineBelow(land_m));
    const std::uint32_t ground = probe.line().surfaces().ground.label;
    // In the mouth, in the wall, before a niche (12.5 m and 2 m long), at the chunk's end.
    for (const double s_m : {160.0, 166.0, 171.5, 186.0, 199.0}) {
      for (double angle_rad = 0.0; angle_rad < 6.28; angle_rad += 0.13) {
        const Vector3 to(s_m, 7.0 * std::cos(angle_rad), 1.2 + 7.0 * std::sin(angle_rad));
        EXPECT_NE(probe.LabelSeen({s_m, 0.0, 1.2}, to), ground)
            << land_m << ": " << s_m << " " << angle_rad;
      }
    }
  }
}

/// Beams along the line from 5 m before the portal, beside and above the mouth.
void ExpectNoGapAtThePortal(double land_m, bool has_ditches = false) {
  WorldSpec spec = LineBelow(land_m);
  spec.terrain.has_ditches = has_ditches;
  const StructureProbe probe(spec);
  const std::uint32_t ground = probe.line().surfaces().ground.label;
  const std::uint32_t concrete = probe.line().surfaces().structures.tunnel.label;
  for (double d_m = -5.43; d_m < 20.0; d_m += 0.43) {
    for (double h_m = -0.6; h_m < std::min(land_m - 0.1, 18.0); h_m += 0.83) {
      if (std::hypot(d_m, h_m - 1.8) < kVaultRadius_m + 0.02) continue;
      // In the slope of the cutting.
      if (h_m < -0.7 + std::max(0.0, std::abs(d_m) - 4.5) / 1.5 + 0.02) continue;
      const auto seen = probe.Look({kMouth_s_m - 5.0, d_m, h_m}, {199.9, d_m, h_m});
      if (seen.label == ground) continue;
      // Wires and their posts apart, what is no ground is the front of the portal or of a wing.
      if (seen.label != concrete && seen.label != 0) continue;
      EXPECT_EQ(seen.label, concrete) << land_m << ": " << d_m << " " << h_m;
      EXPECT_LT(seen.distance_m, 6.001) << land_m << ": " << d_m << " " << h_m;
    }
  }
}

TEST(TunnelHills, LeaveNoGapAtThePortalOfADeepCutting) {
  ExpectNoGapAtThePortal(30.0);
}

TEST(TunnelHills, LeaveNoGapAtThePortalOfACuttingWithDitches) {
  ExpectNoGapAtThePortal(30.0, true);
}

TEST(TunnelHills, LeaveNoGapAtThePortalOfAShallowCutting) {
  ExpectNoGapAtThePortal(10.0);
}

TEST(TunnelHills, AreHeldBackByWingsBesideAPortal) {
  const StructureProbe probe(LineBelow(30.0));
  const std::uint32_t concrete = probe.line().surfaces().structures.tunnel.label;
  // Between the slope of the cutting and the wing's edge, which falls from the portal's.
  for (const double d_m : {-10.0, 10.0}) {
    for (const double h_m : {3.2, 5.0, 6.5}) {
      const auto seen = probe.Look({kMouth_s_m - 5.0, d_m, h_m}, {199.9, d_m, h_m});
      EXPECT_EQ(seen.label, concrete) << d_m << " " << h_m;
      EXPECT_NEAR(seen.distance_m, 5.0, 1e-3) << d_m << " " << h_m;
    }
    const auto above = probe.Look({kMouth_s_m - 5.0, d_m, 7.2}, {199.9, d_m, 7.2});
    EXPECT_EQ(above.label, probe.line().surfaces().ground.label);
  }
}

TEST(TunnelHills, StandInForTheLiningWhereTheLandIsLower) {
  // Beside the niches the ground reaches up to 2.35 m, and falls from there at 1:1.5.
  const StructureProbe probe(LineBelow(1.0));
  const SurfaceClass& ground = probe.line().surfaces().ground;
  const SurfaceClass& concrete = probe.line().surfaces().structures.tunnel;
  for (double d_m = -12.0; d_m < 12.0; d_m += 0.1) {
    const double ground_m = probe.HeightBelow_m(ground, {300.0, d_m, 60.0}).value_or(-100.0);
    const double lining_m = probe.HeightBelow_m(concrete, {300.0, d_m, 60.0}).value_or(-100.0);
    EXPECT_GE(std::max(ground_m, lining_m), 1.0 - 1e-4) << d_m;
    if (std::abs(d_m) < 5.0) {
      EXPECT_GT(lining_m, ground_m) << d_m;
    }
  }
  EXPECT_NEAR(probe.HeightBelow_m(ground, {300.0, 6.5, 60.0}).value_or(0.0),
              2.35 - (6.5 - 5.75) / 1.5, 0.05);
}

TEST(TunnelHills, LeaveATrackBesideTheTunnelInItsCutting) {
  WorldSpec spec = LineBelow(30.0);
  spec.tracks.push_back({.name = "outside", .offset_m = 25.0, .end_s_m = {}});
  const StructureProbe probe(spec);
  const SurfaceClass& ground = probe.line().surfaces().ground;
  EXPECT_NEAR(probe.HeightBelow_m(ground, {300.0, 28.0, 60.0}).value_or(0.0), -0.7, 1e-4);
  EXPECT_NEAR(probe.HeightBelow_m(ground, {300.0, 10.0, 60.0}).value_or(0.0),
              -0.7 + (25.0 - 10.0 - 4.5) / 1.5, 0.05);
}

TEST(TunnelHills, AreBehindARetainingWallOfAnotherTrack) {
  WorldSpec spec = LineBelow(30.0);
  spec.tracks.push_back({.name = "outside", .offset_m = 25.0, .end_s_m = {}});
  RetainingWallSpec wall =
      StructureBeside<RetainingWallSpec>(TrackSide::kRight, "wall", kMouth_s_m + 30.0, 400.0);
  wall.track = "outside";
  wall.distance_m = 5.0;
  wall.height_m = 4.0;
  spec.structures.emplace_back(wall);
  const StructureProbe probe(spec);
  const SurfaceClass& ground = probe.line().surfaces().ground;
  for (const double d_m : {0.0, 5.5, 6.5, 10.0}) {
    // Its back is 5.8 m from the axis of the track before it.
    EXPECT_NEAR(probe.HeightBelow_m(ground, {300.0, d_m, 60.0}).value_or(0.0),
                3.95 + (25.0 - 5.8 - d_m) / 1.5, 0.05)
        << d_m;
  }
  EXPECT_NE(probe.LabelSeen({300.0, 0.0, 1.2}, {300.0, 7.0, 1.2}), ground.label);
}

TEST(TunnelHills, AreNotWhereThingsStandInTheTunnel) {
  const TestLine line(LineBelow(30.0));
  const ChunkContext context = line.Context(6);
  const auto height_m = [&](double d_m) {
    return (line.WorldFromChunk(6) * GroundPoint(context, 310.0, d_m)).z();
  };
  EXPECT_NEAR(height_m(2.5), -0.7, 1e-9);
  EXPECT_NEAR(height_m(8.0), 30.0, 1e-9);
}

TEST(TunnelHills, GoOnWhereATunnelGoesOnAsAnother) {
  WorldSpec spec = LineBelow(30.0);
  TunnelSpec first = std::get<TunnelSpec>(spec.structures[0]);
  TunnelSpec second = first;
  first.end_s_m = second.begin_s_m = 310.0;
  second.name = "second";
  spec.structures = {first, second};
  const StructureProbe probe(spec);
  const SurfaceClass& ground = probe.line().surfaces().ground;
  for (const double s_m : {290.0, 308.0, 309.7, 310.0, 310.3, 312.0, 333.3}) {
    for (double d_m = -20.0; d_m < 20.0; d_m += 0.73) {
      EXPECT_NEAR(probe.HeightBelow_m(ground, {s_m, d_m, 60.0}).value_or(0.0), 30.0, 1e-4)
          << s_m << " " << d_m;
    }
    for (double angle_rad = 0.0; angle_rad < 3.2; angle_rad += 0.13) {
      const Vector3 to(s_m, 7.0 * std::cos(angle_rad), 1.2 + 7.0 * std::sin(angle_rad));
      EXPECT_NE(probe.LabelSeen({s_m, 0.0, 1.2}, to), ground.label) << s_m << " " << angle_rad;
    }
  }
}

}  // namespace
}  // namespace railcast
