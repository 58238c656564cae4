#include "core/certify/strata.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/base/random.h"
#include "tests/support/echo_frame.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;

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

TEST(Strata, AreOfSomeFiringsAsOfAll) {
  constexpr std::uint32_t kRows = 7, kColumns = 13;
  std::vector<std::vector<MadeEcho>> firings(kRows * kColumns);
  for (std::uint32_t i = 0; i < firings.size(); ++i) {
    const auto words = RandomWords(1, RandomUse::kCertificate, 0, i);
    const auto one_of_eight = [&](std::size_t k) { return words[k] % 8 == 0 ? 1U : 0U; };
    if (one_of_eight(0) != 0) continue;
    firings[i] = {{10.0F + static_cast<float>(one_of_eight(1)), 3 + one_of_eight(2)}};
  }
  Frame frame = MakeEchoFrame(firings);
  frame.rows = kRows;
  frame.columns = kColumns;
  const std::vector<std::uint8_t> all = StratumKindsOf(frame, EdgesOf(frame));
  EXPECT_THAT(all, IsSupersetOf({1, 2, 3}));
  const std::vector<std::uint32_t> some = {0, 5, 12, 13, 40, 41, 77, 78, 90};
  std::vector<std::uint8_t> of_some;
  for (const std::uint32_t cell : some) of_some.push_back(all[cell]);
  EXPECT_EQ(StratumKindsAt(frame, some), of_some);
}

}  // namespace
}  // namespace railcast
