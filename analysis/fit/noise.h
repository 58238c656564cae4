#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/trial.h"

namespace railcast {

/// The scatter of what is alike in range or power.
struct NoiseBin {
  double range_m{};      ///< Mean of its samples.
  double inverse_snr{};  ///< Mean of 1 / (2 SNR); NaN where power is not known.
  double slant2{};       ///< Mean of slant squared, m^2 / rad^2.
  Estimate sigma_m;      ///< Robust.
};

/// Range error of a channel alone.
struct ChannelBias {
  std::uint16_t channel{};
  Estimate bias_m;
};

/// Residuals of channels as they are, each less its median, which is the channel's bias.
struct Residuals {
  std::vector<ChannelBias> channels;
  /// Standard deviation of the biases, less what the medians' own errors make.
  Estimate bias_sigma_m;
  Estimate bias_m;  ///< Median of all.
};

/// Takes each channel's median from its residuals, in place; those of channels with fewer than
/// kMinOfChannel become NaN. Only kReturned trials have one.
inline constexpr std::uint64_t kMinOfChannel = 50;
[[nodiscard]] Residuals TakeOutChannels(std::vector<Trial>& trials);

/// Bins of equal count by `key` (same length as trials, NaN = left out), at least kMinOfBin each.
inline constexpr std::size_t kMinOfBin = 100;
[[nodiscard]] std::vector<NoiseBin> BinNoise(const std::vector<Trial>& trials,
                                             const std::vector<double>& keys,
                                             const std::vector<double>& inverse_snr);

/// sigma = sigma0 + sigma1 R, both >= 0: weighted least squares over the bins, Huber's weights for
/// bins that fall out of line. Intervals: Student's, from the bins' own errors or their scatter
/// about the line, whichever is wider.
struct LinearNoise {
  Estimate sigma0_m;
  Estimate sigma1;
};
[[nodiscard]] LinearNoise FitLinearNoise(const std::vector<NoiseBin>& bins);

/// sigma^2 = floor^2 + scale^2 / (2 SNR) + (pointing slant)^2, all >= 0, likewise on the squares.
/// What the bins' range of SNR or slant does not tell apart has an interval from 0.
struct SignalNoise {
  Estimate floor_m;
  Estimate scale_m;
  Estimate pointing_rad;  ///< Not enough where no trial has a slant.
};
[[nodiscard]] SignalNoise FitSignalNoise(const std::vector<NoiseBin>& bins);

}  // namespace railcast
