#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/noise.h"
#include "analysis/fit/recorded_trials.h"

namespace railcast {

/// Random losses of firings that meet a surface: P(point) = (1 - probability) exp(-rate R).
struct RandomLoss {
  Estimate probability;
  Estimate rate_per_m;

  /// P(no point); NaN where nothing was fitted.
  [[nodiscard]] double At(double range_m) const;
};

/// Maximum likelihood under probability >= 0 and rate >= 0; with a = -log(1 - probability) it is
/// concave in (a, rate). The intervals come from the profile likelihood, which also holds at 0:
/// they contain all values of one parameter for which the best fit over the other has 2 log
/// likelihood less than the maximum by at most the quantile of chi-squared with one degree of
/// freedom. Firings are assumed to be independent; those on one dark spot are not.
[[nodiscard]] RandomLoss FitRandomLoss(const std::map<int, LossBin>& bins);

/// Which rung's parameters to fit, and what is known beforehand.
struct FitSettings {
  bool is_physical{};            ///< Rung surface if true, else plausibility.
  bool has_reflectances = true;  ///< Whether recorded intensities are effective reflectances.
  std::optional<double> range_at_10_percent_m;  ///< From the data sheet; determines the signal.
  double snr_at_threshold{};                    ///< Signal-to-noise ratio at that range.
  /// Separates the dropout by rain from the sensor's own.
  std::optional<double> rain_rate_mmph;
};

/// What a replay says of a fitted parameter.
enum class ReplayVerdict { kNotTold, kBetter, kWorse };

/// The simulated over the recorded value of the figure by which a parameter is judged, without and
/// with its fitted value.
struct ParameterProof {
  std::string figure;  ///< Empty if nothing was replayed.
  double before = std::numeric_limits<double>::quiet_NaN();
  double after = std::numeric_limits<double>::quiet_NaN();
  ReplayVerdict verdict = ReplayVerdict::kNotTold;
};

/// The estimate of one parameter of a scenario.
struct FittedParameter {
  std::string place;  ///< Path in a scenario: "lidar/receiver/range_noise_floor_m".
  std::string title;
  std::string unit;
  Estimate estimate;   ///< Without a value where the data do not identify it.
  std::string remark;  ///< Why there is no value, or what the value rests on; may be empty.
  ParameterProof proof{};

  /// Whether the value belongs into a scenario.
  [[nodiscard]] bool is_written() const {
    return estimate.is_enough() && !place.empty() && proof.verdict != ReplayVerdict::kWorse;
  }
};

/// The scatter of the trials at similar ranges.
struct NoiseBin {
  double range_m{};   ///< Mean range.
  Estimate sigma_m;   ///< Robust standard deviation.
  double fitted_m{};  ///< Root mean square of the fitted noise; NaN where nothing was fitted.
};

/// The result of a fit.
struct FitResult {
  std::vector<FittedParameter> parameters;
  std::vector<ChannelBias> channels;
  std::vector<NoiseBin> noise_by_range;
  RandomLoss loss;
  bool
      is_from_turn_to_turn{};  ///< Whether the noise is, and not that about pieces (TakeChanges()).
};

/// 1 / (2 SNR) of each trial. The SNR is known at the data sheet's range; it is proportional to the
/// received power, that is to reflectance / range^2.
/// @pre The settings have a range and reflectances.
[[nodiscard]] std::vector<double> InverseSnr(const std::vector<NoiseTrial>& trials,
                                             const FitSettings& settings);

/// Estimates every parameter that the trials identify.
/// @param trials The channels' biases are subtracted from their residuals, in place.
[[nodiscard]] FitResult FitModel(RecordedTrials& trials, const FitSettings& settings);

}  // namespace railcast
