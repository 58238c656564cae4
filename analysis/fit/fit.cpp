#include "analysis/fit/fit.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/robust.h"
#include "analysis/fit/fit_threshold.h"
#include "analysis/fit/reflectance.h"
#include "core/base/units.h"

namespace railcast {
namespace {

// Points so far from the surface, in robust scales of those at about the same range, are of
// something else.
void MarkElsewhere(std::vector<Trial>& trials) {
  constexpr std::size_t kSamplesOfBin = 500;
  constexpr double kGateInScales = 8.0;
  constexpr double kLeastGate_m = 0.05;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (trials[i].answer == Answer::kReturned) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return trials[a].expected_m < trials[b].expected_m;
  });
  const std::size_t num_bins = std::max<std::size_t>(1, order.size() / kSamplesOfBin);
  for (std::size_t bin = 0; bin < num_bins; ++bin) {
    const std::size_t begin = order.size() * bin / num_bins;
    const std::size_t end = order.size() * (bin + 1) / num_bins;
    std::vector<double> residuals;
    for (std::size_t k = begin; k < end; ++k) {
      residuals.push_back(static_cast<double>(trials[order[k]].residual_m));
    }
    const double median = Median(residuals).value;
    const double gate_m = std::max(kLeastGate_m, kGateInScales * RobustScale(residuals).value);
    // Too few to say: NaN marks none.
    for (std::size_t k = begin; k < end; ++k) {
      Trial& trial = trials[order[k]];
      if (std::abs(static_cast<double>(trial.residual_m) - median) > gate_m) {
        trial.answer = Answer::kElsewhere;
      }
    }
  }
}

void CountTrials(const std::vector<Trial>& trials,
                 const std::vector<FitSurface>& surfaces,
                 FitResult& result) {
  std::vector<SurfaceFit> fits(surfaces.size());
  for (const Trial& trial : trials) {
    SurfaceFit& fit = fits[trial.surface];
    ++fit.num_trials;
    fit.num_returned += trial.answer == Answer::kReturned ? 1 : 0;
    ++result.num_trials;
    result.num_lost += trial.answer == Answer::kLost ? 1 : 0;
    result.num_elsewhere += trial.answer == Answer::kElsewhere ? 1 : 0;
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (fits[i].num_trials == 0) continue;
    fits[i].name = surfaces[i].name;
    result.surfaces.push_back(fits[i]);
    result.surface_ids.push_back(static_cast<std::uint16_t>(i));
  }
}

ShapedAnswer ShapeOf(const Trial& trial, const FitSurface& surface, const FitSettings& settings) {
  const auto cosine = static_cast<double>(trial.cos_incidence);
  return settings.is_physical ? AnswerOf(surface, cosine) : ShapedAnswer{cosine, 0.0};
}

void FitReflectances(const std::vector<Trial>& trials,
                     const std::vector<FitSurface>& surfaces,
                     const FitSettings& settings,
                     FitResult& result) {
  std::vector<std::vector<IntensitySample>> samples(surfaces.size());
  for (const Trial& trial : trials) {
    if (trial.answer != Answer::kReturned || std::isnan(trial.intensity)) continue;
    const ShapedAnswer shape = ShapeOf(trial, surfaces[trial.surface], settings);
    samples[trial.surface].push_back(
        {shape.diffuse, shape.lobe, static_cast<double>(trial.intensity)});
  }
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    SurfaceFit& fit = result.surfaces[i];
    fit.reflectance = FitReflectance(samples[result.surface_ids[i]]);
  }
}

void AddLinearNoise(LinearNoise noise, FitResult& result) {
  std::string why = "not identified: too few points";
  if (noise.sigma0_m.is_enough()) {
    const std::vector<NoiseBin>& bins = result.noise_by_range;
    const NoiseBin& middle = bins[bins.size() / 2];
    // Either may be nothing, or most of it.
    const double half_m = 0.5 * middle.sigma_m.value;
    const bool is_open = noise.sigma0_m.low == 0.0 && noise.sigma0_m.high > half_m &&
                         noise.sigma1.low == 0.0 && noise.sigma1.high * middle.range_m > half_m;
    if (is_open) {
      noise.sigma0_m = noise.sigma1 = NotEnough(noise.sigma0_m.num);
      why = "not identified: constant and growing noise cannot be told apart at about one range";
    } else {
      why.clear();
    }
  }
  result.parameters.push_back(
      {"lidar/plausibility/noise_sigma0_m", "Noise at range 0", "m", noise.sigma0_m, why});
  result.parameters.push_back(
      {"lidar/plausibility/noise_sigma1", "Noise's growth with range", "", noise.sigma1, why});
}

// An interval that reaches from 0 to twice the value and more: the data do not tell it from 0.
bool IsVague(const Estimate& estimate) {
  return estimate.low == 0.0 && estimate.high > 2.0 * estimate.value;
}

