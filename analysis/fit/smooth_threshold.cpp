#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/fit/detection.h"

namespace railcast {
namespace {

double NormalDensity(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}
double NormalShare(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// Log likelihood, its gradient and Fisher's information in (theta by group, extinction, log snr).
struct Scores {
  double log_likelihood{};
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

class SmoothThreshold {
 public:
  SmoothThreshold(const DetectionProblem& problem, const Outlook& outlook)
      : problem_(problem), outlook_(outlook) {}

  [[nodiscard]] Scores At(const Eigen::VectorXd& parameters) const {
    const auto num_groups = static_cast<Eigen::Index>(problem_.num_groups);
    const double extinction_per_m = parameters[num_groups];
    const double snr = std::exp(parameters[num_groups + 1]);
    Scores scores{0.0, Eigen::VectorXd::Zero(num_groups + 2),
                  Eigen::MatrixXd::Zero(num_groups + 2, num_groups + 2)};
    for (const DetectionTrial& trial : problem_.trials) {
      if (outlook_.groups[trial.group].state != GroupState::kSeen) continue;
      const auto g = static_cast<Eigen::Index>(trial.group);
      const double air = std::exp(-problem_.air_ways * extinction_per_m * trial.range_m);
      const double diffuse = std::exp(parameters[g]) * trial.gain * air;
      const double power = diffuse + trial.lobe * air;
      const double excess = snr * (power - 1.0);
      const double scale = problem_.loss.Survival(trial.range_m) * (1.0 - 2.0 * kWrongShare);
      const double p = kWrongShare + scale * NormalShare(excess);
      scores.log_likelihood += std::log(trial.is_returned ? p : 1.0 - p);
      const double density = scale * NormalDensity(excess);
      if (density < 1e-12) continue;
      const double by_power = density * snr;
      const Eigen::Index places[3] = {g, num_groups, num_groups + 1};
      const double slopes[3] = {by_power * diffuse,
                                -by_power * problem_.air_ways * trial.range_m * power,
                                density * excess};
      const double surprise = ((trial.is_returned ? 1.0 : 0.0) - p) / (p * (1.0 - p));
      for (int i = 0; i < 3; ++i) {
        scores.gradient[places[i]] += surprise * slopes[i];
        for (int j = 0; j < 3; ++j) {
          scores.information(places[i], places[j]) += slopes[i] * slopes[j] / (p * (1.0 - p));
        }
      }
    }
    return scores;
  }

  /// Variance of one group's theta under a flat prior, all else as it is. Where trials are scarce
  /// about the threshold the likelihood is a plateau, of which the information says nothing.
  [[nodiscard]] double VarianceOf(Eigen::Index group, const Eigen::VectorXd& parameters) const {
    constexpr int kNumPoints = 61;
    constexpr double kReach = 3.0;
    constexpr double kNegligible = -10.0;
    double low = parameters[group] - kReach;
    double high = parameters[group] + kReach;
    double mean = 0.0, variance = 0.0;
    // First the whole reach, then what has any likelihood.
    for (int round = 0; round < 3; ++round) {
      const double step = (high - low) / (kNumPoints - 1);
      std::vector<double> heights(kNumPoints);
      for (int i = 0; i < kNumPoints; ++i) {
        heights[static_cast<std::size_t>(i)] = LogLikelihood(group, low + i * step, parameters);
      }
      const double highest = *std::max_element(heights.begin(), heights.end());
      double mass = 0.0, first = 0.0, second = 0.0;
      int from = kNumPoints, to = 0;
      for (int i = 0; i < kNumPoints; ++i) {
        const double height = heights[static_cast<std::size_t>(i)] - highest;
        if (height < kNegligible) continue;
        from = std::min(from, i);
        to = i;
        mass += std::exp(height);
        first += std::exp(height) * i;
        second += std::exp(height) * i * i;
      }
      mean = first / mass;
      variance = (second / mass - mean * mean) * step * step;
      high = low + std::min(kNumPoints - 1, to + 1) * step;
      low += std::max(0, from - 1) * step;
    }
    return variance;
  }

  /// Which parameters are free.
  [[nodiscard]] std::vector<Eigen::Index> Free(bool is_extinction_free) const {
    std::vector<Eigen::Index> free;
    for (std::size_t g = 0; g < outlook_.groups.size(); ++g) {
      if (outlook_.groups[g].state == GroupState::kSeen)
        free.push_back(static_cast<Eigen::Index>(g));
    }
    const auto num_groups = static_cast<Eigen::Index>(problem_.num_groups);
    if (is_extinction_free) free.push_back(num_groups);
    free.push_back(num_groups + 1);
    return free;
  }

 private:
  [[nodiscard]] double LogLikelihood(Eigen::Index group,
                                     double theta,
                                     const Eigen::VectorXd& parameters) const {
    const double extinction_per_m = parameters[parameters.size() - 2];
    const double snr = std::exp(parameters[parameters.size() - 1]);
    double sum = 0.0;
    for (const DetectionTrial& trial : problem_.trials) {
      if (static_cast<Eigen::Index>(trial.group) != group) continue;
      const double air = std::exp(-problem_.air_ways * extinction_per_m * trial.range_m);
      const double power = (std::exp(theta) * trial.gain + trial.lobe) * air;
      const double p = Chance(trial, snr * (power - 1.0));
      sum += std::log(trial.is_returned ? p : 1.0 - p);
    }
    return sum;
  }
  [[nodiscard]] double Chance(const DetectionTrial& trial, double excess) const {
    return kWrongShare +
           problem_.loss.Survival(trial.range_m) * (1.0 - 2.0 * kWrongShare) * NormalShare(excess);
  }

  const DetectionProblem& problem_;
  const Outlook& outlook_;
};

// Climbs to the maximum.
void Climb(const SmoothThreshold& model,
           const std::vector<Eigen::Index>& free,
           Eigen::VectorXd& parameters) {
  constexpr int kMaxRounds = 60;
  constexpr double kMostAirAtATime_per_m = 0.02;
  const Eigen::Index problem_extinction = parameters.size() - 2;
  Scores scores = model.At(parameters);
  double damping = 1e-3;
  for (int round = 0; round < kMaxRounds; ++round) {
    Eigen::MatrixXd information = scores.information(free, free);
    const Eigen::VectorXd diagonal = information.diagonal();
    information.diagonal() += damping * diagonal + Eigen::VectorXd::Constant(diagonal.size(), 1e-9);
    const Eigen::VectorXd step = information.ldlt().solve(scores.gradient(free).eval());
    Eigen::VectorXd tried = parameters;
    for (std::size_t i = 0; i < free.size(); ++i) {
      // A little at a time, so that no exponential runs away.
      const double most = free[i] == problem_extinction ? kMostAirAtATime_per_m : 1.0;
      tried[free[i]] += std::clamp(step[static_cast<Eigen::Index>(i)], -most, most);
    }
    Scores there = model.At(tried);
    const double gained = there.log_likelihood - scores.log_likelihood;
    if (!(gained >= 0.0)) {
      damping *= 10.0;
      if (damping > 1e9) break;
      continue;
    }
    parameters = tried;
    scores = std::move(there);
    damping = std::max(1e-9, 0.1 * damping);
    if (gained < 1e-9) break;
  }
}

Eigen::MatrixXd InverseInformation(const SmoothThreshold& model,
                                   const std::vector<Eigen::Index>& free,
                                   const Eigen::VectorXd& parameters) {
  const Eigen::MatrixXd information = model.At(parameters).information(free, free);
  const Eigen::Index size = information.rows();
  return (information + 1e-12 * Eigen::MatrixXd::Identity(size, size))
      .ldlt()
      .solve(Eigen::MatrixXd::Identity(size, size));
}

}  // namespace

DetectionFit FitSmoothThreshold(const DetectionProblem& problem, const Outlook& outlook) {
  const SmoothThreshold model(problem, outlook);
  const auto num_groups = static_cast<Eigen::Index>(problem.num_groups);
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(num_groups + 2);
  for (Eigen::Index g = 0; g < num_groups; ++g) {
    const GroupOutlook& group = outlook.groups[static_cast<std::size_t>(g)];
    if (group.state == GroupState::kSeen) parameters[g] = group.start;
  }
  parameters[num_groups] = outlook.extinction_per_m;
  constexpr double kUsualSnr = 5.0;
  parameters[num_groups + 1] = std::log(kUsualSnr);

  DetectionFit fit;
  fit.covariance = Eigen::MatrixXd::Zero(num_groups + 2, num_groups + 2);
  const std::vector<Eigen::Index> free = model.Free(!problem.extinction_per_m);
  Climb(model, free, parameters);
  if (!problem.extinction_per_m && parameters[num_groups] < 0.0) {
    // Air does not amplify.
    parameters[num_groups] = 0.0;
    Climb(model, model.Free(false), parameters);
  }
  // The extinction counts as free at its edge, too: the errors of the others are the wider for it.
  fit.covariance(free, free) = InverseInformation(model, free, parameters);
  const Eigen::VectorXd information = model.At(parameters).information.diagonal();
  for (const Eigen::Index g : free) {
    if (g >= num_groups) continue;
    const double wider = model.VarianceOf(g, parameters) - 1.0 / information[g];
    fit.covariance(g, g) += std::max(0.0, wider);
  }
  fit.theta = Eigen::VectorXd::Constant(num_groups, std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index g = 0; g < num_groups; ++g) {
    if (outlook.groups[static_cast<std::size_t>(g)].state == GroupState::kSeen) {
      fit.theta[g] = parameters[g];
    }
  }
  fit.extinction_per_m = parameters[num_groups];
  fit.log_snr = parameters[num_groups + 1];
  return fit;
}

}  // namespace railcast
