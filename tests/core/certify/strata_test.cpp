#include "core/certify/strata.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/support/echo_frame.h"

namespace railcast {
namespace {

using testing::ElementsAre;

TEST(Strata, AreByRangeUpTo25And50And100And200MetresAndBeyond) {
  EXPECT_EQ(StratumBinOf(0.0F), 0U);
  EXPECT_EQ(StratumBinOf(24.9F), 0U);
  EXPECT_EQ(StratumBinOf(25.0F), 1U);
  EXPECT_EQ(StratumBinOf(99.0F), 2U);
  EXPECT_EQ(StratumBinOf(199.0F), 3U);
  EXPECT_EQ(StratumBinOf(200.0F), 4U);
  EXPECT_EQ(StratumBinOf(std::numeric_limits<float>::quiet_NaN()), 0U);
}

TEST(Strata, TellWhatAFiringMeetsAndWhetherItReturned) {
  const Frame frame =
      MakeEchoFrame({{{60.0F, 5}}, {{61.0F, 5, 0.2F, 0.5F, Outcome::kBelowThreshold}}, {}});
  const std::vector<std::uint8_t> kinds = StratumKindsOf(frame, {1, 0, 0});
  EXPECT_EQ(StratumOf(5, kinds[0]), (Stratum{5, 2, true, true}));
  EXPECT_EQ(StratumOf(5, kinds[1]), (Stratum{5, 2, false, false}));
  EXPECT_EQ(StratumOf(0, kinds[2]), (Stratum{0, 0, false, false}));
}

TEST(Strata, HaveAnEdgeWhereARowStepsByMoreThanHalfAMetre) {
  EXPECT_THAT(EdgesOf(MakeEchoFrame({{{10.0F}}, {{10.4F}}, {{10.95F}}, {{11.0F}}})),
              ElementsAre(0, 1, 1, 0));
}

TEST(Strata, HaveAnEdgeWhereLabelOrInstanceChange) {
  Frame frame =
      MakeEchoFrame({{{10.0F, 3}}, {{10.0F, 3}}, {{10.0F, 4}}, {{10.0F, 4}}, {{10.0F, 4}}});
  EXPECT_THAT(EdgesOf(frame), ElementsAre(0, 1, 1, 0, 0));
  frame.instance[4 * frame.returns] = 7;
  EXPECT_THAT(EdgesOf(frame), ElementsAre(0, 1, 1, 1, 1));
}

TEST(Strata, HaveAnEdgeWherePartOfTheBeamFallsBesideItsMainSurface) {
  Frame frame = MakeEchoFrame({{{10.0F}}, {{10.0F}}, {{10.0F}}});
  frame.mixed_share[1 * frame.returns] = 0.01F;
  EXPECT_THAT(EdgesOf(frame), ElementsAre(0, 1, 0));
}

TEST(Strata, HaveNoEdgeBetweenRowsOfLevelGround) {
  Frame frame = MakeEchoFrame({{{40.0F}}, {{40.1F}}, {{60.0F}}, {{60.1F}}});
  frame.rows = 2;
  frame.columns = 2;
  EXPECT_THAT(EdgesOf(frame), ElementsAre(0, 0, 0, 0));
  frame.label[3 * frame.returns] = 9;
  EXPECT_THAT(EdgesOf(frame), ElementsAre(0, 1, 1, 1));
}

}  // namespace
}  // namespace railcast
