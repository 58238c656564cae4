// Checks that a model fitted to one half of a real scene predicts the other half better than a
// constant does.
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/extras/fit/fit.h"
#include "analysis/extras/fit/recorded_trials.h"
#include "tests/analysis/extras/fit/real_capture.h"

namespace railcast {
namespace {

constexpr std::size_t kNumSectors = 12;

// The trials of every second sector of 30 degrees; the points of the others are removed.
RecordedTrials TrialsOfHalf(const std::vector<RecordedFrame>& frames, std::size_t half) {
  RecordedTrials trials;
  for (RecordedFrame recorded : frames) {
    Frame& frame = recorded.frame;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const std::size_t column = slot % frame.width();
      if (column * kNumSectors / frame.width() % 2 == half) continue;
      frame.x[slot] = frame.y[slot] = frame.z[slot] = frame.range_m[slot] =
          std::numeric_limits<float>::quiet_NaN();
    }
    trials.Add(TakeTrials(recorded));
  }
  return trials;
}

struct Halves {
  RecordedTrials fitted;
  RecordedTrials held_out;
};

std::vector<Halves> MakeHalves() {
  const std::vector<RecordedFrame> frames = ReadVls128();
  EXPECT_EQ(frames.size(), 3U);
  const RecordedTrials first = TrialsOfHalf(frames, 0);
  const RecordedTrials second = TrialsOfHalf(frames, 1);
  return {{first, second}, {second, first}};
}

std::string Text(const Estimate& estimate) {
  std::ostringstream text;
  text << std::setprecision(3) << estimate.value << " [" << estimate.low << ", " << estimate.high
       << "]";
  return text.str();
}

double LogLikelihood(const LossBin& bin, double loss) {
  return static_cast<double>(bin.num_lost) * std::log(loss) +
         static_cast<double>(bin.num - bin.num_lost) * std::log1p(-loss);
}

double ShareLost(const std::map<int, LossBin>& bins) {
  double num = 0.0, num_lost = 0.0;
  for (const auto& [metre, bin] : bins) {
    num += static_cast<double>(bin.num);
    num_lost += static_cast<double>(bin.num_lost);
  }
  return num_lost / num;
}

TEST(FitOfVls128, PredictsHeldOutLossesBetterThanOneShareForAllRanges) {
  if (!std::filesystem::exists(kVls128Capture)) GTEST_SKIP() << "no " << kVls128Capture;
  for (const auto& [fitted, held_out] : MakeHalves()) {
    const RandomLoss loss = FitRandomLoss(fitted.losses);
    const double share = ShareLost(fitted.losses);
    double gain = 0.0, num_lost = 0.0;
    for (const auto& [metre, bin] : held_out.losses) {
      gain += LogLikelihood(bin, loss.At(bin.range_m())) - LogLikelihood(bin, share);
      num_lost += static_cast<double>(bin.num_lost);
    }
    std::cout << "probability " << Text(loss.probability) << ", rate " << Text(loss.rate_per_m)
              << ": gain of " << gain << " over " << share << ", of " << num_lost << " lost\n";
    EXPECT_GT(gain, 0.05 * num_lost);
  }
}

// Student's t with 4 degrees of freedom, so that outliers not caused by the sensor, such as a
// curved wall, do not dominate.
double LogDensity(double residual_m, double sigma_m) {
  constexpr double kDegrees = 4.0;
  const double pull = residual_m / sigma_m;
  return -std::log(sigma_m) - 0.5 * (kDegrees + 1.0) * std::log1p(pull * pull / kDegrees);
}

double ScaleOf(const std::vector<NoiseTrial>& trials) {
  std::vector<double> residuals_m;
  for (const NoiseTrial& trial : trials)
    residuals_m.push_back(static_cast<double>(trial.residual_m));
  return PlainRobustScale(residuals_m);
}

template <typename Fitted>
double GainOver(double sigma_m, const std::vector<NoiseTrial>& trials, const Fitted& fitted_m) {
  double gain = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto residual_m = static_cast<double>(trials[i].residual_m);
    gain += LogDensity(residual_m, fitted_m(i)) - LogDensity(residual_m, sigma_m);
  }
  return gain / static_cast<double>(trials.size());
}

