#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/extras/fit/recorded_trials.h"
#include "analysis/extras/preset/receiver_figures.h"

namespace railcast {

/// Range error of a single channel.
struct ChannelBias {
  std::uint16_t channel{};
  Estimate bias_m;
};

/// Constant range errors of the channels.
struct ChannelBiases {
  std::vector<ChannelBias> channels;  ///< Medians of their residuals, uncorrected.
  /// Standard deviation of the medians, corrected for their own errors. That of the true biases is
  /// larger, since the fitted planes of the pieces have absorbed a part of them.
  Estimate sigma_m;
};

/// Subtracts each channel's median from its residuals, in place; channels with fewer than 50
/// residuals stay as they are.
[[nodiscard]] ChannelBiases TakeOutChannels(RecordedTrials& trials);

/// What the noise is measured by.
enum class NoiseFrom : std::uint8_t {
  kPieces,      ///< The distances from the pieces' planes; roughness counts as noise.
  kNeighbours,  ///< The second differences along the rings; roughness between neighbours counts.
  kTurns,       ///< The changes from frame to frame of a standing sensor; no roughness counts.
};

/// Takes for the residuals what has least besides noise. Where there are at least 500 changes from
/// frame to frame that are smaller than the residuals, it is these: then the sensor stood, or moved
/// by less than the surfaces' roughness. Else it is the second differences, if there are as many
/// and their interval ends below 0.8 of the residuals' scatter. Points without either are left out.
NoiseFrom TakeLeastNoise(RecordedTrials& trials);

/// The robust standard deviation of residuals. Where ranges come in steps, it is that before
/// rounding; of second differences, whose three ranges are all rounded, a part of it stays.
[[nodiscard]] Estimate NoiseOf(std::vector<double> residuals_m, double step_m, NoiseFrom from);

/// Takes the steps of ranges out of the residuals, so that models can be fitted to them: spreads
/// each over its step, and scales all so that fits of a constant give that before rounding.
/// @param is_physical Whether FitSignalNoise() follows, else FitLinearNoise().
void TakeOutSteps(const RecordedTrials& trials,
                  double sigma_m,
                  NoiseFrom from,
                  bool is_physical,
                  std::vector<NoiseTrial>& noise);

/// sigma = sigma0 + sigma1 R, both >= 0.
struct LinearNoise {
  Estimate sigma0_m;
  Estimate sigma1;

  [[nodiscard]] double At(const NoiseTrial& trial) const {
    return sigma0_m.value + sigma1.value * static_cast<double>(trial.range_m);
  }
};

/// sigma^2 = floor^2 + scale^2 / (2 SNR) + (pointing slant)^2, all >= 0.
struct SignalNoise {
  Estimate floor_m;
  Estimate scale_m;  ///< Not enough where the signal is not known.
  Estimate pointing_rad;

  /// @param inverse_snr 1 / (2 SNR); 0 where the signal is not known.
  [[nodiscard]] double At(const NoiseTrial& trial, double inverse_snr) const;
};

// Both models are fitted to the residuals themselves: generalized least squares of |residual|, or
// of its square, with errors that are proportional to the expectation; trimmed at 3 sigma and
// corrected so that the result holds for normal samples. Intervals: the sandwich covariance (Huber
// 1967) with the pieces as clusters, since the points of one piece share its roughness, and
// Student's quantile. At least kMinSamples pieces are needed.

[[nodiscard]] LinearNoise FitLinearNoise(const std::vector<NoiseTrial>& trials);

/// @param inverse_snr 1 / (2 SNR) of each trial; empty if not known.
[[nodiscard]] SignalNoise FitSignalNoise(const std::vector<NoiseTrial>& trials,
                                         const std::vector<double>& inverse_snr);

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
  NoiseFrom noise_from{};  ///< As TakeLeastNoise() found it.
};

/// 1 / (2 SNR) of each trial. The SNR is known at the data sheet's range; it is proportional to the
/// received power, that is to reflectance / range^2.
/// @pre The settings have a range and reflectances.
[[nodiscard]] std::vector<double> InverseSnr(const std::vector<NoiseTrial>& trials,
                                             const FitSettings& settings);

/// Adds noise and gain of the intensities as `preset` measures them. No replay judges them.
/// @param figures Of intensities that are reflectances.
void AddIntensities(const ReceiverFigures& figures, FitResult& result);

/// Estimates every parameter that the trials identify.
/// @param trials The channels' biases are subtracted from their residuals, in place.
[[nodiscard]] FitResult FitModel(RecordedTrials& trials, const FitSettings& settings);

}  // namespace railcast
