#include "analysis/estimate/log_histogram.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/robust.h"

namespace railcast {
namespace {

constexpr double kLowest = 1e-7;
const double kLogStep = std::log(1.01);
const auto kNumBins = static_cast<std::size_t>(std::ceil(std::log(1e12) / kLogStep));

}  // namespace

void LogHistogram::Add(double sample) {
  if (std::isnan(sample)) return;
  if (counts_.empty()) counts_.resize(kNumBins);
  double place = 0.0;
  if (sample > kLowest) place = std::log(sample / kLowest) / kLogStep;
  const auto last = static_cast<double>(kNumBins - 1);
  ++counts_[static_cast<std::size_t>(std::min(place, last))];
  ++num_;
}

void LogHistogram::Add(const LogHistogram& other) {
  if (other.counts_.empty()) return;
  if (counts_.empty()) counts_.resize(kNumBins);
  for (std::size_t i = 0; i < kNumBins; ++i) counts_[i] += other.counts_[i];
  num_ += other.num_;
}

double LogHistogram::OfRank(std::uint64_t rank) const {
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kNumBins && below + counts_[bin] < rank) below += counts_[bin++];
  return kLowest * std::exp((static_cast<double>(bin) + 0.5) * kLogStep);
}

Estimate LogHistogram::Median() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const RankInterval ranks = MedianRanks(num_);
  return {OfRank((num_ + 1) / 2), OfRank(ranks.low), OfRank(ranks.high), num_};
}

double LogHistogram::Quantile(double share) const {
  if (num_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(share * static_cast<double>(num_));
  return OfRank(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(rank)));
}

}  // namespace railcast