TEST(FitOfVls128, PredictsHeldOutNoiseBetterThanOneScaleForAllPoints) {
  if (!std::filesystem::exists(kVls128Capture)) GTEST_SKIP() << "no " << kVls128Capture;
  FitSettings settings;
  settings.range_at_10_percent_m = 220.0;  // From its data sheet.
  settings.snr_at_threshold = 5.0;
  for (auto& [fitted, held_out] : MakeHalves()) {
    const auto has_no_signal = [](const NoiseTrial& trial) { return !(trial.intensity > 0.0F); };
    std::erase_if(fitted.noise, has_no_signal);
    std::erase_if(held_out.noise, has_no_signal);
    const double sigma_m = ScaleOf(fitted.noise);
    const LinearNoise linear = FitLinearNoise(fitted.noise);
    const SignalNoise floor = FitSignalNoise(fitted.noise, {});
    const SignalNoise signal = FitSignalNoise(fitted.noise, InverseSnr(fitted.noise, settings));
    const std::vector<NoiseTrial>& trials = held_out.noise;
    const std::vector<double> inverse_snr = InverseSnr(trials, settings);
    const auto linear_m = [&](std::size_t i) { return linear.At(trials[i]); };
    const auto floor_m = [&](std::size_t i) { return floor.At(trials[i], 0.0); };
    const auto signal_m = [&](std::size_t i) { return signal.At(trials[i], inverse_snr[i]); };
    const double linear_gain = GainOver(sigma_m, trials, linear_m);
    const double floor_gain = GainOver(sigma_m, trials, floor_m);
    const double signal_gain = GainOver(sigma_m, trials, signal_m);
    std::cout << "gain per point: line " << linear_gain << ", floor and pointing " << floor_gain
              << ", signal, too " << signal_gain << "\n"
              << "sigma0 " << Text(linear.sigma0_m) << ", sigma1 " << Text(linear.sigma1)
              << ", floor " << Text(signal.floor_m) << ", scale " << Text(signal.scale_m)
              << ", pointing " << Text(signal.pointing_rad) << "; " << trials.size()
              << " points held out\n";
    EXPECT_GT(linear_gain, 0.04);
    EXPECT_GT(floor_gain, 0.04);
    // The signal predicts the noise better than range and slant alone.
    EXPECT_GT(signal_gain, floor_gain + 0.004);
  }
}

// Channels with a positive bias in one half of the scene have it in the other half, too.
TEST(FitOfVls128, FindsTheSameBiasesOfTheChannelsInBothHalves) {
  if (!std::filesystem::exists(kVls128Capture)) GTEST_SKIP() << "no " << kVls128Capture;
  Halves halves = MakeHalves().front();
  std::map<std::uint16_t, double> bias_m;
  for (const ChannelBias& bias : TakeOutChannels(halves.fitted).channels) {
    bias_m[bias.channel] = bias.bias_m.value;
  }
  double both = 0.0, first = 0.0, second = 0.0;
  int num = 0;
  for (const ChannelBias& bias : TakeOutChannels(halves.held_out).channels) {
    if (!bias_m.contains(bias.channel)) continue;
    const double other_m = bias_m[bias.channel];
    both += other_m * bias.bias_m.value;
    first += other_m * other_m;
    second += bias.bias_m.value * bias.bias_m.value;
    ++num;
  }
  const double correlation = both / std::sqrt(first * second);
  std::cout << num << " channels, correlation " << correlation << "\n";
  EXPECT_GT(correlation, 0.3);
}

}  // namespace
}  // namespace railcast
