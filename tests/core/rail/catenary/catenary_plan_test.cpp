#include "core/rail/catenary/catenary_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/rail/catenary/support_layout.h"
#include "core/rail/network/network_draft.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

CatenaryPlan PlanOf(const WorldSpec& spec) {
  const Alignment alignment(spec.alignment);
  const Network network = MakeNetwork(spec, alignment.length_m());
  return {{spec, network.courses}, alignment};
}

TEST(CatenaryPlan, AlternatesStaggerOverFullSpansOnAStraight) {
  const WorldSpec spec = StraightLine(1000.0);
  const CatenaryPlan plan = PlanOf(spec);
  // 15 spans of 65 m and the remainder.
  ASSERT_EQ(plan.supports().size(), 17U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(plan.supports()[i].s_m, 65.0 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(plan.supports()[i].stagger_m, i % 2 == 0 ? 0.4 : -0.4);
  }
  EXPECT_EQ(plan.supports().back().s_m, 1000.0);
}

TEST(CatenaryPlan, HoldsWiresOutsideOfACurveOverSpansThatTheFormulaGives) {
  for (const double radius_m : {180.0, 300.0, -500.0, 900.0}) {
    const WorldSpec spec = CantedArc(1000.0, radius_m);
    const CatenaryPlan plan = PlanOf(spec);
    const double longest_m = std::sqrt(8.0 * std::abs(radius_m) * (2.0 * 0.4 + 0.05));
    const double expected_m = 2.5 * std::floor(std::min(longest_m, 65.0) / 2.5);
    ASSERT_GT(plan.supports().size(), 10U);
    EXPECT_NEAR(plan.supports()[5].s_m - plan.supports()[4].s_m, expected_m, 1e-9) << radius_m;
    EXPECT_EQ(plan.supports()[5].stagger_m, radius_m > 0.0 ? -0.4 : 0.4) << radius_m;
  }
}

TEST(CatenaryPlan, ShortensASpanWhoseMastsWouldStandInARoad) {
  WorldSpec spec = StraightLine(1000.0);
  LevelCrossingSpec crossing;
  crossing.s_m = 131.0;
  spec.structures = {crossing};
  const CatenaryPlan plan = PlanOf(spec);
  // Not at 130 and 127.5 m, within 1.5 m of a road of 6 m; the next span is a full one again.
  EXPECT_NEAR(plan.supports()[1].s_m, 65.0, 1e-9);
  EXPECT_NEAR(plan.supports()[2].s_m, 125.0, 1e-9);
  EXPECT_NEAR(plan.supports()[3].s_m, 190.0, 1e-9);
}

TEST(CatenaryPlan, IsEmptyWithoutAContactLine) {
  WorldSpec spec = StraightLine(1000.0);
  spec.catenary.enabled = false;
  EXPECT_TRUE(PlanOf(spec).supports().empty());
  spec.catenary.enabled = true;
  spec.tracks[0].electrified = false;
  EXPECT_TRUE(PlanOf(spec).supports().empty());
}

TEST(CatenaryPlan, RefusesASystemHeightThatTheSagUsesUp) {
  WorldSpec spec = StraightLine(1000.0);
  spec.catenary.max_span_m = 80.0;
  spec.catenary.system_height_m = 1.2;
  // 13 * 80^2 / 80000 - 0.08 + 0.3.
  EXPECT_EQ(MessageOf([&] { const CatenaryPlan plan = PlanOf(spec); }),
            "/catenary/system_height_m: must be >= 1.26, the messenger's sag over max_span_m "
            "and a shortest dropper (got 1.2)");
}

WorldSpec StraightTracks(const std::vector<double>& offsets_m) {
  WorldSpec spec = StraightLine(1000.0);
  spec.tracks.assign(offsets_m.size(), TrackSpec{});
  for (std::size_t i = 0; i < offsets_m.size(); ++i) spec.tracks[i].offset_m = offsets_m[i];
  return spec;
}

SupportLayout LayoutAt(const WorldSpec& spec, double s_m) {
  const Network network = MakeNetwork(spec, Alignment(spec.alignment).length_m());
  std::vector<HungWire> wires;
  for (std::size_t k = 0; k < network.courses.size(); ++k) {
    if (!HasWireAt(spec.tracks[k], network.courses[k], s_m)) continue;
    wires.push_back({k, network.courses[k].OffsetWithin_m(s_m), 0.4, false});
  }
  return LayOutSupport(spec, network.courses, s_m, wires);
}

std::vector<double> MastsOf(const WorldSpec& spec, double s_m = 500.0) {
  std::vector<double> masts_d_m;
  for (const MastSite& mast : LayoutAt(spec, s_m).masts) {
    masts_d_m.push_back(*spec.tracks[mast.track].offset_m + mast.from_axis_m);
  }
  return masts_d_m;
}

void ExpectNear(const std::vector<double>& found_m, const std::vector<double>& expected_m) {
  ASSERT_EQ(found_m.size(), expected_m.size());
  for (std::size_t i = 0; i < found_m.size(); ++i) EXPECT_NEAR(found_m[i], expected_m[i], 1e-9);
}

TEST(LayOutSupport, PutsMastsOnTheRightOfASingleTrackAndOutsideOfTwo) {
  ExpectNear(MastsOf(StraightTracks({0.0})), {-3.42});
  ExpectNear(MastsOf(StraightTracks({0.0, 4.0})), {-3.42, 7.42});
  ExpectNear(MastsOf(StraightTracks({0.0, -4.0})), {3.42, -7.42});
  const SupportLayout layout = LayoutAt(StraightTracks({0.0, 4.0}), 500.0);
  EXPECT_NEAR(layout.cantilevers[0].face_m, -3.3, 1e-12);
  EXPECT_NEAR(layout.cantilevers[1].face_m, 3.3, 1e-12);
  EXPECT_TRUE(layout.portals.empty());
}

TEST(LayOutSupport, PutsAMastHalfWayToTheNextTrackWhereThatLeavesTheTrainsRoom) {
  // 2.5 m less half a mast; on the left where only that side is wide enough.
  ExpectNear(MastsOf(StraightTracks({0.0, 5.0, 10.0})), {-3.42, 2.5, 13.42});
  ExpectNear(MastsOf(StraightTracks({0.0, 4.5, 9.5})), {-3.42, 7.0, 12.92});
}

TEST(LayOutSupport, HangsTracksFromAPortalBetweenWhichThereIsNoRoomForMasts) {
  const SupportLayout layout = LayoutAt(StraightTracks({4.0, 0.0, 8.0}), 500.0);
  ASSERT_EQ(layout.portals.size(), 1U);
  EXPECT_NEAR(layout.portals[0].right_d_m, -3.42, 1e-9);
  EXPECT_NEAR(layout.portals[0].left_d_m, 11.42, 1e-9);
  ExpectNear(layout.portals[0].posts_d_m, {2.0});
  // The masts of the outer tracks support the portal: a single structure.
  EXPECT_EQ(layout.masts.size(), 2U);
  ASSERT_EQ(layout.cantilevers.size(), 3U);
  EXPECT_TRUE(layout.cantilevers[0].hangs);
  EXPECT_NEAR(layout.cantilevers[0].face_m, -2.0 + 0.12, 1e-12);
  EXPECT_FALSE(layout.cantilevers[1].hangs);
  for (const CantileverSite& site : layout.cantilevers) EXPECT_EQ(site.structure, 0U);
  for (const MastSite& mast : layout.masts) EXPECT_EQ(mast.structure, 0U);
}

TEST(LayOutSupport, SetsAPortalsMastsBeyondTracksWithoutAWire) {
  WorldSpec spec = StraightTracks({0.0, 4.5, 9.0, -4.5});
  spec.tracks[2].electrified = false;
  spec.tracks[3].electrified = false;
  ExpectNear(MastsOf(spec), {-7.92, 12.42});
  const SupportLayout layout = LayoutAt(spec, 500.0);
  EXPECT_EQ(layout.cantilevers.size(), 2U);
  ExpectNear(layout.portals.at(0).posts_d_m, {-2.25, 2.25});
}

TEST(LayOutSupport, SharesAMastHalfWayBetweenTwoPortals) {
  const WorldSpec spec = StraightTracks({0.0, 4.0, 8.0, 13.0, 17.0, 21.0});
  const SupportLayout layout = LayoutAt(spec, 500.0);
  ExpectNear(MastsOf(spec), {-3.42, 10.5, 24.42});
  ASSERT_EQ(layout.portals.size(), 2U);
  EXPECT_EQ(layout.portals[1].structure, 3U);
  EXPECT_NEAR(layout.portals[1].right_d_m, 10.5, 1e-9);
}

TEST(LayOutSupport, HeedsATrackOnlyWhereItIsAndAWagonsHalfBeyondItsEnd) {
  WorldSpec spec = StraightTracks({0.0, 4.0, 8.0});
  spec.tracks[2].start_s_m = 400.0;
  spec.tracks[2].end_s_m = 600.0;
  for (const double s_m : {300.0, 389.0, 611.0}) ExpectNear(MastsOf(spec, s_m), {-3.42, 7.42});
  for (const double s_m : {391.0, 609.0}) {
    const SupportLayout layout = LayoutAt(spec, s_m);
    EXPECT_EQ(layout.portals.size(), 1U);
    EXPECT_EQ(layout.cantilevers.size(), 2U);  // The third track has no wire there.
  }
}

}  // namespace
}  // namespace railcast
