#include "analysis/fit/settle_threshold.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace railcast {
namespace {

ScaleSource ScaleSourceOf(const FitSettings& settings) {
  if (settings.has_reflectances) return ScaleSource::kIntensity;
  if (settings.range_at_10_percent_m) return ScaleSource::kDataSheet;
  return settings.known.empty() ? ScaleSource::kNothing : ScaleSource::kKnownSurface;
}

// Where nothing fixes the scale, lobes need one all the same: the default of the receiver.
constexpr double kUsualRange_m = 200.0;
// Far above the threshold: with an SNR of 5 there, 3e-7 of the beams are lost to it.
constexpr double kStrongPower = 2.0;
// What the truth leaves open of pulse stretch: 1 % of the power either way at most, of a few trials
// (analysis/fit/truth_stretch.h).
constexpr double kStretchLogError = 0.002;
constexpr std::uint32_t kNoGroup = ThresholdGroups::kNoGroup;

double LeastPowerInverse(double range_at_10_percent_m) {
  return range_at_10_percent_m * range_at_10_percent_m / kDataSheetReflectance;
}

ThresholdGroups MakeGroups(const FitSettings& settings, const FitResult& result) {
  ThresholdGroups groups;
  groups.source = ScaleSourceOf(settings);
  const bool has_scale_group =
      groups.source == ScaleSource::kIntensity || groups.source == ScaleSource::kKnownSurface;
  groups.num = has_scale_group ? 1 : 0;
  for (const SurfaceFit& surface : result.surfaces) {
    const auto known = settings.known.find(surface.name);
    std::uint32_t group = kNoGroup;
    double reflectance = std::numeric_limits<double>::quiet_NaN();
    if (groups.source == ScaleSource::kIntensity) {
      reflectance = surface.reflectance.value;
      if (reflectance > 0.0) group = 0;
    } else if (known != settings.known.end()) {
      reflectance = known->second;
      group = 0;
    } else {
      group = groups.num++;
    }
    groups.of_surface.push_back(group);
    groups.reflectance.push_back(reflectance);
  }
  return groups;
}

/// The trials as detection sees them; those that came back from elsewhere apart.
struct Cast {
  std::vector<DetectionTrial> trials;
  std::vector<DetectionTrial> elsewhere;
};

Cast CastTrials(const std::vector<Trial>& trials,
                const std::vector<FitSurface>& surfaces,
                const FitSettings& settings,
                const FitResult& result,
                const SettledThreshold& settled) {
  const ThresholdGroups& groups = settled.groups;
  std::vector<std::size_t> place_of(surfaces.size(), result.surfaces.size());
  for (std::size_t i = 0; i < result.surface_ids.size(); ++i) place_of[result.surface_ids[i]] = i;
  Cast cast;
  for (const Trial& trial : trials) {
    const std::size_t place = place_of[trial.surface];
    const std::uint32_t group = groups.of_surface[place];
    const double stretch = settings.is_physical ? static_cast<double>(trial.stretch) : 1.0;
    if (group == kNoGroup || std::isnan(stretch)) continue;
    const double range_m = static_cast<double>(trial.expected_m);
    const double spread = stretch / (range_m * range_m);
    const ShapedAnswer answer =
        settings.is_physical
            ? AnswerOf(surfaces[trial.surface], static_cast<double>(trial.cos_incidence))
            : ShapedAnswer{static_cast<double>(trial.cos_incidence), 0.0};
    DetectionTrial shown{answer.diffuse * spread,
                         std::exp(settled.log_inverse_power) * answer.lobe * spread, range_m, group,
                         trial.answer != Answer::kLost};
    const double reflectance = groups.reflectance[place];
    if (!std::isnan(reflectance)) {
      shown.gain = (reflectance * answer.diffuse + answer.lobe) * spread;
      shown.lobe = 0.0;
    }
    (trial.answer == Answer::kElsewhere ? cast.elsewhere : cast.trials).push_back(shown);
  }
  return cast;
}

// Those that the threshold has no part in.
std::vector<StrongTrial> StrongTrials(const Cast& cast,
                                      const Outlook& outlook,
                                      const DetectionFit* fit,
                                      const DetectionProblem& problem) {
  std::vector<StrongTrial> strong;
  const double extinction_per_m = fit ? fit->extinction_per_m : outlook.extinction_per_m;
  const auto add = [&](const DetectionTrial& trial) {
    const GroupOutlook& group = outlook.groups[trial.group];
    double theta = group.state == GroupState::kNeverLost ? group.bound : group.start;
    const bool is_seen = group.state == GroupState::kSeen;
    if (is_seen && fit) theta = fit->theta[static_cast<Eigen::Index>(trial.group)];
    const double power = (std::exp(theta) * trial.gain + trial.lobe) *
                         std::exp(-problem.air_ways * extinction_per_m * trial.range_m);
    // Of groups that are never lost the bound is that of the weakest.
    const bool is_strong =
        group.state == GroupState::kNeverLost ? power >= 1.0 - 1e-9 : power >= kStrongPower;
    if (is_strong) strong.push_back({trial.range_m, trial.is_returned});
  };
  for (const DetectionTrial& trial : cast.trials) add(trial);
  for (const DetectionTrial& trial : cast.elsewhere) add(trial);
  return strong;
}

}  // namespace

