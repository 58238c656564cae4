#include "core/certify/weighted_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr Stratum kInner{.label = 4, .range_bin = 1, .is_edge = false, .has_return = true};
constexpr Stratum kAtEdge{.label = 4, .range_bin = 1, .is_edge = true, .has_return = true};

TEST(WeightedShares, OfOneStratumAreTheDrawnShareWithTheExactInterval) {
  WeightedShares shares;
  shares.AddFirings(kInner, 1'000'000, 1e-4);
  std::vector<double> missed;
  for (int i = 0; i < 100; ++i) {
    shares.AddDrawn(kInner);
    missed.push_back(i < 20 ? 1.0 : 0.0);
  }
  const auto figure = shares.Share(missed, std::vector<double>(100, 1.0));
  ASSERT_TRUE(figure);
  EXPECT_DOUBLE_EQ(figure->value, 0.2);
  // Clopper and Pearson's interval of 20 of 100 is 0.1267 to 0.2918.
  EXPECT_NEAR(figure->low, 0.1267, 1e-3);
  EXPECT_NEAR(*figure->high, 0.2918, 1e-3);
}

TEST(WeightedShares, CountAStratumByItsFiringsNotByThoseDrawn) {
  WeightedShares shares;
  shares.AddFirings(kInner, 90'000, 1e-3);
  shares.AddFirings(kAtEdge, 10'000, 1e-2);
  std::vector<double> missed;
  // Half of the drawn firings are at edges, which are a tenth of all.
  for (int i = 0; i < 200; ++i) {
    shares.AddDrawn(i < 100 ? kInner : kAtEdge);
    missed.push_back(i >= 150 ? 1.0 : 0.0);
  }
  EXPECT_NEAR(shares.Share(missed, std::vector<double>(200, 1.0))->value, 0.05, 1e-12);
}

// As in a study whose approaches differ in their sensors.
TEST(WeightedShares, TakeEachDrawnFiringWithTheProbabilityThatItHad) {
  WeightedShares shares;
  std::vector<double> missed;
  for (const bool is_first : {true, false}) {
    shares.AddFirings(kInner, is_first ? 1000 : 10'000, is_first ? 0.1 : 0.01);
    for (int i = 0; i < 100; ++i) {
      shares.AddDrawn(kInner);
      missed.push_back(is_first ? 1.0 : 0.0);
    }
  }
  EXPECT_NEAR(shares.Share(missed, std::vector<double>(200, 1.0))->value, 1.0 / 11.0, 1e-12);
}

TEST(WeightedShares, OfNothingAreAbsent) {
  WeightedShares shares;
  shares.AddFirings(kInner, 1000, 0.1);
  EXPECT_FALSE(shares.Share({}, {}));
  EXPECT_FALSE(shares.Quantile({}, 0.5));
  shares.AddDrawn(kInner);
  EXPECT_FALSE(shares.Share({0.0}, {0.0}));
}

TEST(WeightedShares, HaveAnUpperEndWhereNoneIsMissed) {
  WeightedShares shares;
  shares.AddFirings(kInner, 100'000, 1e-3);
  for (int i = 0; i < 100; ++i) shares.AddDrawn(kInner);
  const auto figure = shares.Share(std::vector<double>(100), std::vector<double>(100, 1.0));
  EXPECT_DOUBLE_EQ(figure->value, 0.0);
  EXPECT_DOUBLE_EQ(figure->low, 0.0);
  EXPECT_NEAR(*figure->high, 1.0 - std::pow(0.025, 0.01), 1e-9);
}

TEST(WeightedShares, TellWhatShareOfTheFiringsNoneWasDrawnFrom) {
  WeightedShares shares;
  shares.AddFirings(kInner, 75, 0.5);
  shares.AddFirings(kAtEdge, 25, 0.5);
  shares.AddDrawn(kInner);
  EXPECT_DOUBLE_EQ(shares.share_without_drawn(), 0.25);
}

TEST(WeightedShares, HaveNoUpperEndOfAQuantileThatTooFewTellOf) {
  for (const int num : {70, 80}) {
    WeightedShares shares;
    shares.AddFirings(kInner, 100'000, 1e-3);
    std::vector<std::pair<std::size_t, double>> values;
    for (int i = 0; i < num; ++i) {
      shares.AddDrawn(kInner);
      values.emplace_back(i, i);
    }
    // The largest of 70 is below the 95 % quantile with a probability of 0.95^70 = 2.8 %, that of
    // 80 with 1.7 %.
    const auto figure = shares.Quantile(values, 0.95);
    EXPECT_EQ(figure->high.has_value(), num == 80);
    if (figure->high) {
      EXPECT_EQ(*figure->high, 79.0);
    }
  }
}

/// Firings with known errors, as those of a run: edges are rare and mostly wrong, far ground is
/// often wrong, near ground hardly ever.
struct KnownRun {
  struct Kind {
    Stratum stratum;
    std::uint32_t num;
    double wrong_share;
    double probability;
  };
  std::vector<Kind> kinds = {
      {{4, 0, false, true}, 40'000, 0.005, 0.002}, {{4, 1, false, true}, 20'000, 0.05, 0.002},
      {{4, 2, false, true}, 10'000, 0.3, 0.002},   {{5, 1, false, true}, 8'000, 0.4, 0.005},
      {{4, 1, true, true}, 700, 0.6, 0.0045},      {{13, 1, true, true}, 90, 0.5, 0.0045},
      {{0, 0, false, false}, 21'000, 0.0, 0.0005}};

  [[nodiscard]] bool IsWrong(std::size_t kind, std::uint32_t i) const {
    return i < kinds[kind].wrong_share * kinds[kind].num;
  }
  /// Spread evenly, so that quantiles are known.
  [[nodiscard]] double ValueOf(std::size_t kind, std::uint32_t i) const {
    return static_cast<double>(i + 1) / kinds[kind].num * static_cast<double>(kind + 1);
  }
};

/// In how many of so many drawings the interval has the true value.
template <typename Figure>
double Coverage(const KnownRun& run, double truth, const Figure& figure_of) {
  constexpr int kNumDrawings = 400;
  int num_covered = 0;
  for (int drawing = 0; drawing < kNumDrawings; ++drawing) {
    WeightedShares shares;
    std::vector<std::pair<std::size_t, std::uint32_t>> drawn;
    for (std::size_t k = 0; k < run.kinds.size(); ++k) {
      const KnownRun::Kind& kind = run.kinds[k];
      shares.AddFirings(kind.stratum, kind.num, kind.probability);
      for (std::uint32_t i = 0; i < kind.num; ++i) {
        const auto words = RandomWords(static_cast<std::uint64_t>(drawing), RandomUse::kCertificate,
                                       static_cast<std::uint32_t>(k), i);
        if (static_cast<double>(words[0]) * 0x1p-32 >= kind.probability) continue;
        shares.AddDrawn(kind.stratum);
        drawn.emplace_back(k, i);
      }
    }
    const auto figure = figure_of(shares, drawn);
    if (figure && figure->low <= truth && (!figure->high || truth <= *figure->high)) ++num_covered;
  }
  return static_cast<double>(num_covered) / kNumDrawings;
}

// The standard deviation of the coverage of 400 drawings is 1.1 %: four of them on either side.
constexpr double kLeastCoverage = 0.95 - 0.044;

// Wilson's intervals of the smaller class hold in 91 and 93 %.
TEST(WeightedShares, HaveIntervalsThatCoverSmallSharesOfSmallClasses) {
  for (const std::uint32_t size : {1000U, 2000U}) {
    for (const double wrong : {0.004, 0.02}) {
      const KnownRun run{.kinds = {{{7, 0, false, true}, 6 * size, wrong, 0.0035},
                                   {{7, 1, false, true}, 2 * size, wrong, 0.0035},
                                   {{7, 0, true, true}, size, wrong, 0.008}}};
      double num = 0.0;
      double num_wrong = 0.0;
      for (const KnownRun::Kind& kind : run.kinds) {
        num += kind.num;
        num_wrong += std::ceil(kind.wrong_share * kind.num);
      }
      const double coverage =
          Coverage(run, num_wrong / num, [&](const auto& shares, const auto& drawn) {
            std::vector<double> of;
            for (const auto& [kind, i] : drawn) of.push_back(run.IsWrong(kind, i) ? 1.0 : 0.0);
            return shares.Share(of, std::vector<double>(of.size(), 1.0));
          });
      EXPECT_GE(coverage, 0.95 - 0.011) << size << " " << wrong;
    }
  }
}

TEST(WeightedShares, HaveIntervalsThatCoverTheTruthIn95Percent) {
  const KnownRun run;
  double num = 0.0;
  double num_wrong = 0.0;
  for (const KnownRun::Kind& kind : run.kinds) {
    if (kind.stratum.label == 0) continue;
    num += kind.num;
    num_wrong += std::ceil(kind.wrong_share * kind.num);
  }
  const double coverage =
      Coverage(run, num_wrong / num, [&](const auto& shares, const auto& drawn) {
        std::vector<double> wrong;
        std::vector<double> all;
        for (const auto& [kind, i] : drawn) {
          all.push_back(run.kinds[kind].stratum.label == 0 ? 0.0 : 1.0);
          wrong.push_back(run.IsWrong(kind, i) ? all.back() : 0.0);
        }
        return shares.Share(wrong, all);
      });
  EXPECT_GE(coverage, kLeastCoverage);
  // Exact intervals are too long rather than too short, and strata are not trusted.
  EXPECT_LE(coverage, 0.998);
}

TEST(WeightedShares, HaveIntervalsThatCoverTheTrueQuantileIn95Percent) {
  const KnownRun run;
  std::vector<double> all;
  for (std::size_t k = 0; k < run.kinds.size(); ++k) {
    if (run.kinds[k].stratum.label == 0) continue;
    for (std::uint32_t i = 0; i < run.kinds[k].num; ++i) all.push_back(run.ValueOf(k, i));
  }
  for (const double share : {0.5, 0.95}) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size()));
    std::ranges::nth_element(all, all.begin() + rank);
    const double truth = all[static_cast<std::size_t>(rank)];
    const double coverage = Coverage(run, truth, [&](const auto& shares, const auto& drawn) {
      std::vector<std::pair<std::size_t, double>> values;
      for (std::size_t n = 0; n < drawn.size(); ++n) {
        if (run.kinds[drawn[n].first].stratum.label == 0) continue;
        values.emplace_back(n, run.ValueOf(drawn[n].first, drawn[n].second));
      }
      return shares.Quantile(values, share);
    });
    EXPECT_GE(coverage, kLeastCoverage) << share;
    // Far out, these kinds tell the values apart so well that the interval could be shorter; but
    // strata are not trusted to narrow it.
    EXPECT_LE(coverage, share == 0.5 ? 0.995 : 1.0) << share;
  }
}

}  // namespace
}  // namespace railcast