// Of all signals there are: known also where the threshold is not, and with it no signal.
void AddPlainNoise(const std::vector<Trial>& trials, FitResult& result) {
  std::vector<double> residuals_m;
  for (const Trial& trial : trials) {
    if (trial.answer == Answer::kReturned) {
      residuals_m.push_back(static_cast<double>(trial.residual_m));
    }
  }
  const Estimate sigma_m = RobustScale(residuals_m);
  result.parameters.push_back({"", "Noise, whatever range and signal", "m", sigma_m,
                               sigma_m.is_enough() ? "" : "not identified: too few points"});
}

void AddSignalNoise(const SignalNoise& noise, FitResult& result) {
  const auto add = [&](const char* place, const char* title, const char* unit, Estimate estimate,
                       const char* vague) {
    FittedParameter parameter{place, title, unit, estimate, ""};
    if (!estimate.is_enough()) {
      parameter.remark = std::isnan(result.snr_at_threshold)
                             ? "not identified: the signal-to-noise ratio is not known, since no "
                               "threshold is"
                             : "not identified: too few points of known power";
    } else if (IsVague(estimate)) {
      parameter.estimate = NotEnough(estimate.num);
      parameter.remark = vague;
    }
    result.parameters.push_back(parameter);
  };
  add("lidar/receiver/range_noise_floor_m", "Range noise at high signal", "m", noise.floor_m,
      "not identified: no beams of high signal");
  add("lidar/receiver/range_noise_scale_m", "Range noise scale", "m", noise.scale_m,
      "not identified: the noise does not grow towards the threshold");
  if (noise.pointing_rad.is_enough()) {
    add("lidar/receiver/pointing_jitter_deg", "Pointing jitter", "deg",
        Scaled(noise.pointing_rad, DegFromRad(1.0)),
        "not identified: the noise does not grow with the surfaces' slant");
  }
  FittedParameter bias{"lidar/receiver/channel_bias_sigma_m", "Scatter of the channels' biases",
                       "m", result.residuals.bias_sigma_m, ""};
  if (!bias.estimate.is_enough())
    bias.remark = "not identified: fewer than 10 channels with points";
  result.parameters.push_back(bias);
}

void FitNoise(std::vector<Trial>& trials,
              const std::vector<FitSurface>& surfaces,
              const FitSettings& settings,
              FitResult& result) {
  result.residuals = TakeOutChannels(trials);
  std::vector<double> range_m, inverse_snr;
  std::vector<std::size_t> place_of(surfaces.size(), 0);
  for (std::size_t i = 0; i < result.surface_ids.size(); ++i) place_of[result.surface_ids[i]] = i;
  for (const Trial& trial : trials) {
    range_m.push_back(static_cast<double>(trial.expected_m));
    const double power = settings.is_physical ? PowerOf(trial, surfaces[trial.surface],
                                                        result.surfaces[place_of[trial.surface]],
                                                        settings, result.extinction_per_m)
                                              : std::numeric_limits<double>::quiet_NaN();
    inverse_snr.push_back(1.0 / (2.0 * result.snr_at_threshold * power));
  }
  result.noise_by_range = BinNoise(trials, range_m, inverse_snr);
  AddPlainNoise(trials, result);
  if (!settings.is_physical) {
    AddLinearNoise(FitLinearNoise(result.noise_by_range), result);
    return;
  }
  result.noise_by_power = BinNoise(trials, inverse_snr, inverse_snr);
  SignalNoise noise = FitSignalNoise(result.noise_by_power);
  if (noise.scale_m.is_enough()) {
    // scale^2 is a slope x SNR.
    const double value_m = noise.scale_m.value;
    const double share = 1.96 * 0.5 * result.log_snr_error * value_m;
    noise.scale_m.low = std::max(0.0, value_m - std::hypot(value_m - noise.scale_m.low, share));
    noise.scale_m.high = value_m + std::hypot(noise.scale_m.high - value_m, share);
  }
  AddSignalNoise(noise, result);
}

}  // namespace

double PowerOf(const Trial& trial,
               const FitSurface& surface,
               const SurfaceFit& fit,
               const FitSettings& settings,
               double extinction_per_m) {
  const ShapedAnswer shape = ShapeOf(trial, surface, settings);
  const auto range_m = static_cast<double>(trial.expected_m);
  const double stretch = settings.is_physical ? static_cast<double>(trial.stretch) : 1.0;
  const double air_ways = settings.is_physical ? 2.0 : 1.0;
  return (fit.power_at_1m * shape.diffuse + fit.lobe_scale * shape.lobe) * stretch *
         std::exp(-air_ways * extinction_per_m * range_m) / (range_m * range_m);
}

FitResult FitModel(std::vector<Trial>& trials,
                   const std::vector<FitSurface>& surfaces,
                   const FitSettings& settings) {
  MarkElsewhere(trials);
  FitResult result;
  CountTrials(trials, surfaces, result);
  if (settings.has_reflectances) FitReflectances(trials, surfaces, settings, result);
  FitThreshold(trials, surfaces, settings, result);
  FitNoise(trials, surfaces, settings, result);
  return result;
}

}  // namespace railcast
