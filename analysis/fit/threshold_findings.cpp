#include "analysis/fit/threshold_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/estimate/intervals.h"

namespace railcast {
namespace {

// Carried by the float32 fields.
constexpr double kMinLogError = 1e-5;
constexpr std::uint32_t kNoGroup = ThresholdGroups::kNoGroup;

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

constexpr const char* kTogether =
    "not identified: beams are lost at about one range only, so that threshold and extinction "
    "cannot be told apart; give --extinction-per-m";

}  // namespace

Estimate Exponential(double x, double error, double power, std::uint64_t num) {
  const double half = NormalQuantile() * (error + kMinLogError);
  return {std::exp(power * x), std::exp(power * (x - half)), std::exp(power * (x + half)), num};
}

std::string Bound(const std::string& words, double bound, const std::string& unit) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", bound);
  std::string text = words;
  text += ' ';
  text += digits;
  text += unit;
  return text;
}

double BoundTheta(const GroupOutlook& outlook, const FitSettings& settings) {
  const double slack = settings.is_physical ? std::log(2.0 / 3.0) : 0.0;
  return outlook.bound + (outlook.state == GroupState::kNeverLost ? slack : -slack);
}

const char* WhyVague(const FitSettings& settings) {
  return settings.extinction_per_m ? "not identified: too few beams near the threshold" : kTogether;
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

}  // namespace railcast
