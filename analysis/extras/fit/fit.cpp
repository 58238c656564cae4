#include "analysis/extras/fit/fit.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "railcast/effects.h"

namespace railcast {
namespace {

using Exponents = std::array<double, 2>;  ///< {a, rate}, where P(point) = exp(-(a + rate R)).

/// Root of a falling function of x > 0; 0 if the function is negative from the beginning.
double Crossing(const std::function<double(double)>& falling, double guess) {
  constexpr double kNothing = 1e-12;
  if (falling(kNothing) <= 0.0) return 0.0;
  constexpr double kFactor = 4.0;
  std::uintmax_t max_steps = 200;
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      falling, std::max(guess, 1e-9), kFactor, false, boost::math::tools::eps_tolerance<double>(40),
      max_steps);
  return 0.5 * (low + high);
}

class Likelihood {
 public:
  explicit Likelihood(const std::map<int, LossBin>& bins) {
    for (const auto& [metre, bin] : bins) bins_.push_back(bin);
  }

  [[nodiscard]] double At(const Exponents& value) const {
    double sum = 0.0;
    for (const LossBin& bin : bins_) {
      const double exponent = ExponentOf(bin, value);
      sum += static_cast<double>(bin.num_lost) * std::log(-std::expm1(-exponent)) -
             static_cast<double>(bin.num - bin.num_lost) * exponent;
    }
    return sum;
  }

  /// Derivative of the log likelihood with respect to one of the two exponents.
  [[nodiscard]] double Slope(const Exponents& value, std::size_t which) const {
    double sum = 0.0;
    for (const LossBin& bin : bins_) {
      const double by_exponent =
          static_cast<double>(bin.num_lost) / std::expm1(ExponentOf(bin, value)) -
          static_cast<double>(bin.num - bin.num_lost);
      sum += (which == 0 ? 1.0 : bin.range_m()) * by_exponent;
    }
    return sum;
  }

  /// Fixes one exponent and maximises over the other.
  [[nodiscard]] Exponents Best(std::size_t fixed, double x) const {
    Exponents value{};
    value[fixed] = x;
    value[1 - fixed] = Crossing(
        [&](double y) {
          Exponents tried = value;
          tried[1 - fixed] = y;
          return Slope(tried, 1 - fixed);
        },
        1e-3);
    return value;
  }

 private:
  [[nodiscard]] static double ExponentOf(const LossBin& bin, const Exponents& value) {
    // Positive, since a loss is never impossible.
    return std::max(1e-12, value[0] + value[1] * bin.range_m());
  }

