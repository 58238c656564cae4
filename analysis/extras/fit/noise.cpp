#include "analysis/extras/fit/fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "analysis/estimate/streams.h"

namespace railcast {
namespace {

// Moments of a standard normal x, given |x| < 3.
constexpr double kTrim = 3.0;
constexpr double kMeanAbsolute = 0.79120;  // sqrt(2 / pi) (1 - exp(-9/2)) / (2 Phi(3) - 1)
constexpr double kMeanSquare = 0.97334;    // 1 - 6 phi(3) / (2 Phi(3) - 1)
// Ratio by which the mean residual depends less on the scale than its untrimmed derivative says,
// since a greater scale also admits more samples. The errors grow by this factor.
constexpr double kAbsoluteErrors = 1.0805;
constexpr double kSquareErrors = 1.1235;

/// A least-squares problem for the scale of the residuals.
struct ScaleProblem {
  Eigen::MatrixXd design;  ///< One row per trial, all entries >= 0; the first column is 1.
  Eigen::VectorXd residual_m;
  std::vector<std::uint32_t> piece;
  bool is_square{};  ///< Whether design x coefficients is sigma^2 rather than sigma.
};

struct ScaleFit {
  Eigen::VectorXd coefficients;
  Eigen::VectorXd errors;  ///< Standard errors.
  double degrees{};
};

ScaleProblem MakeProblem(const std::vector<NoiseTrial>& trials, Eigen::Index num_columns) {
  const auto rows = static_cast<Eigen::Index>(trials.size());
  ScaleProblem problem{Eigen::MatrixXd::Ones(rows, num_columns), Eigen::VectorXd(rows), {}, false};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const NoiseTrial& trial = trials[static_cast<std::size_t>(i)];
    problem.residual_m[i] = static_cast<double>(trial.residual_m);
    problem.piece.push_back(trial.piece);
  }
  return problem;
}

// Weights for least squares with relative errors; 0 beyond 3 sigma.
Eigen::VectorXd Weights(const ScaleProblem& problem, const Eigen::VectorXd& expected) {
  Eigen::VectorXd weights(expected.size());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const double sigma_m = problem.is_square ? std::sqrt(expected[i]) : expected[i];
    const bool is_near = std::abs(problem.residual_m[i]) <= kTrim * sigma_m;
    weights[i] = is_near ? 1.0 / (expected[i] * expected[i]) : 0.0;
  }
  return weights;
}

// Weighted least squares with coefficients >= 0: those that would be negative are dropped.
Eigen::VectorXd SolveNonNegative(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < right.size(); ++i) kept.push_back(i);
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(right.size());
  while (!kept.empty()) {
    const Eigen::VectorXd part = normal(kept, kept).ldlt().solve(right(kept).eval());
    Eigen::Index least = 0;
    if (part.minCoeff(&least) >= 0.0) {
      solution(kept) = part;
      break;
    }
    kept.erase(kept.begin() + least);
  }
  return solution;
}

Eigen::VectorXd StandardErrors(const ScaleProblem& problem,
                               const Eigen::VectorXd& weights,
                               const Eigen::VectorXd& surprise) {
  std::map<std::uint32_t, Eigen::VectorXd> scores;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    Eigen::VectorXd& score = scores
                                 .try_emplace(problem.piece[static_cast<std::size_t>(i)],
                                              Eigen::VectorXd::Zero(problem.design.cols()))
                                 .first->second;
    score += weights[i] * surprise[i] * problem.design.row(i).transpose();
  }
  const Eigen::MatrixXd normal = problem.design.transpose() * weights.asDiagonal() * problem.design;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(normal.rows(), normal.cols());
  for (const auto& [piece, score] : scores) meat += score * score.transpose();
  const Eigen::MatrixXd inverse =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  return (inverse * meat * inverse).diagonal().cwiseSqrt();
}