SettledThreshold SettleThreshold(const std::vector<Trial>& trials,
                                 const std::vector<FitSurface>& surfaces,
                                 const FitSettings& settings,
                                 const FitResult& result) {
  constexpr int kRounds = 4;
  constexpr double kTypicalRange_m = 50.0;
  constexpr double kSettled = 1e-6;
  SettledThreshold settled;
  settled.groups = MakeGroups(settings, result);
  settled.log_inverse_power =
      std::log(LeastPowerInverse(settings.range_at_10_percent_m.value_or(kUsualRange_m)));
  const bool has_scale_group = settled.groups.source == ScaleSource::kIntensity ||
                               settled.groups.source == ScaleSource::kKnownSurface;
  DetectionProblem problem;
  problem.num_groups = settled.groups.num;
  problem.is_smooth = settings.is_physical;
  problem.air_ways = settings.is_physical ? 2.0 : 1.0;
  problem.extinction_per_m = settings.extinction_per_m;
  for (int round = 0; round < kRounds; ++round) {
    const double lost_before = problem.loss.Survival(kTypicalRange_m);
    const double power_before = settled.log_inverse_power;
    Cast cast = CastTrials(trials, surfaces, settings, result, settled);
    problem.trials = std::move(cast.trials);
    settled.outlook = LookAtGroups(problem);
    cast.trials = problem.trials;
    const DetectionFit* before = round > 0 && settled.is_seen ? &settled.detection : nullptr;
    settled.loss =
        FitRandomLoss(StrongTrials(cast, settled.outlook, before, problem), !settings.is_physical);
    problem.loss = settled.loss.loss();
    settled.is_seen =
        std::any_of(settled.outlook.groups.begin(), settled.outlook.groups.end(),
                    [](const GroupOutlook& group) { return group.state == GroupState::kSeen; });
    if (!settled.is_seen) break;
    settled.detection = settings.is_physical ? FitSmoothThreshold(problem, settled.outlook)
                                             : FitHardThreshold(problem, settled.outlook);
    if (settings.is_physical) {
      settled.detection.covariance.diagonal().head(settled.detection.theta.size()).array() +=
          kStretchLogError * kStretchLogError;
    }
    if (has_scale_group && settled.outlook.groups[0].state == GroupState::kSeen) {
      settled.log_inverse_power = settled.detection.theta[0];
      settled.log_inverse_power_error = std::sqrt(settled.detection.covariance(0, 0));
    }
    const bool has_settled =
        round > 0 && std::abs(problem.loss.Survival(kTypicalRange_m) - lost_before) < kSettled &&
        std::abs(settled.log_inverse_power - power_before) < kSettled;
    if (has_settled) break;
  }
  if (settled.groups.source == ScaleSource::kDataSheet) settled.log_inverse_power_error = 0.0;
  return settled;
}

}  // namespace railcast