  std::vector<LossBin> bins_;
};

Estimate FitProfile(const Likelihood& likelihood, std::size_t which, std::uint64_t num) {
  // The slope of the profile is that of the likelihood: the derivative by the other exponent is 0,
  // or that exponent is at its bound.
  const double best =
      Crossing([&](double x) { return likelihood.Slope(likelihood.Best(which, x), which); }, 1e-3);
  const double least = likelihood.At(likelihood.Best(which, best)) -
                       0.5 * boost::math::quantile(boost::math::chi_squared(1.0), kConfidence);
  const auto margin = [&](double x) { return likelihood.At(likelihood.Best(which, x)) - least; };
  Estimate estimate{best, 0.0, 0.0, num};
  if (margin(0.0) < 0.0) {
    estimate.low =
        best - Crossing([&](double less) { return margin(std::max(0.0, best - less)); }, best);
  }
  estimate.high = best + Crossing([&](double more) { return margin(best + more); }, best);
  return estimate;
}

constexpr const char* kTooFew = "not identified: fewer than 10 flat pieces of surface";

// Whether an interval reaches from 0 to more than twice the value: the data cannot tell the value
// from 0.
bool IsVague(const Estimate& estimate) {
  return estimate.low == 0.0 && estimate.high > 2.0 * estimate.value;
}

void AddLinearNoise(LinearNoise noise, double typical_range_m, FitResult& result) {
  std::string why = noise.sigma0_m.is_enough() ? "" : kTooFew;
  // Either term may be zero or may account for most of the noise.
  const double half_m = 0.5 * (noise.sigma0_m.value + noise.sigma1.value * typical_range_m);
  const bool is_open = noise.sigma0_m.low == 0.0 && noise.sigma0_m.high > half_m &&
                       noise.sigma1.low == 0.0 && noise.sigma1.high * typical_range_m > half_m;
  if (is_open) {
    noise.sigma0_m = noise.sigma1 = NotEnough(noise.sigma0_m.num);
    why = "not identified: constant and growing noise cannot be told apart at about one range";
  }
  result.parameters.push_back(
      {"lidar/plausibility/noise_sigma0_m", "Noise at range 0", "m", noise.sigma0_m, why});
  result.parameters.push_back(
      {"lidar/plausibility/noise_sigma1", "Noise's growth with range", "", noise.sigma1, why});
}

void AddSignalNoise(const SignalNoise& noise, const FitSettings& settings, FitResult& result) {
  const auto add = [&](const char* place, const char* title, const char* unit, Estimate estimate,
                       const std::string& vague) {
    FittedParameter parameter{place, title, unit, estimate, ""};
    if (!noise.floor_m.is_enough()) {
      parameter.remark = kTooFew;
    } else if (!estimate.is_enough() || IsVague(estimate)) {
      parameter.estimate = NotEnough(estimate.num);
      parameter.remark = vague;
    }
    result.parameters.push_back(parameter);
  };
  const bool knows_signal = settings.has_reflectances && settings.range_at_10_percent_m;
  add("lidar/receiver/range_noise_floor_m", "Range noise at high signal", "m", noise.floor_m,
      "not identified: no beams of high signal");
  add("lidar/receiver/range_noise_scale_m", "Range noise scale", "m", noise.scale_m,
      knows_signal ? "not identified: the noise does not grow as the signal falls"
                   : "not identified: the signal is not known; it wants intensities that are "
                     "reflectances and --range-at-10-percent-m");
  add("lidar/receiver/pointing_jitter_deg", "Pointing jitter", "deg",
      Scaled(noise.pointing_rad, DegFromRad(1.0)),
      "not identified: the noise does not grow with the surfaces' slant");
}

void AddBiases(const ChannelBiases& biases, FitResult& result) {
  result.channels = biases.channels;
  result.parameters.push_back({"", "Scatter of the channels' biases, at least", "m", biases.sigma_m,
                               biases.sigma_m.is_enough()
                                   ? "the planes of the pieces take a part of it out"
                                   : "not identified: fewer than 10 channels with 50 points each"});
}

void AddNoiseBins(const RecordedTrials& recorded,
                  const std::vector<double>& fitted_m,
                  FitResult& result) {
  const std::vector<NoiseTrial>& trials = recorded.noise;
  constexpr std::size_t kMaxBins = 30;
  constexpr std::size_t kMinOfBin = 100;
  std::vector<std::size_t> order(trials.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return trials[a].range_m < trials[b].range_m;
  });
  const std::size_t num_bins = std::min(kMaxBins, order.size() / kMinOfBin);
  for (std::size_t bin = 0; bin < num_bins; ++bin) {
    const std::size_t begin = order.size() * bin / num_bins;
    const std::size_t end = order.size() * (bin + 1) / num_bins;
    const auto num = static_cast<double>(end - begin);
    NoiseBin sum;
    std::vector<double> residuals_m;
    for (std::size_t k = begin; k < end; ++k) {
      sum.range_m += static_cast<double>(trials[order[k]].range_m) / num;
      sum.fitted_m += fitted_m[order[k]] * fitted_m[order[k]] / num;
      residuals_m.push_back(static_cast<double>(trials[order[k]].residual_m));
    }
    sum.fitted_m = std::sqrt(sum.fitted_m);
    sum.sigma_m = NoiseOf(std::move(residuals_m), recorded.step_m, result.noise_from);
    result.noise_by_range.push_back(sum);
  }
}

