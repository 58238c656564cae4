#include "analysis/fit/noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "analysis/estimate/intervals.h"
#include "analysis/estimate/moments.h"
#include "analysis/estimate/robust.h"

namespace railcast {
namespace {

// Relative standard error of TrimmedScale x sqrt(number of samples): with psi(x) = x^2 - c within
// 3, E[psi^2] = -E[x psi'] = 1.728 on normal samples, so 1 / sqrt(1.728).
constexpr double kTrimmedError = 0.7607;
constexpr std::size_t kMaxBins = 40;
constexpr std::size_t kMinBins = 4;

// The standard deviation of the samples within 3 of it about their median, over what that is of
// normal samples; found from the robust scale. What lies farther has no part in it at all.
Estimate TrimmedScale(std::vector<double>& samples) {
  constexpr double kTrim = 3.0;
  constexpr double kShareOfSigma = 0.98658;  // sqrt(1 - 2 k phi(k) / (2 Phi(k) - 1)), k = 3
  constexpr int kRounds = 30;
  const Estimate start = RobustScale(samples);
  if (!start.is_enough()) return start;
  const double median = Median(samples).value;
  double sigma = start.value;
  for (int round = 0; round < kRounds; ++round) {
    double squares = 0.0, num = 0.0;
    for (const double sample : samples) {
      const double distance = sample - median;
      if (std::abs(distance) > kTrim * sigma) continue;
      squares += distance * distance;
      num += 1.0;
    }
    sigma = std::sqrt(squares / num) / kShareOfSigma;
  }
  const double half = kTrimmedError / std::sqrt(static_cast<double>(samples.size()));
  return {sigma, sigma / (1.0 + 1.96 * half), sigma / std::max(0.1, 1.0 - 1.96 * half), start.num};
}

/// A linear law through bins: y = design x coefficients, errors of y known as a first guess.
struct Line {
  Eigen::VectorXd coefficients;
  Eigen::VectorXd errors;  ///< Standard errors.
  double degrees{};
};

// Weighted least squares with Huber's weights. @pre More rows than columns.
Line FitLine(const Eigen::MatrixXd& design,
             const Eigen::VectorXd& y,
             const Eigen::VectorXd& error) {
  constexpr double kHuber = 1.345;
  constexpr int kRounds = 20;
  const Eigen::VectorXd precision = error.array().square().inverse();
  Eigen::VectorXd weight = precision;
  Line line;
  line.degrees = static_cast<double>(design.rows() - design.cols());
  Eigen::MatrixXd normal;
  Eigen::VectorXd pull;
  for (int round = 0; round < kRounds; ++round) {
    normal = design.transpose() * weight.asDiagonal() * design;
    line.coefficients = normal.ldlt().solve(design.transpose() * weight.asDiagonal() * y);
    pull = (y - design * line.coefficients).cwiseQuotient(error).cwiseAbs();
    std::vector<double> pulls(pull.begin(), pull.end());
    std::nth_element(pulls.begin(), pulls.begin() + static_cast<std::ptrdiff_t>(pulls.size() / 2),
                     pulls.end());
    // Errors as stated, or more where the bins scatter more.
    const double scale = std::max(1.0, kMadToSigma * pulls[pulls.size() / 2]);
    for (Eigen::Index i = 0; i < weight.size(); ++i) {
      weight[i] = precision[i] * std::min(1.0, kHuber * scale / std::max(1e-12, pull[i]));
    }
  }
  double scatter = 0.0;
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    scatter += weight[i] / precision[i] * pull[i] * pull[i];
  }
  const Eigen::MatrixXd inverse =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  line.errors = (inverse.diagonal() * std::max(1.0, scatter / line.degrees)).cwiseSqrt();
  return line;
}

// The same with coefficients >= 0: what would be less is left out, its error kept.
Line FitNonNegative(const Eigen::MatrixXd& design,
                    const Eigen::VectorXd& y,
                    const Eigen::VectorXd& error) {
  const Line all = FitLine(design, y, error);
  Line best = all;
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(design.cols()));
  std::iota(kept.begin(), kept.end(), 0);
  while (true) {
    std::vector<Eigen::Index> positive;
    for (const Eigen::Index i : kept) {
      if (best.coefficients[i] > 0.0) positive.push_back(i);
    }
    if (positive.size() == kept.size() || positive.empty()) break;
    kept = positive;
    const Line fewer = FitLine(design(Eigen::all, kept), y, error);
    best.coefficients.setZero();
    best.coefficients(kept) = fewer.coefficients;
    best.degrees = fewer.degrees;
    // Errors stay those of the full fit: the wider.
  }
  best.coefficients = best.coefficients.cwiseMax(0.0);
  return best;
}

