#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/recorded_trials.h"

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

/// Takes the changes from frame to frame for the residuals, where they are at least 500 and
/// smaller: then the sensor stood, and the surfaces' roughness is in the residuals alone. Points
/// without a change are left out.
/// @returns Whether it did.
bool TakeChanges(RecordedTrials& trials);

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

}  // namespace railcast
