#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/certify/strata.h"

namespace railcast {

/// A figure with its 95 % interval.
struct CertifiedFigure {
  double value{};
  double low{};
  std::optional<double> high{};  ///< Absent where too little was drawn to tell.

  bool operator==(const CertifiedFigure&) const = default;
};

/// Shares and quantiles over all firings of a run, from those that were drawn: each by itself, with
/// the probability of its stratum.
///
/// What is known of every firing is its stratum. So the drawn ones stand for the firings of theirs
/// (post-stratification: Holt and Smith 1979, JRSS A 142, 33); strata in which fewer than
/// kLeastDrawn were drawn are joined, first with other ranges of the same label, then with other
/// labels, and firings within a joined group count by the inverse of their probabilities. The run
/// is a finite population and all of its frames are in it, so that nothing but the drawing is
/// random: errors are those of ratios of such totals, linearized (Särndal, Swensson and Wretman
/// 1992, Model Assisted Survey Sampling, 5.6 and 7.6).
///
///     WeightedShares shares;
///     shares.AddFirings(stratum, 28'000, 0.001);
///     shares.AddDrawn(stratum);  // Firing 0.
///     const auto missed = shares.Share(num_missed, num_echoes);
class WeightedShares {
 public:
  static constexpr std::size_t kLeastDrawn = 20;

  /// Adds firings of a stratum, drawn or not.
  void AddFirings(const Stratum& stratum, std::uint64_t num, double probability);
  /// Adds a drawn one of those that were added last, whose probability it has; they are numbered
  /// from 0.
  void AddDrawn(const Stratum& stratum) {
    drawn_.push_back(stratum);
    probabilities_.push_back(strata_.at(stratum).probability);
  }

  [[nodiscard]] std::size_t num_drawn() const { return drawn_.size(); }
  [[nodiscard]] std::uint64_t num_firings() const { return num_firings_; }
  /// The share of the firings that are in strata of which none was drawn, so that those of other
  /// strata stand for them.
  [[nodiscard]] double share_without_drawn() const;

  /// The sum of one number over all firings, divided by another's. Both are at least 0, and the
  /// first is not the larger one: the share of echoes that are missed, say. The interval is Clopper
  /// and Pearson's at the effective number of the second (Korn and Graubard 1998, Survey
  /// Methodology 24): at least as long as it must be. Absent if the second is 0.
  /// @param of, among By drawn firing.
  [[nodiscard]] std::optional<CertifiedFigure> Share(const std::vector<double>& of,
                                                     const std::vector<double>& among) const;

  /// The quantile of values that belong to firings, with the interval of Woodruff (1952, JASA 47):
  /// the quantiles whose drawn share below is no farther from the true one, which is known,
  /// than 1.96 of its standard deviations. An interval of a share that is not known would
  /// end too early in a tail. Absent if there is none.
  /// @param values (drawn firing, value)
  [[nodiscard]] std::optional<CertifiedFigure> Quantile(
      std::vector<std::pair<std::size_t, double>> values, double share) const;

 private:
  struct Population {
    std::uint64_t num{};
    double probability{};  ///< Probability of the firings that were added last.
  };
  struct Group {
    std::uint64_t num_firings{};
    std::vector<std::size_t> drawn{};
  };
  [[nodiscard]] std::vector<Group> Groups() const;
  [[nodiscard]] double WeightOf(std::size_t drawn) const { return 1.0 / probabilities_[drawn]; }
  /// What each drawn firing stands for.
  [[nodiscard]] std::vector<double> Weights(const std::vector<Group>& groups) const;
  /// How many independent items would tell a share as well.
  [[nodiscard]] double EffectiveNumber(double share,
                                       const std::vector<double>& of,
                                       const std::vector<double>& among) const;
  /// The variance of a total.
  [[nodiscard]] double VarianceOf(const std::vector<double>& values,
                                  const std::vector<Group>& groups) const;

  std::map<Stratum, Population> strata_;
  std::vector<Stratum> drawn_;
  std::vector<double> probabilities_;  ///< With which these were drawn.
  std::uint64_t num_firings_ = 0;
};

}  // namespace railcast