ScaleFit FitScale(ScaleProblem problem) {
  constexpr int kRounds = 30;
  // Scale the columns to a mean of 1, so that metres and radians do not spoil the condition of the
  // normal matrix.
  const Eigen::RowVectorXd unit = problem.design.colwise().mean().cwiseMax(1e-30);
  problem.design.array().rowwise() /= unit.array();
  std::vector<double> residuals_m(problem.residual_m.begin(), problem.residual_m.end());
  const double start_m = std::max(1e-6, PlainRobustScale(residuals_m));
  const Eigen::VectorXd absolute = problem.residual_m.cwiseAbs() / kMeanAbsolute;
  const Eigen::VectorXd square = problem.residual_m.cwiseAbs2() / kMeanSquare;
  const Eigen::VectorXd& measured = problem.is_square ? square : absolute;
  const double least = problem.is_square ? 1e-12 : 1e-6;
  ScaleFit fit;
  fit.coefficients = Eigen::VectorXd::Zero(problem.design.cols());
  fit.coefficients[0] = problem.is_square ? start_m * start_m : start_m;
  Eigen::VectorXd expected, weights;
  for (int round = 0; round < kRounds; ++round) {
    expected = (problem.design * fit.coefficients).cwiseMax(least);
    weights = Weights(problem, expected);
    const Eigen::MatrixXd weighted = problem.design.transpose() * weights.asDiagonal();
    fit.coefficients = SolveNonNegative(weighted * problem.design, weighted * measured);
  }
  const double wider = problem.is_square ? kSquareErrors : kAbsoluteErrors;
  fit.errors = wider * StandardErrors(problem, weights, measured - expected);
  fit.coefficients = fit.coefficients.cwiseQuotient(unit.transpose());
  fit.errors = fit.errors.cwiseQuotient(unit.transpose());
  const std::set<std::uint32_t> pieces(problem.piece.begin(), problem.piece.end());
  fit.degrees = static_cast<double>(pieces.size()) - static_cast<double>(problem.design.cols());
  return fit;
}

bool HasEnoughPieces(const std::vector<NoiseTrial>& trials) {
  std::set<std::uint32_t> pieces;
  for (const NoiseTrial& trial : trials) pieces.insert(trial.piece);
  return pieces.size() >= kMinSamples;
}

Estimate NoiseInterval(const ScaleFit& fit, Eigen::Index place, std::uint64_t num) {
  const double half = StudentQuantile(fit.degrees) * fit.errors[place];
  const double value = fit.coefficients[place];
  return {value, std::max(0.0, value - half), value + half, num};
}

// Changes from turn to turn are differences of two ranges, divided by sqrt(2), those along a ring
// of three, divided by sqrt(6).
double ResidualStep_m(double step_m, NoiseFrom from) {
  if (from == NoiseFrom::kPieces) return step_m;
  return step_m / std::sqrt(from == NoiseFrom::kTurns ? 2.0 : 6.0);
}

// Converts an estimate of a square to its root.
Estimate Root(const Estimate& square) {
  return {std::sqrt(square.value), std::sqrt(square.low), std::sqrt(square.high), square.num};
}

}  // namespace

ChannelBiases TakeOutChannels(RecordedTrials& trials) {
  constexpr std::size_t kMinOfChannel = 50;
  std::map<std::uint16_t, std::vector<double>> channels;
  for (const NoiseTrial& trial : trials.noise) {
    channels[trial.channel].push_back(static_cast<double>(trial.residual_m));
  }
  ChannelBiases result;
  std::map<std::uint16_t, double> medians_m;
  Moments between;
  double own_variance_m2 = 0.0;
  for (auto& [channel, residuals] : channels) {
    if (residuals.size() < kMinOfChannel) continue;
    const ChannelBias bias{channel, Median(residuals)};
    result.channels.push_back(bias);
    medians_m[channel] = bias.bias_m.value;
    between.Add(bias.bias_m.value);
    const double own_m = PlainRobustScale(residuals);
    // The variance of the median of normal samples is pi / 2
    // times that of the mean.
    own_variance_m2 += 1.5708 * own_m * own_m / static_cast<double>(residuals.size());
  }
  for (NoiseTrial& trial : trials.noise) {
    const auto median = medians_m.find(trial.channel);
    if (median != medians_m.end()) trial.residual_m -= static_cast<float>(median->second);
  }
  result.sigma_m = between.StandardDeviation();
  if (!result.sigma_m.is_enough()) return result;
  own_variance_m2 /= static_cast<double>(between.num());
  const auto less_m = [&](double sigma_m) {
    return std::sqrt(std::max(0.0, sigma_m * sigma_m - own_variance_m2));
  };
  const Estimate raw_m = result.sigma_m;
  result.sigma_m = {less_m(raw_m.value), less_m(raw_m.low), less_m(raw_m.high), raw_m.num};
  return result;
}

Estimate NoiseOf(std::vector<double> residuals_m, double step_m, NoiseFrom from) {
  if (!(step_m > 0.0)) return RobustScale(residuals_m);
  RoundedSamples samples(ResidualStep_m(step_m, from));
  for (const double residual_m : residuals_m) samples.Add(residual_m);
  return RobustScale(samples,
                     from == NoiseFrom::kPieces ? RoundedValues::kOne : RoundedValues::kBoth);
}

