#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/detection.h"

namespace railcast {
namespace {

/// A trial on the axis of theta: detected if theta is at least `needed`.
struct Step {
  double needed{};
  bool is_returned{};
};

double LogLikelihood(double returned, double lost) {
  const auto term = [](double count, double all) {
    return count > 0.0 ? count * std::log(count / all) : 0.0;
  };
  return term(returned, returned + lost) + term(lost, returned + lost);
}

// Twice this is the likelihood ratio that a threshold must bring: 16, since its place was searched
// for.
constexpr double kEvidence = 8.0;
// Half the quantile of chi-squared at 90 %: one-sided 95 %.
constexpr double kBoundEvidence = 1.353;

struct Split {
  double gain{};  ///< Of log likelihood over no split.
  std::size_t num_above{};
};

// Of the trials below a hard threshold nothing returns; just below a smooth one a share does.
double LogLikelihoodBelow(double returned, double lost, double rate_above, bool is_smooth) {
  if (!is_smooth) return returned * std::log(kWrongShare) + lost * std::log1p(-kWrongShare);
  constexpr double kMostThatStillReturn = 0.5;
  const double num = returned + lost;
  if (num == 0.0 || returned > kMostThatStillReturn * rate_above * num) {
    return -std::numeric_limits<double>::infinity();
  }
  return LogLikelihood(returned, lost);
}

// The best place for a step in `steps`, strongest first.
Split BestSplit(const std::vector<Step>& steps, bool is_smooth) {
  double all_returned = 0.0;
  for (const Step& step : steps) all_returned += step.is_returned ? 1.0 : 0.0;
  const auto num = static_cast<double>(steps.size());
  const double plain = LogLikelihood(all_returned, num - all_returned);
  Split best;
  double returned = 0.0;
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    const auto above = static_cast<double>(i);
    const double rate_above = above > 0.0 ? returned / above : 1.0;
    const double log_likelihood =
        LogLikelihood(returned, above - returned) +
        LogLikelihoodBelow(all_returned - returned, num - above - (all_returned - returned),
                           rate_above, is_smooth);
    if (log_likelihood - plain > best.gain) best = {log_likelihood - plain, i};
    if (i < steps.size()) returned += steps[i].is_returned ? 1.0 : 0.0;
  }
  return best;
}

// The least theta that the data allow if nothing is lost to the threshold: of the weakest trials a
// few may be lost to it after all.
double LeastTheta(const std::vector<Step>& steps, double share_lost) {
  double evidence = 0.0;
  for (std::size_t i = steps.size(); i-- > 0;) {
    const double chance = std::max(kWrongShare, steps[i].is_returned ? 1.0 : share_lost);
    evidence += steps[i].is_returned ? -std::log(kWrongShare) : std::log(chance);
    // Lost: it could as well be below. Returned: it hardly can.
    if (evidence < 0.0) evidence = 0.0;
    if (evidence > kBoundEvidence) return steps[i].needed;
  }
  return steps.front().needed;
}

GroupOutlook LookAt(std::vector<Step> steps, bool is_smooth) {
  GroupOutlook outlook;
  outlook.num = steps.size();
  if (steps.size() < kMinSamples) return outlook;
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.needed < b.needed; });
  double returned = 0.0;
  for (const Step& step : steps) returned += step.is_returned ? 1.0 : 0.0;
  // Nothing but what is wrong comes back: the strongest trial was too weak.
  constexpr double kFew = 5.0 * kWrongShare;
  if (returned <= std::max(1.0, kFew * static_cast<double>(steps.size()))) {
    outlook.state = GroupState::kNeverReturned;
    outlook.bound = steps.front().needed;
    return outlook;
  }
  const Split split = BestSplit(steps, is_smooth);
  if (split.gain < kEvidence || split.num_above == steps.size()) {
    outlook.state = GroupState::kNeverLost;
    outlook.bound = LeastTheta(steps, 1.0 - returned / static_cast<double>(steps.size()));
    return outlook;
  }
  outlook.state = GroupState::kSeen;
  outlook.evidence = split.gain;
  outlook.start = steps[std::min(split.num_above, steps.size() - 1)].needed;
  return outlook;
}

Outlook LookAtExtinction(const DetectionProblem& problem, double extinction_per_m) {
  std::vector<std::vector<Step>> groups(problem.num_groups);
  for (const DetectionTrial& trial : problem.trials) {
    const double air = problem.air_ways * extinction_per_m * trial.range_m;
    const double missing = std::exp(air) - trial.lobe;
    // Its lobe alone is detected: it says nothing of theta.
    if (missing <= 0.0) continue;
    groups[trial.group].push_back({std::log(missing / trial.gain), trial.is_returned});
  }
  Outlook outlook;
  outlook.extinction_per_m = extinction_per_m;
  for (std::vector<Step>& group : groups) {
    outlook.groups.push_back(LookAt(std::move(group), problem.is_smooth));
  }
  return outlook;
}

double EvidenceOf(const Outlook& outlook) {
  double evidence = 0.0;
  for (const GroupOutlook& group : outlook.groups) evidence += group.evidence;
  return evidence;
}

}  // namespace

Outlook LookAtGroups(const DetectionProblem& problem) {
  if (problem.extinction_per_m) return LookAtExtinction(problem, *problem.extinction_per_m);
  // A smooth threshold's likelihood leads from clear air to where it should.
  if (problem.is_smooth) return LookAtExtinction(problem, 0.0);
  constexpr double kThinnest_per_m = 3e-4;
  constexpr double kDensest_per_m = 0.1;
  constexpr double kStep = 1.5;
  Outlook best = LookAtExtinction(problem, 0.0);
  for (double at_per_m = kThinnest_per_m; at_per_m < kDensest_per_m; at_per_m *= kStep) {
    Outlook outlook = LookAtExtinction(problem, at_per_m);
    // Where the trials cannot tell, clear air is the better guess.
    if (EvidenceOf(outlook) > EvidenceOf(best) + kEvidence) best = std::move(outlook);
  }
  return best;
}

}  // namespace railcast
