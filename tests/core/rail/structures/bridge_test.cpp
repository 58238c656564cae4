#include <gtest/gtest.h>

#include <cmath>

#include "core/rail/clearance/cleared.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/ground_rise.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Chords may be as far from their arcs; the coordinates of chunks are float32.
constexpr double kDeck_m = 1e-3 + 1e-5;

WorldSpec CurveWithBridge() {
  WorldSpec spec = CantedArc(300.0, 500.0);
  spec.tracks.push_back({.name = "second", .offset_m = -4.0, .end_s_m = {}});
  spec.structures = {StructureAlong<BridgeSpec>("bridge", 110.0, 140.0)};
  return spec;
}

double GroundHeightAt(const TestLine& line, double s_m, double d_m) {
  const int chunk = static_cast<int>(s_m / TestLine::kChunkLength_m);
  return (line.WorldFromChunk(chunk) * GroundPoint(line.Context(chunk), s_m, d_m)).z() -
         line.alignment().At(s_m).position_m.z();
}

TEST(Bridge, HasADeckBesideTheOutermostTracksOnIt) {
  const StructureProbe probe(CurveWithBridge());
  const auto section = probe.SectionOf(probe.line().surfaces().structures.bridge, 125.3);
  EXPECT_NEAR(MostOf(section, 0), 3.5, kDeck_m);
  EXPECT_NEAR(LeastOf(section, 0), -7.5, kDeck_m);
  EXPECT_NEAR(MostOf(section, 1), -0.35, kDeck_m);
  EXPECT_NEAR(LeastOf(section, 1), -1.7, kDeck_m);
  const auto railing = probe.SectionOf(probe.line().surfaces().structures.bridge_railing, 125.3);
  EXPECT_NEAR(MostOf(railing, 1), 0.75, kDeck_m);
}

TEST(Bridge, SpansAGapWithSlopingBanks) {
  WorldSpec spec = CurveWithBridge();
  spec.terrain.roughness_sigma_m = 0.0;
  spec.terrain.undulation_sigma_m = 0.0;
  const TestLine line(spec);
  EXPECT_NEAR(GroundHeightAt(line, 125.0, 0.0), -6.0, 1e-9);
  EXPECT_NEAR(GroundHeightAt(line, 125.0, 40.0), -6.0, 1e-9);
  EXPECT_NEAR(GroundHeightAt(line, 80.0, 40.0), -0.7, 1e-9);
  EXPECT_NEAR(GroundHeightAt(line, 105.0, 0.0), -0.7, 1e-9);
  // 6 m from the bank's foot, which is 0.6 m inside the bridge.
  EXPECT_NEAR(GroundHeightAt(line, 104.6, 40.0), -6.0 + 4.0, 1e-9);
}

TEST(Bridge, IsSeenFromAboveAndBelowAndItsAbutmentsFromTheGap) {
  const StructureProbe probe(CurveWithBridge());
  const RailSurfaces& surfaces = probe.line().surfaces();
  const std::uint32_t label = surfaces.structures.bridge.label;
  EXPECT_EQ(probe.LabelSeen({125.0, 0.0, 2.0}, {125.0, 3.3, -0.35}), label);
  EXPECT_EQ(probe.LabelSeen({125.0, 20.0, -4.0}, {125.0, 2.0, -1.7}), label);
  EXPECT_EQ(probe.LabelSeen({125.0, 2.0, -4.0}, {111.2, 2.0, -4.0}), label);
  EXPECT_EQ(probe.LabelSeen({125.0, 2.0, -4.0}, {125.0, 2.0, -6.0}), surfaces.ground.label);
  EXPECT_EQ(probe.LabelSeen({125.1, 1.0, 2.0}, {125.1, 1.0, -0.2}), surfaces.ballast.label);
}

WorldSpec CurveWithOverbridge() {
  WorldSpec spec = CantedArc(300.0, 500.0);
  spec.structures = {StructureAlong<OverbridgeSpec>("road bridge", 120.0, 132.0)};
  return spec;
}

TEST(Overbridge, LeavesItsClearanceOverTheTrack) {
  const StructureProbe probe(CurveWithOverbridge());
  const StructureSurfaces& surfaces = probe.line().surfaces().structures;
  const auto deck = probe.SectionOf(surfaces.bridge, 126.0);
  double lowest_m = 100.0;
  for (const auto& point : deck) {
    if (std::abs(point.x()) < 4.9) lowest_m = std::min(lowest_m, point.y());
  }
  // Nothing of the bridge is lower between its piers, 5 m from the axis.
  EXPECT_GE(lowest_m, 6.9 - kDeck_m);
  EXPECT_NEAR(MostOf(deck, 0), 15.0, kDeck_m);
  EXPECT_EQ(probe.LabelSeen({105.0, 0.0, 2.0}, {126.0, 0.8, 6.9}), surfaces.bridge.label);
  EXPECT_EQ(probe.LabelSeen({126.0, 0.0, 2.0}, {126.0, 5.0, 3.0}), surfaces.bridge.label);
  EXPECT_EQ(probe.LabelSeen({126.0, 2.0, 12.0}, {126.0, 2.0, 7.9}), surfaces.road.label);
}

TEST(Overbridge, LowersTheMessengerBelowIt) {
  const StructureProbe probe(CurveWithOverbridge());
  const Chunk chunk = probe.line().Build(2);
  for (const Wire& wire : chunk.wires) {
    for (const Vector3& point : wire.points_m) EXPECT_LT(point.z(), 6.9 - 0.2);
  }
  EXPECT_EQ(SystemHeightAt_m(probe.line().spec(), 126.0), kLowSystemHeight_m);
}

TEST(StructureClearing, MovesMastsBehindAPlatform) {
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {StructureBeside<PlatformSpec>(TrackSide::kRight, "platform", 0.0, 300.0)};
  const TestLine line(spec);
  int num_masts = 0;
  for (int chunk = 0; chunk < 6; ++chunk) {
    for (const Placement& placement : line.Build(chunk).placements) {
      if (placement.model->name != "mast") continue;
      ++num_masts;
      const Vector3 foot =
          line.WorldFromChunk(chunk) * Vector3(placement.chunk_from_model.translation());
      EXPECT_LT(foot.y(), -4.65);
    }
  }
  EXPECT_GT(num_masts, 2);
}

}  // namespace
}  // namespace railcast
