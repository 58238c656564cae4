#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "analysis/fit/detection.h"

namespace railcast {
namespace {

/// Where a trial comes to be detected as theta grows, and by how much log likelihood grows then.
struct Step {
  double needed{};
  double gain{};
};

/// Log evidence, mean and variance of one theta under a flat prior.
struct Posterior {
  double log_evidence{};
  double mean{};
  double variance{};
};

// Log likelihood is constant between the places where trials come to be detected.
Posterior Integrate(std::vector<Step>& steps) {
  std::sort(steps.begin(), steps.end(),
            [](const Step& a, const Step& b) { return a.needed < b.needed; });
  std::vector<double> height(steps.size());  // After step i.
  double log_likelihood = 0.0;
  double highest = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    height[i] = log_likelihood += steps[i].gain;
    highest = std::max(highest, log_likelihood);
  }
  double mass = 0.0, first = 0.0, second = 0.0;
  const double origin = steps.front().needed;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const double low = steps[i].needed - origin;
    const double high = steps[i + 1].needed - origin;
    const double weight = std::exp(height[i] - highest);
    mass += weight * (high - low);
    first += weight * 0.5 * (high * high - low * low);
    second += weight * (high * high * high - low * low * low) / 3.0;
  }
  if (!(mass > 0.0)) return {};
  const double mean = first / mass;
  return {highest + std::log(mass), origin + mean, std::max(0.0, second / mass - mean * mean)};
}

class HardThreshold {
 public:
  HardThreshold(const DetectionProblem& problem, const Outlook& outlook)
      : problem_(problem), outlook_(outlook), groups_(problem.num_groups) {
    for (const DetectionTrial& trial : problem.trials) {
      if (outlook.groups[trial.group].state != GroupState::kSeen) continue;
      const double survival = std::clamp(problem.loss.Survival(trial.range_m), 0.0, 1.0);
      const double chance = trial.is_returned ? survival : 1.0 - survival;
      const double above = std::max(chance, kWrongShare);
      const double below = trial.is_returned ? kWrongShare : 1.0 - kWrongShare;
      groups_[trial.group].push_back({trial, std::log(above / below)});
    }
  }

  /// By group; empty for those not in kSeen.
  [[nodiscard]] std::vector<Posterior> At(double extinction_per_m) const {
    std::vector<Posterior> posteriors(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::vector<Step> steps;
      steps.reserve(groups_[g].size());
      for (const auto& [trial, gain] : groups_[g]) {
        const double air = problem_.air_ways * extinction_per_m * trial.range_m;
        const double missing = std::exp(air) - trial.lobe;
        if (missing > 0.0) steps.push_back({std::log(missing / trial.gain), gain});
      }
      if (steps.size() > 1) posteriors[g] = Integrate(steps);
    }
    return posteriors;
  }

 private:
  const DetectionProblem& problem_;
  const Outlook& outlook_;
  std::vector<std::vector<std::pair<DetectionTrial, double>>> groups_;
};

/// The posteriors at some extinctions, each with its share of the mass.
struct Mixture {
  std::vector<double> extinction_per_m;
  std::vector<double> weight;
  std::vector<std::vector<Posterior>> posteriors;
};

Mixture Evaluate(const HardThreshold& model, const std::vector<double>& extinction_per_m) {
  Mixture mixture{extinction_per_m, {}, {}};
  mixture.posteriors.resize(extinction_per_m.size());
  tbb::parallel_for(std::size_t{0}, extinction_per_m.size(),
                    [&](std::size_t i) { mixture.posteriors[i] = model.At(extinction_per_m[i]); });
  double highest = -std::numeric_limits<double>::infinity();
  for (const auto& posteriors : mixture.posteriors) {
    double log_evidence = 0.0;
    for (const Posterior& posterior : posteriors) log_evidence += posterior.log_evidence;
    mixture.weight.push_back(log_evidence);
    highest = std::max(highest, log_evidence);
  }
  for (double& weight : mixture.weight) weight = std::exp(weight - highest);
  return mixture;
}

// Extinctions about those that carry the mass, ever closer, until it stands on many of them.
Mixture Search(const HardThreshold& model) {
  constexpr std::size_t kNumPoints = 49;
  constexpr double kDensestFog_per_m = 0.3;
  constexpr double kNothing = 1e-4;
  double low = 0.0;
  double high = kDensestFog_per_m;
  Mixture mixture;
  for (int round = 0; round < 8; ++round) {
    std::vector<double> grid(kNumPoints);
    for (std::size_t i = 0; i < kNumPoints; ++i) {
      // Middles of cells, so that each stands for as much.
      grid[i] = low + (high - low) * (static_cast<double>(i) + 0.5) / kNumPoints;
    }
    mixture = Evaluate(model, grid);
    std::size_t first = kNumPoints, last = 0;
    for (std::size_t i = 0; i < kNumPoints; ++i) {
      if (mixture.weight[i] < kNothing) continue;
      first = std::min(first, i);
      last = i;
    }
    if (last - first > kNumPoints / 2) break;
    const double cell = (high - low) / kNumPoints;
    high = low + cell * static_cast<double>(last + 3);
    low = std::max(0.0, low + cell * (static_cast<double>(first) - 2.0));
  }
  return mixture;
}

}  // namespace

DetectionFit FitHardThreshold(const DetectionProblem& problem, const Outlook& outlook) {
  const HardThreshold model(problem, outlook);
  const Mixture mixture =
      problem.extinction_per_m ? Evaluate(model, {*problem.extinction_per_m}) : Search(model);
  const auto num_groups = static_cast<Eigen::Index>(problem.num_groups);
  DetectionFit fit;
  fit.theta = Eigen::VectorXd::Constant(num_groups, std::numeric_limits<double>::quiet_NaN());
  fit.covariance = Eigen::MatrixXd::Zero(num_groups + 2, num_groups + 2);
  // Law of total covariance. The extinction is the parameter after the thetas.
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(num_groups + 2);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(num_groups + 2, num_groups + 2);
  double mass = 0.0;
  for (std::size_t i = 0; i < mixture.weight.size(); ++i) {
    Eigen::VectorXd at = Eigen::VectorXd::Zero(num_groups + 2);
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(num_groups + 2);
    for (Eigen::Index g = 0; g < num_groups; ++g) {
      at[g] = mixture.posteriors[i][static_cast<std::size_t>(g)].mean;
      variance[g] = mixture.posteriors[i][static_cast<std::size_t>(g)].variance;
    }
    at[num_groups] = mixture.extinction_per_m[i];
    const double weight = mixture.weight[i];
    mass += weight;
    // West's update keeps the digits.
    const Eigen::VectorXd before = at - mean;
    mean += weight / mass * before;
    square += weight * (before * (at - mean).transpose());
    square.diagonal() += weight * variance;
  }
  fit.covariance = square / mass;
  fit.covariance = (0.5 * (fit.covariance + fit.covariance.transpose())).eval();
  for (Eigen::Index g = 0; g < num_groups; ++g) {
    const auto state = outlook.groups[static_cast<std::size_t>(g)].state;
    if (state == GroupState::kSeen) fit.theta[g] = mean[g];
  }
  fit.extinction_per_m = mean[num_groups];
  return fit;
}

}  // namespace railcast
