#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace railcast {

/// A random quantity of an experiment: a choice between values, or a number, given by its normal
/// score: the standard normal quantile of its distribution function. Factors are independent of
/// each other.
struct RareFactor {
  /// The value that the choice of another one is said to depend on.
  struct Condition {
    std::size_t factor{};
    std::size_t value{};
  };

  /// For each value of a choice, with the sum 1; empty for a number.
  std::vector<double> probabilities{};
  /// The value of an earlier choice without which this factor changes nothing; absent = it always
  /// may.
  std::optional<Condition> only_with{};
};

/// A value of each factor: the index of a choice, or the normal score of a number.
using RarePoint = std::vector<double>;

/// A normal distribution of the score of a number; by p, the standard one.
struct NormalScores {
  double mean = 0.0;
  double sd = 1.0;
};

/// One mode of a proposal, in which factors are independent. Of each factor, only the distribution
/// of its kind counts.
struct ProposalMode {
  double share{};
  std::vector<NormalScores> numbers{};
  std::vector<std::vector<double>> choices{};
};

/// A law q that points are drawn by instead of their own law p: q = 0.1 p + 0.9 q*, with a mixture
/// q* of modes. By the part of p, no weight p / q exceeds 10 (defensive mixture; Owen and Zhou
/// 2000, JASA 95).
struct Proposal {
  std::vector<RareFactor> factors{};
  std::vector<ProposalMode> modes{};  ///< Empty: q = p.
};

/// Share of p in a proposal.
inline constexpr double kDefensiveShare = 0.1;

/// Draws a point, which depends on the arguments alone.
[[nodiscard]] RarePoint DrawPoint(const Proposal& proposal,
                                  std::uint64_t seed,
                                  std::uint32_t index);

/// Whether DrawPoint() draws this point by the share of p.
[[nodiscard]] bool IsDrawnByP(const Proposal& proposal, std::uint64_t seed, std::uint32_t index);

/// The weight p / q of a point, of those factors that change something at it: the density of all
/// others cancels out.
[[nodiscard]] double WeightOf(const Proposal& proposal, const RarePoint& point);

/// How many equal weights have as much error as some that are not negative (Kish 1965); 0 if all
/// are 0.
[[nodiscard]] double EffectiveOf(const std::vector<double>& weights);

/// Points with weights, as long as each other.
struct WeightedPoints {
  std::vector<RarePoint> points{};
  std::vector<double> weights{};
};

/// Fits a proposal of up to four modes to weighted points: the step of the cross-entropy method
/// (Rubinstein and Kroese 2004), by expectation maximisation, with p as if three points of each
/// mode had been drawn by it.
/// @param seed Draws where the modes begin.
/// @return The law p where no point has a weight.
[[nodiscard]] Proposal FitProposal(const std::vector<RareFactor>& factors,
                                   const WeightedPoints& elite,
                                   std::uint64_t seed);

}  // namespace railcast
