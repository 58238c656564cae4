#include "analysis/estimate/streams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace railcast {
namespace {

constexpr double kLowest = 1e-7;
constexpr double kHighest = 1e9;
const double kLogStep = std::log(1.01);
const auto kNumBins = static_cast<std::size_t>(std::ceil(std::log(kHighest / kLowest) / kLogStep));

double MiddleOf(std::size_t bin) {
  return kLowest * std::exp((static_cast<double>(bin) + 0.5) * kLogStep);
}

void AddToBin(std::vector<std::uint32_t>& sums, const std::vector<std::uint32_t>& others) {
  if (others.empty()) return;
  sums.resize(kNumBins);
  for (std::size_t i = 0; i < kNumBins; ++i) sums[i] += others[i];
}

}  // namespace

void Moments::Add(double sample) {
  if (std::isnan(sample)) return;
  ++num_;
  const double distance = sample - mean_;
  mean_ += distance / static_cast<double>(num_);
  squares_ += distance * (sample - mean_);
}

void Moments::Add(const Moments& other) {
  if (other.num_ == 0) return;
  const auto ours = static_cast<double>(num_);
  const auto theirs = static_cast<double>(other.num_);
  const double distance = other.mean_ - mean_;
  num_ += other.num_;
  mean_ += distance * theirs / (ours + theirs);
  squares_ += other.squares_ + distance * distance * ours * theirs / (ours + theirs);
}

double Moments::PlainMean() const {
  return num_ == 0 ? std::numeric_limits<double>::quiet_NaN() : mean_;
}

Estimate Moments::Mean() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const auto n = static_cast<double>(num_);
  const double half = StudentQuantile(n - 1.0) * std::sqrt(squares_ / (n - 1.0) / n);
  return {mean_, mean_ - half, mean_ + half, num_};
}

Estimate Moments::StandardDeviation() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const double degrees = static_cast<double>(num_) - 1.0;
  return ScaleEstimate(std::sqrt(squares_ / degrees), degrees, num_);
}

void LogHistogram::Add(double sample) {
  if (std::isnan(sample)) return;
  ++num_;
  const double magnitude = std::abs(sample);
  if (magnitude < kLowest) {
    ++num_zeros_;
    return;
  }
  std::vector<std::uint32_t>& counts = sample > 0.0 ? positive_ : negative_;
  counts.resize(kNumBins);
  const double place = std::log(magnitude / kLowest) / kLogStep;
  ++counts[static_cast<std::size_t>(std::min(place, static_cast<double>(kNumBins - 1)))];
}

void LogHistogram::Add(const LogHistogram& other) {
  num_ += other.num_;
  num_zeros_ += other.num_zeros_;
  AddToBin(positive_, other.positive_);
  AddToBin(negative_, other.negative_);
}

double LogHistogram::OfRank(std::uint64_t rank) const {
  std::uint64_t up_to = 0;
  for (std::size_t i = negative_.size(); i-- > 0;) {
    up_to += negative_[i];
    if (up_to >= rank) return -MiddleOf(i);
  }
  up_to += num_zeros_;
  if (up_to >= rank) return 0.0;
  for (std::size_t i = 0; i < positive_.size(); ++i) {
    up_to += positive_[i];
    if (up_to >= rank) return MiddleOf(i);
  }
  return MiddleOf(kNumBins - 1);
}

Estimate LogHistogram::Quantile(double share) const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const RankInterval ranks = QuantileRanks(num_, share);
  const double rank = std::ceil(share * static_cast<double>(num_));
  return {OfRank(static_cast<std::uint64_t>(rank)), OfRank(ranks.low), OfRank(ranks.high), num_};
}

Estimate LogHistogram::RobustScale() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const double median = OfRank((num_ + 1) / 2);
  std::vector<std::pair<double, std::uint64_t>> distances = {{std::abs(median), num_zeros_}};
  for (std::size_t i = 0; i < positive_.size(); ++i) {
    if (positive_[i] > 0) distances.emplace_back(std::abs(MiddleOf(i) - median), positive_[i]);
  }
  for (std::size_t i = 0; i < negative_.size(); ++i) {
    if (negative_[i] > 0) distances.emplace_back(std::abs(-MiddleOf(i) - median), negative_[i]);
  }
  std::sort(distances.begin(), distances.end());
  // Half of the samples of a bin count as nearer than its middle, which also holds where steps too
  // fine to be seen put samples into few bins.
  const double half = 0.5 * static_cast<double>(num_);
  std::pair<double, double> before{};  // A distance and the number of samples that are nearer.
  double nearer = 0.0;
  for (auto bin = distances.begin();;) {
    const double distance = bin->first;
    double count = 0.0;
    for (; bin != distances.end() && bin->first == distance; ++bin) {
      count += static_cast<double>(bin->second);
    }
    const double up_to = nearer + 0.5 * count;
    if (up_to >= half || bin == distances.end()) {
      const double share =
          up_to > before.second ? (half - before.second) / (up_to - before.second) : 1.0;
      return RobustScaleEstimate(
          kMadToSigma * std::lerp(before.first, distance, std::clamp(share, 0.0, 1.0)), num_);
    }
    before = {distance, up_to};
    nearer += count;
  }
}

Estimate LogHistogram::RobustScale(double step, RoundedValues rounded) const {
  const Estimate plain = RobustScale();
  constexpr double kFinest = 0.01;  // Steps that are finer than the bins change nothing.
  if (!plain.is_enough() || !(step > kFinest * plain.value)) return plain;
  RoundedSamples samples(step);
  samples.Add(0.0, static_cast<double>(num_zeros_));
  for (const double sign : {-1.0, 1.0}) {
    const std::vector<std::uint32_t>& counts = sign > 0.0 ? positive_ : negative_;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] > 0) samples.Add(sign * MiddleOf(i), counts[i]);
    }
  }
  return railcast::RobustScale(samples, rounded);
}

}  // namespace railcast
