#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/fit/detection.h"

namespace railcast {
namespace {

/// Where a trial comes to be detected as theta grows, and by how much log likelihood grows then.
struct Step {
  double needed{};
  double gain{};
  double range_m{};
};

// Range of the trials about where a threshold lies.
double RangeAt(const std::vector<Step>& steps, double theta) {
  constexpr std::ptrdiff_t kNeighbours = 10;
  const auto at = std::lower_bound(steps.begin(), steps.end(), theta,
                                   [](const Step& s, double t) { return s.needed < t; });
  const auto from = at - std::min(kNeighbours, at - steps.begin());
  const auto to = at + std::min(kNeighbours, steps.end() - at);
  double sum = 0.0;
  for (auto step = from; step != to; ++step) sum += step->range_m;
  return sum / static_cast<double>(to - from);
}

/// Log evidence, mean and variance of one theta. The prior is flat in the logarithm of the range at
/// which beams are lost, d theta = (2 + ways extinction R) d log R: flat in theta, thick air would
/// gain evidence merely because it spreads thetas.
struct Posterior {
  double log_evidence{};
  double mean{};
  double variance{};
};

// Log likelihood is constant between the places where trials come to be detected.
Posterior Integrate(std::vector<Step>& steps, double air_per_m) {
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
  const double thetas_per_log_range = 2.0 + air_per_m * RangeAt(steps, origin + mean);
  return {highest + std::log(mass / thetas_per_log_range), origin + mean,
          std::max(0.0, second / mass - mean * mean)};
}

/// A range of a parameter.
struct Window {
  double low{};
  double high{};
};

/// A trial with what it brings if it comes to be detected.
struct Weighted {
  DetectionTrial trial;
  double gain{};

  /// The theta from which on it is detected; infinite if its lobe alone is.
  [[nodiscard]] double Needed(double air_ways, double extinction_per_m) const {
    const double missing = std::exp(air_ways * extinction_per_m * trial.range_m) - trial.lobe;
    if (missing <= 0.0) return -std::numeric_limits<double>::infinity();
    return std::log(missing / trial.gain);
  }
};

class HardThreshold {
 public:
  HardThreshold(const DetectionProblem& problem, const Outlook& outlook)
      : air_ways_(problem.air_ways), groups_(problem.num_groups) {
    for (const DetectionTrial& trial : problem.trials) {
      if (outlook.groups[trial.group].state != GroupState::kSeen) continue;
      const double survival = std::clamp(problem.loss.Survival(trial.range_m), 0.0, 1.0);
      const double chance = trial.is_returned ? survival : 1.0 - survival;
      const double above = std::max(chance, kWrongShare);
      const double below = trial.is_returned ? kWrongShare : 1.0 - kWrongShare;
      groups_[trial.group].push_back({trial, std::log(above / below)});
    }
  }

  /// The same with every n-th trial, at most `max_num` a group: a first look.
  [[nodiscard]] HardThreshold Thinned(std::size_t max_num) const {
    HardThreshold fewer = *this;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::size_t stride = 1 + groups_[g].size() / max_num;
      fewer.groups_[g].clear();
      for (std::size_t i = 0; i < groups_[g].size(); i += stride) {
        fewer.groups_[g].push_back(groups_[g][i]);
      }
    }
    return fewer;
  }

  /// The same without the trials on which extinctions and thetas within the windows agree.
  [[nodiscard]] HardThreshold Within(const Window& extinction_per_m,
                                     const std::vector<Window>& thetas) const {
    HardThreshold fewer = *this;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::erase_if(fewer.groups_[g], [&](const Weighted& weighted) {
        return weighted.Needed(air_ways_, extinction_per_m.high) < thetas[g].low ||
               weighted.Needed(air_ways_, extinction_per_m.low) > thetas[g].high;
      });
    }
    return fewer;
  }

  /// By group; empty for those not in kSeen.
  [[nodiscard]] std::vector<Posterior> At(double extinction_per_m) const {
    std::vector<Posterior> posteriors(groups_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      std::vector<Step> steps;
      steps.reserve(groups_[g].size());
      for (const Weighted& weighted : groups_[g]) {
        const double needed = weighted.Needed(air_ways_, extinction_per_m);
        if (std::isfinite(needed)) steps.push_back({needed, weighted.gain, weighted.trial.range_m});
      }
      if (steps.size() > 1) posteriors[g] = Integrate(steps, air_ways_ * extinction_per_m);
    }
    return posteriors;
  }

  [[nodiscard]] std::size_t num_groups() const { return groups_.size(); }

 private:
  double air_ways_;
  std::vector<std::vector<Weighted>> groups_;
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
Mixture Search(const HardThreshold& model, Window window_per_m) {
  constexpr std::size_t kNumPoints = 49;
  constexpr double kNothing = 1e-4;
  Mixture mixture;
  for (int round = 0; round < 8; ++round) {
    const double cell = (window_per_m.high - window_per_m.low) / kNumPoints;
    std::vector<double> grid(kNumPoints);
    for (std::size_t i = 0; i < kNumPoints; ++i) {
      // Middles of cells, so that each stands for as much.
      grid[i] = window_per_m.low + cell * (static_cast<double>(i) + 0.5);
    }
    mixture = Evaluate(model, grid);
    std::size_t first = kNumPoints, last = 0;
    for (std::size_t i = 0; i < kNumPoints; ++i) {
      if (mixture.weight[i] < kNothing) continue;
      first = std::min(first, i);
      last = i;
    }
    if (last - first > kNumPoints / 2) break;
    window_per_m = {std::max(0.0, grid[first] - 2.5 * cell), grid[last] + 2.5 * cell};
  }
  return mixture;
}

// Where all that has any mass lies, and ten standard deviations beyond.
Window ThetaWindow(const Mixture& mixture, std::size_t group) {
  constexpr double kDeviations = 10.0;
  constexpr double kNothing = 1e-4;
  Window window{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < mixture.weight.size(); ++i) {
    if (mixture.weight[i] < kNothing) continue;
    const Posterior& posterior = mixture.posteriors[i][group];
    const double reach = kDeviations * std::sqrt(posterior.variance);
    window.low = std::min(window.low, posterior.mean - reach);
    window.high = std::max(window.high, posterior.mean + reach);
  }
  return window;
}

// A few trials first; then all those about where these put the threshold.
Mixture Find(const HardThreshold& model, const std::optional<double>& given_per_m) {
  constexpr std::size_t kFew = 5000;
  constexpr double kDensestFog_per_m = 0.3;
  const HardThreshold few = model.Thinned(kFew);
  const Mixture rough =
      given_per_m ? Evaluate(few, {*given_per_m}) : Search(few, {0.0, kDensestFog_per_m});
  const double spacing_per_m =
      given_per_m ? 0.0 : rough.extinction_per_m[1] - rough.extinction_per_m[0];
  const Window air_per_m{std::max(0.0, rough.extinction_per_m.front() - 0.5 * spacing_per_m),
                         rough.extinction_per_m.back() + 0.5 * spacing_per_m};
  std::vector<Window> thetas;
  for (std::size_t g = 0; g < model.num_groups(); ++g) thetas.push_back(ThetaWindow(rough, g));
  const HardThreshold close = model.Within(air_per_m, thetas);
  return given_per_m ? Evaluate(close, {*given_per_m}) : Search(close, air_per_m);
}

}  // namespace

DetectionFit FitHardThreshold(const DetectionProblem& problem, const Outlook& outlook) {
  const HardThreshold model(problem, outlook);
  const Mixture mixture = Find(model, problem.extinction_per_m);
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