std::string StepRemark(double step_m) {
  return step_m > 0.0
             ? "before rounding: the ranges come in steps of " + ShortText(1e3 * step_m) + " mm"
             : "";
}

/// What the steps leave open of all noise, they leave open of its parts.
void WidenBySteps(const Estimate& sigma_m, double step_m, FittedParameter& parameter) {
  if (!parameter.estimate.is_enough()) return;
  if (!(sigma_m.low > 0.0)) {
    parameter.estimate = NotEnough(parameter.estimate.num);
    parameter.remark = "not identified: the ranges come in steps of " + ShortText(1e3 * step_m) +
                       " mm, which hide the noise";
    return;
  }
  const double open = std::max(sigma_m.high / sigma_m.value, sigma_m.value / sigma_m.low);
  parameter.estimate.low /= open;
  parameter.estimate.high *= open;
}

void FitNoise(RecordedTrials& trials, const FitSettings& settings, FitResult& result) {
  const ChannelBiases biases = TakeOutChannels(trials);
  result.noise_from = TakeLeastNoise(trials);
  const bool knows_signal = settings.has_reflectances && settings.range_at_10_percent_m;
  if (settings.is_physical && knows_signal) {
    std::erase_if(trials.noise, [](const NoiseTrial& trial) { return !(trial.intensity > 0.0F); });
  }
  std::vector<double> residuals_m, ranges_m, fitted_m;
  for (const NoiseTrial& trial : trials.noise) {
    residuals_m.push_back(static_cast<double>(trial.residual_m));
    ranges_m.push_back(static_cast<double>(trial.range_m));
  }
  const Estimate sigma_m = NoiseOf(std::move(residuals_m), trials.step_m, result.noise_from);
  const std::string of_steps = StepRemark(trials.step_m);
  result.parameters.push_back({"", "Noise, whatever range and signal", "m", sigma_m,
                               sigma_m.is_enough() ? of_steps : "not identified: too few points"});
  std::vector<NoiseTrial> noise_trials = trials.noise;
  const std::size_t num_before = result.parameters.size();
  if (sigma_m.is_enough() && !of_steps.empty()) {
    TakeOutSteps(trials, sigma_m.value, result.noise_from, settings.is_physical, noise_trials);
  }
  if (settings.is_physical) {
    std::vector<double> inverse_snr;
    if (knows_signal) inverse_snr = InverseSnr(noise_trials, settings);
    const SignalNoise noise = FitSignalNoise(noise_trials, inverse_snr);
    for (std::size_t i = 0; i < noise_trials.size(); ++i) {
      fitted_m.push_back(noise.At(noise_trials[i], knows_signal ? inverse_snr[i] : 0.0));
    }
    AddSignalNoise(noise, settings, result);
  } else {
    const LinearNoise noise = FitLinearNoise(noise_trials);
    for (const NoiseTrial& trial : noise_trials) fitted_m.push_back(noise.At(trial));
    AddLinearNoise(noise, Median(ranges_m).value, result);
  }
  for (std::size_t i = num_before; i < result.parameters.size() && !of_steps.empty(); ++i) {
    WidenBySteps(sigma_m, trials.step_m, result.parameters[i]);
  }
  if (settings.is_physical) AddBiases(biases, result);
  AddNoiseBins(trials, fitted_m, result);
}

