#include "analysis/fit/random_loss.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace railcast {
namespace {

double Quantile() {
  return boost::math::quantile(boost::math::normal(), 1.0 - 0.5 * (1.0 - kConfidence));
}

/// What the trials say of (a, rate) about some value of them: Fisher's information, and the step of
/// scoring from there.
struct Scores {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

Scores ScoresAt(const std::vector<StrongTrial>& trials, const Eigen::Vector2d& value) {
  Scores scores;
  for (const StrongTrial& trial : trials) {
    const Eigen::Vector2d x(1.0, trial.range_m);
    const double exponent = std::max(1e-9, value.dot(x));
    const double p = std::exp(-exponent);
    const double lost = -std::expm1(-exponent);
    // d P / d exponent = -P.
    scores.gradient -= (trial.is_returned ? 1.0 : -p / lost) * x;
    scores.information += p / lost * x * x.transpose();
  }
  return scores;
}

// Scoring in one of the two, the other 0: its value solves a monotonic equation.
Eigen::Vector2d ClimbAlone(const std::vector<StrongTrial>& trials, int which, double start) {
  constexpr int kMaxRounds = 60;
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  value[which] = start;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Scores scores = ScoresAt(trials, value);
    const double step = scores.gradient[which] / scores.information(which, which);
    // Never past half way to 0.
    value[which] = std::max(0.5 * value[which], value[which] + step);
    if (std::abs(step) < 1e-9 * value[which]) break;
  }
  return value;
}

// Both free. @pre The maximum is not at the edge.
Eigen::Vector2d ClimbBoth(const std::vector<StrongTrial>& trials, Eigen::Vector2d value) {
  constexpr int kMaxRounds = 200;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Scores scores = ScoresAt(trials, value);
    const Eigen::Vector2d step = scores.information.inverse() * scores.gradient;
    const Eigen::Vector2d next = (value + step).cwiseMax(0.5 * value);
    const bool is_done = (next - value).cwiseQuotient(value).norm() < 1e-9;
    value = next;
    if (is_done) break;
  }
  return value;
}

/// Estimates, and where a free fit would go from there: beyond the edge if they are on it.
struct Exponents {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Vector2d unbounded = Eigen::Vector2d::Zero();
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
};

Exponents FitExponents(const std::vector<StrongTrial>& trials, double num_lost, double way_m) {
  const auto num = static_cast<double>(trials.size());
  Exponents fit;
  const Eigen::Vector2d offset_alone =
      ClimbAlone(trials, 0, -std::log1p(-std::min(0.99, num_lost / num)));
  const Eigen::Vector2d rate_alone = ClimbAlone(trials, 1, num_lost / way_m);
  if (ScoresAt(trials, offset_alone).gradient[1] <= 0.0) {
    fit.value = offset_alone;
  } else if (ScoresAt(trials, rate_alone).gradient[0] <= 0.0) {
    fit.value = rate_alone;
  } else {
    fit.value = ClimbBoth(trials, 0.5 * (offset_alone + rate_alone));
  }
  const Scores scores = ScoresAt(trials, fit.value);
  const Eigen::Matrix2d covariance = scores.information.inverse();
  fit.unbounded = fit.value + covariance * scores.gradient;
  fit.error = covariance.diagonal().cwiseSqrt();
  return fit;
}

double ShareOf(double exponent) {
  return -std::expm1(-exponent);
}

}  // namespace

RandomLoss RandomLossFit::loss() const {
  return {probability.is_enough() ? probability.value : 0.0,
          rate_per_m.is_enough() ? rate_per_m.value : 0.0};
}

RandomLossFit FitRandomLoss(const std::vector<StrongTrial>& trials, bool has_rate) {
  const std::uint64_t num = trials.size();
  RandomLossFit fit{NotEnough(num), NotEnough(has_rate ? num : 0)};
  if (num < kMinSamples) return fit;
  std::uint64_t num_lost = 0;
  double way_m = 0.0;
  for (const StrongTrial& trial : trials) {
    num_lost += trial.is_returned ? 0 : 1;
    way_m += trial.range_m;
  }
  if (num_lost < kMinSamples || num_lost == num) {
    fit.probability = Proportion(num_lost, num);
    if (has_rate) {
      fit.rate_per_m = PoissonRate(num_lost, way_m);
      fit.rate_per_m.num = num;
      // Either may have taken them all, or none.
      fit.probability.low = fit.rate_per_m.low = 0.0;
      if (num_lost == 0) fit.rate_per_m.value = 0.0;
    }
    return fit;
  }
  if (!has_rate) {
    fit.probability = Proportion(num_lost, num);
    return fit;
  }
  const Exponents best = FitExponents(trials, static_cast<double>(num_lost), way_m);
  const double z = Quantile();
  const auto interval = [&](int i) {
    return Estimate{best.value[i], std::max(0.0, best.value[i] - z * best.error[i]),
                    std::max(0.0, best.unbounded[i] + z * best.error[i]), num};
  };
  const Estimate offset = interval(0);
  fit.probability = {ShareOf(offset.value), ShareOf(offset.low), ShareOf(offset.high), num};
  fit.rate_per_m = interval(1);
  return fit;
}

}  // namespace railcast
