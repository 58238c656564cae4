#include "core/program/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

// Bin 0 holds durations below 100 ns, the last bin those above about 4 hours; bins between grow by
// 1 %.
constexpr double kFirstEdge_ns = 100.0;
constexpr double kGrowth = 1.01;
constexpr std::size_t kNumBins = 2600;

}  // namespace

DurationHistogram::DurationHistogram() : bins_(kNumBins) {}

void DurationHistogram::Add(std::int64_t duration_ns) {
  const double ratio = static_cast<double>(duration_ns) / kFirstEdge_ns;
  const double bin = ratio < 1.0 ? 0.0 : 1.0 + std::floor(std::log(ratio) / std::log(kGrowth));
  ++bins_[std::min(static_cast<std::size_t>(bin), kNumBins - 1)];
  ++count_;
  max_ns_ = std::max(max_ns_, duration_ns);
  total_ns_ += std::max<std::int64_t>(0, duration_ns);
}

std::int64_t DurationHistogram::QuantileNs(double fraction) const {
  const double wanted = fraction * static_cast<double>(count_);
  std::uint64_t reached = 0;
  for (std::size_t bin = 0; bin < kNumBins; ++bin) {
    reached += bins_[bin];
    if (reached == 0 || static_cast<double>(reached) < wanted) continue;
    const double edge_ns = kFirstEdge_ns * std::pow(kGrowth, static_cast<double>(bin));
    return std::min(static_cast<std::int64_t>(edge_ns), max_ns_);
  }
  return max_ns_;
}

}  // namespace railcast