void AddLosses(const RecordedTrials& trials, const FitSettings& settings, FitResult& result) {
  result.loss = FitRandomLoss(trials.losses);
  const char* const why =
      trials.losses.empty()
          ? "not identified: the recording has points only, what is lost leaves no trace"
          : "not identified: too few firings between points of one surface";
  const bool is_enough = result.loss.rate_per_m.is_enough();
  result.parameters.push_back({"lidar/plausibility/dropout_probability", "Dropout probability", "",
                               result.loss.probability, is_enough ? "" : why});
  result.parameters.push_back(
      {"", "Growth of the losses with range", "1/m", result.loss.rate_per_m, is_enough ? "" : why});
  if (settings.is_physical) return;
  const WeatherSpec weather;
  FittedParameter per_rain{"weather/rain_dropout_per_m", "Rain dropout rate k at 1 mm/h", "1/m",
                           NotEnough(result.loss.rate_per_m.num), is_enough ? "" : why};
  if (is_enough && settings.rain_rate_mmph) {
    const double growth = std::pow(*settings.rain_rate_mmph, weather.rain_dropout_exponent);
    per_rain.estimate = Scaled(result.loss.rate_per_m, 1.0 / growth);
    per_rain.remark = "takes all growth for rain's, with the usual exponent e = 0.63";
  } else if (is_enough) {
    per_rain.remark = "not identified: only k x rain rate^e is; give --rain-rate-mmph";
  }
  result.parameters.push_back(per_rain);
}

}  // namespace

double RandomLoss::At(double range_m) const {
  return 1.0 - (1.0 - probability.value) * std::exp(-rate_per_m.value * range_m);
}

RandomLoss FitRandomLoss(const std::map<int, LossBin>& bins) {
  std::uint64_t num = 0;
  std::uint64_t num_lost = 0;
  for (const auto& [metre, bin] : bins) {
    num += bin.num;
    num_lost += bin.num_lost;
  }
  // If every firing was lost, the likelihood grows with the rate without bound.
  if (num < kMinSamples || num_lost == num) return {NotEnough(num), NotEnough(num)};
  const Likelihood likelihood(bins);
  const auto share = [](double exponent) { return -std::expm1(-exponent); };
  const Estimate a = FitProfile(likelihood, 0, num);
  return {{share(a.value), share(a.low), share(a.high), num}, FitProfile(likelihood, 1, num)};
}

std::vector<double> InverseSnr(const std::vector<NoiseTrial>& trials, const FitSettings& settings) {
  constexpr double kDataSheetReflectance = 0.1;
  std::vector<double> inverse;
  for (const NoiseTrial& trial : trials) {
    const double share = static_cast<double>(trial.range_m) / *settings.range_at_10_percent_m;
    const double power =
        static_cast<double>(trial.intensity) / (kDataSheetReflectance * share * share);
    inverse.push_back(1.0 / (2.0 * settings.snr_at_threshold * power));
  }
  return inverse;
}

void AddIntensities(const ReceiverFigures& figures, FitResult& result) {
  const auto add = [&](const char* place, const char* title, Estimate estimate,
                       const std::string& too_few) {
    FittedParameter parameter{place, title, "", estimate, ""};
    if (!estimate.is_enough()) {
      parameter.remark = "not identified: " + too_few;
    } else if (estimate.low <= 0.0) {
      parameter.estimate = NotEnough(estimate.num);
      parameter.remark = "not identified: its interval holds 0";
    } else {
      Estimate& of = parameter.estimate;
      for (double* const end : {&of.value, &of.low, &of.high}) *end = RelativeDeviation(*end);
    }
    result.parameters.push_back(parameter);
  };
  add("lidar/receiver/intensity_noise", "Intensity noise", figures.intensity_noise.robust,
      figures.has_moved ? "the sensor moved"
                        : "fewer than two turns, or too few smooth surfaces of 0.12 to 0.25");
  const std::string too_few_channels = "too few channels with smooth surfaces";
  add("lidar/receiver/channel_gain", "Gain of single channels",
      figures.gain_by_range.low > 0.0 ? figures.gain_at_all_ranges : figures.channel_gain,
      too_few_channels);
  add("lidar/receiver/channel_gain_variation", "Gain of single channels by range",
      figures.gain_by_range, too_few_channels);
}

FitResult FitModel(RecordedTrials& trials, const FitSettings& settings) {
  FitResult result;
  FitNoise(trials, settings, result);
  AddLosses(trials, settings, result);
  return result;
}

}  // namespace railcast