void TakeOutSteps(const RecordedTrials& trials,
                  double sigma_m,
                  NoiseFrom from,
                  bool is_physical,
                  std::vector<NoiseTrial>& noise) {
  constexpr double kGolden = 0.6180339887498949;
  const double step_m = ResidualStep_m(trials.step_m, from);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double turn = kGolden * static_cast<double>(i);
    noise[i].residual_m += static_cast<float>(step_m * (turn - std::floor(turn) - 0.5));
  }
  // What is left of the steps is not normal: the scale is that of the estimator that follows.
  ScaleProblem whole = MakeProblem(noise, 1);
  whole.is_square = is_physical;
  const double found = FitScale(std::move(whole)).coefficients[0];
  const double scale = sigma_m / (is_physical ? std::sqrt(found) : found);
  for (NoiseTrial& trial : noise) trial.residual_m *= static_cast<float>(scale);
}

NoiseFrom TakeLeastNoise(RecordedTrials& trials) {
  constexpr std::size_t kLeast = 500;
  // Taking whichever of two like measures chance made smaller would understate the noise.
  constexpr double kMuchLess = 0.8;
  const auto take = [&](float NoiseTrial::*sample_m, NoiseFrom from, const auto& is_less) {
    std::vector<double> samples_m, residuals_m;
    for (const NoiseTrial& trial : trials.noise) {
      if (!std::isfinite(trial.*sample_m)) continue;
      samples_m.push_back(static_cast<double>(trial.*sample_m));
      residuals_m.push_back(static_cast<double>(trial.residual_m));
    }
    if (samples_m.size() < kLeast) return false;
    const Estimate noise_m = NoiseOf(std::move(samples_m), trials.step_m, from);
    const Estimate about_m = NoiseOf(std::move(residuals_m), trials.step_m, NoiseFrom::kPieces);
    if (!is_less(noise_m, about_m)) return false;
    std::erase_if(trials.noise,
                  [&](const NoiseTrial& trial) { return std::isnan(trial.*sample_m); });
    for (NoiseTrial& trial : trials.noise) trial.residual_m = trial.*sample_m;
    return true;
  };
  if (take(&NoiseTrial::change_m, NoiseFrom::kTurns,
           [](const Estimate& a, const Estimate& b) { return a.value < b.value; })) {
    return NoiseFrom::kTurns;
  }
  if (take(&NoiseTrial::bend_m, NoiseFrom::kNeighbours,
           [](const Estimate& a, const Estimate& b) { return a.high < kMuchLess * b.value; })) {
    return NoiseFrom::kNeighbours;
  }
  return NoiseFrom::kPieces;
}

double SignalNoise::At(const NoiseTrial& trial, double inverse_snr) const {
  const double grown_m2 = scale_m.is_enough() ? scale_m.value * scale_m.value * inverse_snr : 0.0;
  const double pointing_m = pointing_rad.value * static_cast<double>(trial.slant_m_per_rad);
  return std::sqrt(floor_m.value * floor_m.value + grown_m2 + pointing_m * pointing_m);
}

LinearNoise FitLinearNoise(const std::vector<NoiseTrial>& trials) {
  const std::uint64_t num = trials.size();
  if (!HasEnoughPieces(trials)) return {NotEnough(num), NotEnough(num)};
  ScaleProblem problem = MakeProblem(trials, 2);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    problem.design(static_cast<Eigen::Index>(i), 1) = static_cast<double>(trials[i].range_m);
  }
  const ScaleFit fit = FitScale(std::move(problem));
  return {NoiseInterval(fit, 0, num), NoiseInterval(fit, 1, num)};
}

SignalNoise FitSignalNoise(const std::vector<NoiseTrial>& trials,
                           const std::vector<double>& inverse_snr) {
  const std::uint64_t num = trials.size();
  SignalNoise noise{NotEnough(num), NotEnough(num), NotEnough(num)};
  if (!HasEnoughPieces(trials)) return noise;
  ScaleProblem problem = MakeProblem(trials, inverse_snr.empty() ? 2 : 3);
  problem.is_square = true;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto slant = static_cast<double>(trials[i].slant_m_per_rad);
    problem.design(row, 1) = slant * slant;
    if (!inverse_snr.empty()) problem.design(row, 2) = inverse_snr[i];
  }
  const ScaleFit fit = FitScale(std::move(problem));
  noise.floor_m = Root(NoiseInterval(fit, 0, num));
  noise.pointing_rad = Root(NoiseInterval(fit, 1, num));
  if (!inverse_snr.empty()) noise.scale_m = Root(NoiseInterval(fit, 2, num));
  return noise;
}

}  // namespace railcast