std::uint64_t NumOf(const std::vector<NoiseBin>& bins) {
  std::uint64_t num = 0;
  for (const NoiseBin& bin : bins) num += bin.sigma_m.num;
  return num;
}

double RelativeError(const NoiseBin& bin) {
  return kTrimmedError / std::sqrt(static_cast<double>(bin.sigma_m.num));
}

// Non-negative, with errors relative to the line: those of the bins would favour the low ones.
Line FitRelative(const Eigen::MatrixXd& design,
                 const Eigen::VectorXd& y,
                 const Eigen::VectorXd& relative_error) {
  constexpr int kRounds = 4;
  Eigen::VectorXd error = relative_error.cwiseProduct(y);
  Line line;
  for (int round = 0; round < kRounds; ++round) {
    line = FitNonNegative(design, y, error);
    error = relative_error.cwiseProduct((design * line.coefficients).cwiseMax(0.1 * y));
  }
  return line;
}

// The estimate whose square has this value and error.
Estimate Root(double square, double error, double quantile, std::uint64_t num) {
  return {std::sqrt(square), std::sqrt(std::max(0.0, square - quantile * error)),
          std::sqrt(square + quantile * error), num};
}

}  // namespace

Residuals TakeOutChannels(std::vector<Trial>& trials) {
  std::map<std::uint16_t, std::vector<double>> channels;
  std::vector<double> all;
  for (const Trial& trial : trials) {
    if (trial.answer != Answer::kReturned) continue;
    channels[trial.channel].push_back(static_cast<double>(trial.residual_m));
    all.push_back(static_cast<double>(trial.residual_m));
  }
  Residuals result;
  result.bias_m = Median(all);
  std::map<std::uint16_t, double> medians_m;
  Moments between;
  double own_variance_m2 = 0.0;
  for (auto& [channel, residuals] : channels) {
    if (residuals.size() < kMinOfChannel) continue;
    const ChannelBias bias{channel, Median(residuals)};
    medians_m[channel] = bias.bias_m.value;
    between.Add(bias.bias_m.value);
    const double own_m = RobustScale(residuals).value;
    // Variance of the median of normal samples: pi / 2 that of the mean.
    own_variance_m2 += 1.5708 * own_m * own_m / static_cast<double>(residuals.size());
    result.channels.push_back(bias);
  }
  for (Trial& trial : trials) {
    if (trial.answer != Answer::kReturned) continue;
    const auto median = medians_m.find(trial.channel);
    trial.residual_m -= median == medians_m.end() ? std::numeric_limits<float>::quiet_NaN()
                                                  : static_cast<float>(median->second);
  }
  result.bias_sigma_m = between.StandardDeviation();
  if (result.bias_sigma_m.is_enough()) {
    own_variance_m2 /= static_cast<double>(between.num());
    const auto less_m = [&](double sigma_m) {
      return std::sqrt(std::max(0.0, sigma_m * sigma_m - own_variance_m2));
    };
    const Estimate& raw_m = result.bias_sigma_m;
    result.bias_sigma_m = {less_m(raw_m.value), less_m(raw_m.low), less_m(raw_m.high), raw_m.num};
  }
  return result;
}

namespace {

// How many bins of slant to each of the key.
constexpr std::size_t kSlantBins = 5;

// Within each of `num_parts` of the order, so that bins differ in both.
void SortBySlant(const std::vector<Trial>& trials,
                 std::size_t num_parts,
                 std::vector<std::size_t>& order) {
  const bool has_slant = std::any_of(trials.begin(), trials.end(),
                                     [](const Trial& trial) { return trial.slant > 0.0F; });
  if (!has_slant) return;
  const auto place = [&](std::size_t part) {
    return order.begin() + static_cast<std::ptrdiff_t>(order.size() * part / num_parts);
  };
  for (std::size_t part = 0; part < num_parts; ++part) {
    std::stable_sort(place(part), place(part + 1), [&](std::size_t a, std::size_t b) {
      return trials[a].slant < trials[b].slant;
    });
  }
}

}  // namespace

