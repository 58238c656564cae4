#include "analysis/fit/fit_threshold.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/estimate/intervals.h"
#include "analysis/fit/settle_threshold.h"
#include "analysis/fit/threshold_findings.h"

namespace railcast {
namespace {

// The SNR at the threshold is known by the slope of a curve only: a factor of two either way.
constexpr double kMaxLogSnrError = 0.35;
// The relative error of the known reflectances in group 0, by how many trials rest on each.
double ScaleError(const SettledThreshold& settled, const FitResult& result) {
  double weight = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    const SurfaceFit& surface = result.surfaces[i];
    if (settled.groups.of_surface[i] != 0 || !surface.reflectance.is_enough()) continue;
    const auto num = static_cast<double>(surface.num_trials);
    const double error = 0.5 * (surface.reflectance.high - surface.reflectance.low) / 1.96 /
                         surface.reflectance.value;
    weight += num;
    variance += num * num * error * error;
  }
  return weight > 0.0 ? std::sqrt(variance) / weight : 0.0;
}

// Of SNR at the threshold x power, over the groups that are seen.
double LogSnrError(const SettledThreshold& settled) {
  if (!settled.is_seen) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd& covariance = settled.detection.covariance;
  const Eigen::Index snr = settled.detection.snr_place();
  double variance = 0.0, num = 0.0;
  for (Eigen::Index g = 0; g < settled.detection.theta.size(); ++g) {
    if (std::isnan(settled.detection.theta[g])) continue;
    variance += covariance(g, g) + 2.0 * covariance(g, snr);
    num += 1.0;
  }
  return std::sqrt(std::max(0.0, covariance(snr, snr) + variance / num));
}

FittedParameter ThresholdParameter(const SettledThreshold& settled,
                                   const FitSettings& settings,
                                   const FitResult& result) {
  FittedParameter parameter =
      settings.is_physical
          ? FittedParameter{"lidar/receiver/range_at_10_percent_m", "Range at 10 %", "m", {}, ""}
          : FittedParameter{"lidar/plausibility/reference_range_m",
                            "Reference range at threshold 0.1",
                            "m",
                            {},
                            ""};
  if (settled.groups.source == ScaleSource::kNothing) {
    parameter.remark =
        "not identified: reflectance and threshold enter detection only as a ratio; give "
        "--range-at-10-percent-m or --known";
    return parameter;
  }
  if (settled.groups.source == ScaleSource::kDataSheet) {
    parameter.remark = Bound("given:", *settings.range_at_10_percent_m, " m");
    return parameter;
  }
  const GroupOutlook& outlook = settled.outlook.groups[0];
  parameter.estimate = NotEnough(outlook.num);
  const double bound_m =
      std::exp(0.5 * BoundTheta(outlook, settings)) * std::sqrt(kDataSheetReflectance);
  switch (outlook.state) {
    case GroupState::kFew:
      parameter.remark = "not identified: too few trials on surfaces of known reflectance";
      return parameter;
    case GroupState::kNeverLost:
      parameter.remark =
          Bound("not identified: no beam is lost to the threshold; at least", bound_m, " m");
      return parameter;
    case GroupState::kNeverReturned:
      parameter.remark = Bound("not identified: nothing comes back; at most", bound_m, " m");
      return parameter;
    case GroupState::kSeen:
      break;
  }
  const double error = std::hypot(settled.log_inverse_power_error, ScaleError(settled, result));
  if (!(error < kMaxLogError)) {
    parameter.remark = WhyVague(settings);
    return parameter;
  }
  parameter.estimate = Exponential(settled.log_inverse_power, error, 0.5, outlook.num);
  parameter.estimate = Scaled(parameter.estimate, std::sqrt(kDataSheetReflectance));
  if (!settings.is_physical) {
    parameter.remark = "only threshold / range^2 is identified: the threshold is set to 0.1";
  }
  return parameter;
}

FittedParameter SnrParameter(const SettledThreshold& settled) {
  FittedParameter parameter{"lidar/receiver/snr_at_threshold", "SNR at threshold", "", NotEnough(0),
                            "not identified: no beams are lost to the threshold"};
  if (!settled.is_seen) return parameter;
  std::uint64_t num = 0;
  for (const GroupOutlook& outlook : settled.outlook.groups) {
    if (outlook.state == GroupState::kSeen) num += outlook.num;
  }
  const Eigen::Index place = settled.detection.snr_place();
  const double error = std::sqrt(settled.detection.covariance(place, place));
  parameter.estimate = NotEnough(num);
  parameter.remark = "not identified: too few beams near the threshold";
  if (!(error < kMaxLogSnrError)) return parameter;
  parameter.estimate = Exponential(settled.detection.log_snr, error, 1.0, num);
  parameter.remark.clear();
  return parameter;
}

FittedParameter AirParameter(const SettledThreshold& settled, const FitSettings& settings) {
  // On physical rungs it is that of fog, rain and snow together, which have keys of their own.
  FittedParameter parameter =
      settings.is_physical
          ? FittedParameter{"", "Extinction of the air", "1/m", {}, ""}
          : FittedParameter{"weather/fog_density_per_m", "Fog density", "1/m", {}, ""};
  if (settings.extinction_per_m) {
    parameter.remark = Bound("given:", *settings.extinction_per_m, " /m");
    return parameter;
  }
  if (!settled.is_seen) {
    parameter.remark = "not identified: no beams are lost to the threshold";
    return parameter;
  }
  std::uint64_t num = 0;
  for (const GroupOutlook& outlook : settled.outlook.groups) {
    if (outlook.state == GroupState::kSeen) num += outlook.num;
  }
  const Eigen::Index place = settled.detection.extinction_place();
  const double half = NormalQuantile() * std::sqrt(settled.detection.covariance(place, place));
  const double value = settled.detection.extinction_per_m;
  parameter.estimate = NotEnough(num);
  // 0.03 / m is a visibility of 100 m: who knows no better than that knows nothing.
  constexpr double kMaxHalf_per_m = 0.03;
  if (!(half < kMaxHalf_per_m)) {
    parameter.remark = WhyVague(settings);
    return parameter;
  }
  parameter.estimate = {value, std::max(0.0, value - half), value + half, num};
  if (parameter.estimate.low == 0.0) parameter.remark = "not told apart from clear air";
  return parameter;
}

void AddLossParameters(const SettledThreshold& settled,
                       const FitSettings& settings,
                       FitResult& result) {
  FittedParameter dropout{"lidar/plausibility/dropout_probability", "Dropout probability", "",
                          settled.loss.probability, ""};
  const char* const few = "not identified: too few beams far above the threshold";
  if (!dropout.estimate.is_enough()) dropout.remark = few;
  result.parameters.push_back(dropout);
  if (settings.is_physical) return;
  FittedParameter rate{"", "Rain dropout rate, k x rain rate^e", "1/m", settled.loss.rate_per_m,
                       ""};
  if (!rate.estimate.is_enough()) rate.remark = few;
  const bool is_open = rate.estimate.low == 0.0 && dropout.estimate.low == 0.0 &&
                       rate.estimate.value + dropout.estimate.value > 0.0;
  if (is_open) {
    result.parameters.back().remark = rate.remark =
        "dropout and rain are not told apart: only their sum is more than 0";
  }
  result.parameters.push_back(rate);
  FittedParameter per_rain{"weather/rain_dropout_per_m", "Rain dropout rate k at 1 mm/h", "1/m",
                           NotEnough(rate.estimate.num), rate.remark};
  if (!settings.rain_rate_mmph) {
    per_rain.remark =
        "not identified: only its product with the rain rate is; give --rain-rate-mmph";
  } else if (rate.estimate.is_enough()) {
    const WeatherSpec defaults;
    const double growth = std::pow(*settings.rain_rate_mmph, defaults.rain_dropout_exponent);
    per_rain.estimate = Scaled(rate.estimate, 1.0 / growth);
    per_rain.remark = "with the usual exponent e = 0.63";
  }
  result.parameters.push_back(per_rain);
}

void SayThatLossesAreNotKnown(FitResult& result) {
  const char* const why =
      "not identified: the recording has points only, what is lost leaves no trace";
  for (FittedParameter& parameter : result.parameters) {
    if (!parameter.remark.starts_with("given")) parameter.remark = why;
  }
  for (SurfaceFit& surface : result.surfaces) {
    if (!surface.reflectance.is_enough()) surface.remark = why;
  }
}

}  // namespace

void FitThreshold(const std::vector<Trial>& trials,
                  const std::vector<FitSurface>& surfaces,
                  const FitSettings& settings,
                  FitResult& result) {
  const SettledThreshold settled = SettleThreshold(
      settings.knows_losses ? trials : std::vector<Trial>{}, surfaces, settings, result);
  result.parameters.push_back(ThresholdParameter(settled, settings, result));
  if (settings.is_physical) {
    const FittedParameter snr = SnrParameter(settled);
    result.snr_at_threshold = snr.estimate.value;
    result.log_snr_error = LogSnrError(settled);
    result.parameters.push_back(snr);
  }
  result.parameters.push_back(AirParameter(settled, settings));
  result.extinction_per_m = settings.extinction_per_m.value_or(
      settled.is_seen ? settled.detection.extinction_per_m : 0.0);
  AddLossParameters(settled, settings, result);
  FillSurfaces(settled, surfaces, settings, result);
  if (!settings.knows_losses) SayThatLossesAreNotKnown(result);
}

}  // namespace railcast
