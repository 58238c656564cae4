#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/core/rail/structures/structure_probe.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

/// A beam from one place to another, both (s, d, h), and the label that it should meet.
struct Aim {
  std::string label;
  Vector3 from;
  Vector3 to;
};

template <class Spec>
StructureSpec Along(Spec spec) {
  spec.name = "it";
  spec.begin_s_m = 102.0;
  spec.end_s_m = 148.0;
  return spec;
}

template <class Spec>
StructureSpec OnTheLeft(Spec spec) {
  spec.side = TrackSide::kLeft;
  return Along(std::move(spec));
}

template <class Spec>
StructureSpec At(Spec spec) {
  spec.name = "it";
  spec.s_m = 126.0;
  return spec;
}

template <class Spec>
StructureSpec AtTheLeft(Spec spec) {
  spec.side = TrackSide::kLeft;
  return At(std::move(spec));
}

/// One of each type, kind and part with a label of its own.
std::vector<std::pair<StructureSpec, Aim>> OneOfEach() {
  const Vector3 eye(126.0, 0.0, 2.5);
  SignalSpec distant;
  distant.kind = SignalKind::kDistant;
  SignalSpec shunting;
  shunting.kind = SignalKind::kShunting;
  BoardSpec kilometre;
  kilometre.kind = BoardKind::kKilometre;
  BoardSpec fouling;
  fouling.kind = BoardKind::kFoulingPoint;
  FurnitureSpec bench;
  bench.kind = FurnitureKind::kBench;
  FurnitureSpec shelter;
  shelter.kind = FurnitureKind::kShelter;
  BuildingSpec building{.name = "it",
                        .footprint_m = {{115.0, 8.0}, {137.0, 8.0}, {137.0, 16.0}, {115.0, 16.0}}};
  BufferStopSpec buffer_stop{.name = "it"};
  return {
      {OnTheLeft(PlatformSpec{}), {"platform", eye, {126.0, 3.0, 0.76}}},
      {OnTheLeft(NoiseWallSpec{}), {"noise_wall", eye, {126.0, 3.8, 1.5}}},
      // Along the mesh, since a beam without width passes between its rods.
      {OnTheLeft(FenceSpec{}), {"fence", {101.0, 6.0, 0.3}, {126.0, 6.0, 0.3}}},
      {OnTheLeft(RetainingWallSpec{}), {"retaining_wall", eye, {126.0, 4.1, 1.0}}},
      {OnTheLeft(CableTroughSpec{}), {"cable_trough", {126.0, 2.8, 2.5}, {126.0, 2.8, -0.6}}},
      {Along(TunnelSpec{}), {"tunnel", {126.0, 1.0, 2.5}, {126.0, 2.0, 6.5}}},
      {Along(BridgeSpec{}), {"bridge", {126.0, 1.0, -5.0}, {126.0, 1.0, -1.7}}},
      {Along(OverbridgeSpec{}), {"bridge", {126.0, 1.0, 2.5}, {126.0, 1.0, 6.9}}},
      {OnTheLeft(ThirdRailSpec{}), {"third_rail", {126.0, 1.124, 2.5}, {126.0, 1.124, 0.076}}},
      {Along(SlabTrackSpec{}), {"slab_track", {126.3, 0.3, 2.5}, {126.3, 0.3, -0.205}}},
      {At(SignalSpec{}), {"signal", {105.0, -3.1, 4.8}, {126.0, -3.1, 4.8}}},
      {At(distant), {"signal", {105.0, -3.1, 4.0}, {126.0, -3.1, 4.0}}},
      {At(shunting), {"signal", {105.0, -2.2, 0.6}, {126.0, -2.2, 0.6}}},
      {At(BoardSpec{}), {"board", {105.0, -3.0, 2.0}, {126.0, -3.0, 2.0}}},
      {At(kilometre), {"board", {105.0, -3.0, 0.6}, {126.0, -3.0, 0.6}}},
      {At(fouling), {"board", eye, {126.0, -2.0, 0.1}}},
      {At(BaliseSpec{}), {"balise", eye, {126.0, 0.0, -0.171}}},
      {AtTheLeft(DerailerSpec{}), {"derailer", eye, {126.0, 0.75, 0.1}}},
      {AtTheLeft(RelayBoxSpec{}), {"relay_box", eye, {126.0, 4.0, 0.0}}},
      {AtTheLeft(FurnitureSpec{}), {"furniture", eye, {126.0, 5.0, 2.0}}},
      {AtTheLeft(bench), {"furniture", eye, {126.0, 5.0, -0.3}}},
      {AtTheLeft(shelter), {"furniture", eye, {126.0, 5.0, 1.0}}},
      {buffer_stop, {"buffer_stop", {270.0, 0.0, 1.3}, {298.0, 0.0, 1.3}}},
      {At(LevelCrossingSpec{}), {"road", eye, {126.0, 3.0, -0.02}}},
      {At(LevelCrossingSpec{}), {"level_crossing", {124.5, 12.0, 1.0}, {124.5, 3.8, 0.95}}},
      {building, {"building", eye, {126.0, 8.0, 2.0}}},
  };
}

TEST(StructureLabels, ABeamAimedAtEachStructureReturnsItsLabel) {
  for (auto& [structure, aim] : OneOfEach()) {
    WorldSpec spec = StraightLine(300.0);
    spec.vegetation.grass = false;
    spec.vegetation.trees_per_hectare = 0.0;
    spec.structures = {structure};
    const StructureProbe probe(std::move(spec));
    const std::uint32_t seen = probe.LabelSeen(aim.from, aim.to);
    EXPECT_EQ(seen, RailLabels().Id(aim.label)) << aim.label << " at " << aim.to.transpose();
    // Without the structure, the beam meets something else or nothing.
    EXPECT_NE(StructureProbe(StraightLine(300.0)).LabelSeen(aim.from, aim.to),
              RailLabels().Id(aim.label));
  }
}

}  // namespace
}  // namespace railcast
