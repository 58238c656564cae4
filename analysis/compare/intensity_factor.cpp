#include "analysis/compare/compare_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "analysis/estimate/estimate.h"
#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

// In bins. Less is a difference of brightness rather than of scale.
constexpr double kLeastShift = 2.0;
constexpr double kMostLeft = 1.0;

// The place in bins, with its fraction, below which a share of the counts is.
double QuantileOf(const Histogram& histogram, double share) {
  const double wanted = share * static_cast<double>(histogram.num());
  double below = 0.0;
  for (const auto& [bin, num] : histogram.counts()) {
    const auto count = static_cast<double>(num);
    if (below + count >= wanted) return static_cast<double>(bin) + (wanted - below) / count;
    below += count;
  }
  return std::nan("");
}

}  // namespace

std::optional<IntensityFactor> IntensityFactorOf(const Histogram& a, const Histogram& b) {
  if (a.num() < kMinSamples || b.num() < kMinSamples) return std::nullopt;
  std::array<double, 9> shifts{};
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const double share = 0.1 * static_cast<double>(i + 1);
    shifts[i] = QuantileOf(b, share) - QuantileOf(a, share);
  }
  std::ranges::sort(shifts);
  const double median = shifts[shifts.size() / 2];
  const double left = std::max(median - shifts.front(), shifts.back() - median);
  if (std::abs(median) < kLeastShift || left > kMostLeft) return std::nullopt;
  return IntensityFactor{std::exp2(median / kIntensityBinsAnOctave),
                         std::exp2(left / kIntensityBinsAnOctave)};
}

std::string InWords(const IntensityFactor& factor) {
  constexpr double kPercentOfOne = 100.0;
  const auto digits = [](double value, int num) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*g", num, value);
    return std::string(text.data());
  };
  return Joined({"The intensities of B are those of A times ", digits(factor.b_over_a, 3),
                 ": scaled by that, their deciles differ by ",
                 digits(kPercentOfOne * (factor.largest_left - 1.0), 2),
                 " % at most, and the other differences of intensity here ",
                 "are mostly those of the scale."});
}

}  // namespace railcast
