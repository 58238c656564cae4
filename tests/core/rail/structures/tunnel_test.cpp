#include <gtest/gtest.h>

#include <cmath>

#include "core/rail/clearance/cleared.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/world_tracks.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Chords along the track and, across, faces of the vault may be as far off; float32.
constexpr double kVault_m = 1e-3 + 2e-3 + 1e-5;

WorldSpec CurveWithTunnel(int num_tracks) {
  WorldSpec spec = CantedArc(500.0, 600.0);
  if (num_tracks == 2) spec.tracks.push_back({.name = "second", .offset_m = 4.0, .end_s_m = {}});
  spec.structures = {StructureAlong<TunnelSpec>("tunnel", 110.0, 390.0)};
  return spec;
}

/// The least distance of the section's points from a place across the line.
double NearestTo(const std::vector<Eigen::Vector2d>& section, const Eigen::Vector2d& place) {
  double nearest_m = 100.0;
  for (const auto& point : section) nearest_m = std::min(nearest_m, (point - place).norm());
  return nearest_m;
}

TEST(Tunnel, IsAVaultAsWideAsItsTracksAndWireNeed) {
  // Above the middle: the wire at 5.5 m, its system of 1.1 m and 0.3 m of air. Beside the axis of a
  // track: 3.3 m.
  const double single_m = 5.5 + 1.1 + 0.3 - 1.8;
  const double double_m = std::hypot(2.0, single_m);
  for (const auto& [num_tracks, radius_m, middle_m] :
       {std::tuple(1, single_m, 0.0), std::tuple(2, double_m, 2.0)}) {
    const StructureProbe probe(CurveWithTunnel(num_tracks));
    auto section =
        probe.SectionOf(probe.line().surfaces().structures.tunnel, 187.3);  // No niche there.
    // The walkways are below.
    std::erase_if(section, [](const Eigen::Vector2d& point) { return point.y() < 0.1; });
    EXPECT_NEAR(NearestTo(section, {middle_m, 1.8}), radius_m, kVault_m);
    EXPECT_NEAR(NearestTo(section, {middle_m, 1.8 + radius_m}), 0.0, 0.15);
  }
}

TEST(Tunnel, IsSeenAllAroundFromInside) {
  const StructureProbe probe(CurveWithTunnel(2));
  const std::uint32_t label = probe.line().surfaces().structures.tunnel.label;
  for (double angle_rad = 0.0; angle_rad < 3.2; angle_rad += 0.1) {
    const Vector3 from(160.0, 2.0, 2.0);
    const Vector3 to(162.0, 2.0 + 6.0 * std::cos(angle_rad), 2.0 + 6.0 * std::sin(angle_rad));
    const std::uint32_t seen = probe.LabelSeen(from, to);
    const auto& wires = probe.line().surfaces();
    const bool is_wire = seen == wires.contact_wire.label || seen == wires.messenger_wire.label ||
                         seen == wires.dropper.label || seen == wires.cantilever.label;
    EXPECT_TRUE(seen == label || is_wire) << angle_rad << ": " << seen;
  }
}

TEST(Tunnel, HasNichesOnBothSides) {
  const StructureProbe probe(CurveWithTunnel(1));
  const SurfaceClass& concrete = probe.line().surfaces().structures.tunnel;
  // The first begins 12.5 m behind the mouth and is 2 m long and 0.8 m deep.
  const double wall_m = std::sqrt(5.1 * 5.1 - 1.8 * 1.8);
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector2d back(side * (wall_m + 0.8), 0.0);
    EXPECT_LE(NearestTo(probe.SectionOf(concrete, 123.0), back), kVault_m);
    EXPECT_GT(NearestTo(probe.SectionOf(concrete, 120.0), back), 0.1);
  }
}

TEST(Tunnel, HasPortalsAroundItsMouths) {
  const StructureProbe probe(CurveWithTunnel(1));
  const std::uint32_t label = probe.line().surfaces().structures.tunnel.label;
  EXPECT_EQ(probe.LabelSeen({101.0, 0.0, 2.0}, {110.0, 6.5, 4.0}), label);
  EXPECT_EQ(probe.LabelSeen({101.0, 0.0, 2.0}, {110.0, 0.0, 7.5}), label);
  // The mouth is open.
  EXPECT_NE(probe.LabelSeen({101.0, 0.0, 2.0}, {110.0, 1.0, 3.0}), label);
}

TEST(Tunnel, LowersTheContactLineAndCarriesIt) {
  const WorldSpec spec = CurveWithTunnel(1);
  EXPECT_EQ(SystemHeightAt_m(spec, 30.0), 1.8);
  EXPECT_EQ(SystemHeightAt_m(spec, 60.0), kLowSystemHeight_m);
  EXPECT_EQ(SystemHeightAt_m(spec, 250.0), kLowSystemHeight_m);
  const StructureProbe probe(spec);
  for (const int chunk : {3, 4, 5, 6}) {
    for (const Placement& placement : probe.line().Build(chunk).placements) {
      EXPECT_NE(placement.model->name, "mast");
    }
  }
}

