#include "core/rail/catenary/catenary_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rail/network/network_draft.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/line/alignment_files.h"
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

}  // namespace
}  // namespace railcast