std::vector<NoiseBin> BinNoise(const std::vector<Trial>& trials,
                               const std::vector<double>& keys,
                               const std::vector<double>& inverse_snr) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (trials[i].answer == Answer::kReturned && !std::isnan(trials[i].residual_m) &&
        !std::isnan(keys[i])) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  const std::size_t num_bins = std::min(kMaxBins, order.size() / kMinOfBin);
  if (num_bins > kSlantBins) SortBySlant(trials, num_bins / kSlantBins, order);
  std::vector<NoiseBin> bins;
  for (std::size_t b = 0; b < num_bins; ++b) {
    const std::size_t begin = order.size() * b / num_bins;
    const std::size_t end = order.size() * (b + 1) / num_bins;
    NoiseBin bin;
    std::vector<double> residuals;
    for (std::size_t k = begin; k < end; ++k) {
      const Trial& trial = trials[order[k]];
      bin.range_m += static_cast<double>(trial.expected_m);
      bin.inverse_snr += inverse_snr[order[k]];
      bin.slant2 += static_cast<double>(trial.slant) * static_cast<double>(trial.slant);
      residuals.push_back(static_cast<double>(trial.residual_m));
    }
    const auto num = static_cast<double>(end - begin);
    bin.range_m /= num;
    bin.inverse_snr /= num;
    bin.slant2 /= num;
    bin.sigma_m = TrimmedScale(residuals);
    if (bin.sigma_m.value > 0.0) bins.push_back(bin);
  }
  return bins;
}

LinearNoise FitLinearNoise(const std::vector<NoiseBin>& bins) {
  const std::uint64_t num = NumOf(bins);
  if (bins.size() < kMinBins) return {NotEnough(num), NotEnough(num)};
  const auto rows = static_cast<Eigen::Index>(bins.size());
  Eigen::MatrixXd design(rows, 2);
  Eigen::VectorXd y(rows), error(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const NoiseBin& bin = bins[static_cast<std::size_t>(i)];
    design.row(i) << 1.0, bin.range_m;
    y[i] = bin.sigma_m.value;
    error[i] = RelativeError(bin);
  }
  const Line line = FitRelative(design, y, error);
  const double quantile = StudentQuantile(line.degrees);
  const auto estimate = [&](Eigen::Index i) {
    const double half = quantile * line.errors[i];
    return Estimate{line.coefficients[i], std::max(0.0, line.coefficients[i] - half),
                    line.coefficients[i] + half, num};
  };
  return {estimate(0), estimate(1)};
}

SignalNoise FitSignalNoise(const std::vector<NoiseBin>& bins) {
  const std::uint64_t num = NumOf(bins);
  SignalNoise fit{NotEnough(num), NotEnough(num), NotEnough(num)};
  if (bins.size() < kMinBins) return fit;
  const bool has_slant =
      std::any_of(bins.begin(), bins.end(), [](const NoiseBin& bin) { return bin.slant2 > 0.0; });
  const auto rows = static_cast<Eigen::Index>(bins.size());
  Eigen::MatrixXd design(rows, has_slant ? 3 : 2);
  Eigen::VectorXd y(rows), error(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const NoiseBin& bin = bins[static_cast<std::size_t>(i)];
    design(i, 0) = 1.0;
    design(i, 1) = bin.inverse_snr;
    if (has_slant) design(i, 2) = bin.slant2;
    y[i] = bin.sigma_m.value * bin.sigma_m.value;
    error[i] = 2.0 * RelativeError(bin);
  }
  const Line line = FitRelative(design, y, error);
  const double quantile = StudentQuantile(line.degrees);
  const auto estimate = [&](Eigen::Index i) {
    return Root(line.coefficients[i], line.errors[i], quantile, num);
  };
  fit.floor_m = estimate(0);
  fit.scale_m = estimate(1);
  if (has_slant) fit.pointing_rad = estimate(2);
  return fit;
}

}  // namespace railcast