TEST(Tunnel, TakesInALoopInOneHalfOfItsLength) {
  WorldSpec spec = StraightLine(800.0);
  spec.tracks.push_back({.name = "loop",
                         .offset_m = 4.5,
                         .begin = TurnoutSpec{"main", 420.0, TurnoutType::k9_190, {}, {}},
                         .end = TurnoutSpec{"main", 620.0, TurnoutType::k9_190, {}, {}}});
  const Network network = MakeNetwork(spec, 800.0);
  StretchSpec stretch;
  stretch.track = "main";
  stretch.begin_s_m = 50.0;
  stretch.end_s_m = 750.0;
  const TrackSpread spread = SpreadOf({spec, network.courses}, stretch, kSharedTunnel_m);
  EXPECT_NEAR(spread.left_m, 4.5, 1e-9);
  EXPECT_EQ(spread.right_m, 0.0);
  // A track that leaves for good counts as far as it is near.
  spec.tracks[1].offset_m = 40.0;
  spec.tracks[1].begin->s_m = 60.0;
  spec.tracks[1].end.reset();
  spec.tracks[1].end_s_m = 700.0;
  const Network wide = MakeNetwork(spec, 800.0);
  const double left_m = SpreadOf({spec, wide.courses}, stretch, kSharedTunnel_m).left_m;
  EXPECT_GT(left_m, 5.0);
  EXPECT_LE(left_m, kSharedTunnel_m);
}

TEST(Tunnel, HasNoGroundAndNoPlantsInside) {
  const WorldSpec spec = CurveWithTunnel(1);
  EXPECT_TRUE(IsCleared(spec, 200.0, 3.0, Clearing::kGround));
  EXPECT_FALSE(IsCleared(spec, 200.0, 5.0, Clearing::kGround));
  EXPECT_TRUE(IsCleared(spec, 200.0, 5.0, Clearing::kTree));
  const StructureProbe probe(spec);
  const RailSurfaces& surfaces = probe.line().surfaces();
  for (double s_m = 151.0; s_m < 199.0; s_m += 3.7) {
    const std::uint32_t seen = probe.LabelSeen({s_m, 1.9, 2.0}, {s_m, 1.95, -0.5});
    EXPECT_TRUE(seen == surfaces.ballast.label || seen == surfaces.structures.tunnel.label) << s_m;
  }
}

/// Straight, with a second track 7 m beside the first from 230 m on, and a tunnel for either part.
WorldSpec TunnelThatBecomesWider() {
  WorldSpec spec = StraightLine(600.0);
  spec.tracks.push_back({.name = "second", .offset_m = 7.0, .start_s_m = 230.0, .end_s_m = {}});
  const TunnelSpec narrow = StructureAlong<TunnelSpec>("narrow", 50.0, 230.0);
  const TunnelSpec wide = StructureAlong<TunnelSpec>("wide", 230.0, 430.0);
  spec.structures = {narrow, wide};
  return spec;
}

TEST(Tunnel, IsClosedAroundTheNarrowerOneInWhichItGoesOn) {
  const StructureProbe probe(TunnelThatBecomesWider());
  const std::uint32_t concrete = probe.line().surfaces().structures.tunnel.label;
  // Its own radius is 3.5 m more than 3.3 m, the other's 5.1 m. Below the wires.
  for (double d_m = -2.9; d_m < 10.0; d_m += 0.31) {
    for (double h_m = 0.3; h_m < 4.7; h_m += 0.37) {
      if (std::hypot(d_m - 3.5, h_m - 1.8) > 6.7 || std::hypot(d_m, h_m - 1.8) < 5.2) continue;
      const auto seen = probe.Look({240.0, d_m, h_m}, {222.0, d_m, h_m});
      EXPECT_EQ(seen.label, concrete) << d_m << " " << h_m;
      EXPECT_NEAR(seen.distance_m, 10.0, 1e-3) << d_m << " " << h_m;
    }
  }
  // The other one's opening is free.
  for (double d_m = -4.9; d_m < 5.0; d_m += 0.31) {
    if (std::hypot(d_m, 1.2) > 5.0 || std::abs(d_m - 3.5) > 6.6) continue;
    EXPECT_GT(probe.Look({240.0, d_m, 3.0}, {222.0, d_m, 3.0}).distance_m, 10.5) << d_m;
  }
}

TEST(Tunnel, HasAPortalThatEndsHalfWayToTheNextOne) {
  WorldSpec spec = StraightLine(600.0);
  spec.tracks.push_back({.name = "second", .offset_m = 7.6, .end_s_m = {}});
  for (const char* track : {"main", "second"}) {
    TunnelSpec tunnel = StructureAlong<TunnelSpec>(track, 230.0, 430.0);
    tunnel.track = track;
    spec.structures.emplace_back(tunnel);
  }
  const StructureProbe probe(spec);
  const std::uint32_t concrete = probe.line().surfaces().structures.tunnel.label;
  // Before the mouths: the walls above both and between them, and free openings.
  for (double d_m = -7.0; d_m < 14.7; d_m += 0.31) {
    const auto above = probe.Look({221.0, d_m, 8.2}, {240.0, d_m, 8.2});
    EXPECT_EQ(above.label, concrete) << d_m;
    EXPECT_NEAR(above.distance_m, 9.0, 1e-3) << d_m;
  }
  for (const double axis_d_m : {0.0, 7.6}) {
    for (double d_m = -1.6; d_m < 1.61; d_m += 0.2) {
      EXPECT_GT(probe.Look({221.0, axis_d_m + d_m, 3.0}, {240.0, axis_d_m + d_m, 3.0}).distance_m,
                9.5)
          << axis_d_m << " " << d_m;
    }
  }
}

}  // namespace
}  // namespace railcast
