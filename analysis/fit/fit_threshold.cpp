#include "analysis/fit/fit_threshold.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstdio>
#include <string>

#include "analysis/fit/settle_threshold.h"

namespace railcast {
namespace {

// Of what the likelihood leaves open by more than 20 % either way its interval is not to be
// trusted.
constexpr double kMaxLogError = 0.1;
// The SNR at the threshold is known by the slope of a curve only: a factor of two either way.
constexpr double kMaxLogSnrError = 0.35;
// Carried by the float32 fields.
constexpr double kMinLogError = 1e-5;
constexpr std::uint32_t kNoGroup = ThresholdGroups::kNoGroup;

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

double Quantile() {
  return boost::math::quantile(boost::math::normal(), 1.0 - 0.5 * (1.0 - kConfidence));
}

// e^(power x), for x of this standard error.
Estimate Exponential(double x, double error, double power, std::uint64_t num) {
  const double half = Quantile() * (error + kMinLogError);
  return {std::exp(power * x), std::exp(power * (x - half)), std::exp(power * (x + half)), num};
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

// "at least 143 m": in three digits.
std::string Bound(const std::string& words, double bound, const std::string& unit) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", bound);
  std::string text = words;
  text += ' ';
  text += digits;
  text += unit;
  return text;
}

// Of a smooth threshold with the usual SNR a beam at 2/3 of it still comes back once in twenty.
double BoundTheta(const GroupOutlook& outlook, const FitSettings& settings) {
  const double slack = settings.is_physical ? std::log(2.0 / 3.0) : 0.0;
  return outlook.bound + (outlook.state == GroupState::kNeverLost ? slack : -slack);
}

const char* const kTogether =
    "not identified: beams are lost at about one range only, so that threshold and extinction "
    "cannot be told apart; give --extinction-per-m";

const char* WhyVague(const FitSettings& settings) {
  return settings.extinction_per_m ? "not identified: too few beams near the threshold" : kTogether;
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
  const double half = Quantile() * std::sqrt(settled.detection.covariance(place, place));
  const double value = settled.detection.extinction_per_m;
  parameter.estimate = NotEnough(num);
  // 0.03 / m is a visibility of 100 m: who knows no better than that knows nothing.
  constexpr double kMaxHalf_per_m = 0.03;
  if (!(half < kMaxHalf_per_m)) {
    parameter.remark = kTogether;
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

// The ratio of a surface that has a theta of its own to the threshold, and its reflectance.
void FillOwnGroup(const SettledThreshold& settled,
                  const FitSettings& settings,
                  const ShapedAnswer& facing,
                  std::size_t group,
                  SurfaceFit& surface) {
  const GroupOutlook& outlook = settled.outlook.groups[group];
  const bool has_scale = !std::isnan(settled.log_inverse_power_error);
  const double inverse_power = std::exp(settled.log_inverse_power);
  surface.reflectance = surface.facing_range_m = NotEnough(outlook.num);
  if (outlook.state == GroupState::kFew) {
    surface.remark = "not identified: too few trials";
    return;
  }
  if (outlook.state != GroupState::kSeen) {
    const bool is_least = outlook.state == GroupState::kNeverLost;
    const double theta = BoundTheta(outlook, settings);
    surface.remark = is_least ? "not identified: none of its beams is lost to the threshold; "
                              : "not identified: none of its beams comes back; ";
    surface.remark +=
        has_scale ? Bound(is_least ? "at least" : "at most", std::exp(theta) / inverse_power, "")
                  : Bound(is_least ? "seen, facing, to at least" : "seen, facing, to at most",
                          std::sqrt(std::exp(theta) * facing.diffuse + inverse_power * facing.lobe),
                          " m");
    return;
  }
  const auto place = static_cast<Eigen::Index>(group);
  const Eigen::MatrixXd& covariance = settled.detection.covariance;
  const double theta = settled.detection.theta[place];
  const double error = std::sqrt(covariance(place, place));
  if (!(error < kMaxLogError)) {
    surface.remark = WhyVague(settings);
    return;
  }
  surface.power_at_1m = std::exp(theta);
  surface.lobe_scale = inverse_power;
  const double diffuse = std::exp(theta) * facing.diffuse;
  const double all = diffuse + inverse_power * facing.lobe;
  surface.facing_range_m = Exponential(std::log(all), error * diffuse / all, 0.5, outlook.num);
  if (!has_scale) {
    surface.remark = "not identified: only its ratio to the threshold, as the range it is seen to";
    return;
  }
  double variance = covariance(place, place);
  if (settled.groups.source == ScaleSource::kKnownSurface) {
    variance += covariance(0, 0) - 2.0 * covariance(0, place);
  }
  surface.reflectance = Exponential(theta - settled.log_inverse_power,
                                    std::sqrt(std::max(0.0, variance)), 1.0, outlook.num);
}

void FillSurfaces(const SettledThreshold& settled,
                  const std::vector<FitSurface>& surfaces,
                  const FitSettings& settings,
                  FitResult& result) {
  const bool has_scale = !std::isnan(settled.log_inverse_power_error);
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    SurfaceFit& surface = result.surfaces[i];
    const std::uint32_t group = settled.groups.of_surface[i];
    const ShapedAnswer facing = settings.is_physical
                                    ? AnswerOf(surfaces[result.surface_ids[i]], 1.0)
                                    : ShapedAnswer{1.0, 0.0};
    const double reflectance = settled.groups.reflectance[i];
    if (group == kNoGroup) {
      surface.remark = "not identified: too few intensities";
    } else if (std::isnan(reflectance)) {
      FillOwnGroup(settled, settings, facing, group, surface);
    } else {
      if (settled.groups.source == ScaleSource::kKnownSurface) {
        surface.reflectance = NotEnough(0);
        surface.remark = Bound("given:", reflectance, "");
      }
      if (!has_scale || !(settled.log_inverse_power_error < kMaxLogError)) continue;
      const double inverse_power = std::exp(settled.log_inverse_power);
      surface.power_at_1m = inverse_power * reflectance;
      surface.lobe_scale = inverse_power;
      const double all = inverse_power * (reflectance * facing.diffuse + facing.lobe);
      surface.facing_range_m = Exponential(std::log(all), settled.log_inverse_power_error, 0.5,
                                           settled.outlook.groups[0].num);
    }
  }
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
