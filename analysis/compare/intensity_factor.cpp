#include "analysis/compare/intensity_factor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/estimate/estimate.h"
#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

constexpr double kMostLeft_bit = 0.1;
constexpr double kMostShareLeft = 0.5;
// Less than two bins is no scale, but a difference of brightness.
constexpr std::int64_t kLeastShift = 2;

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

// The median of the deciles' distances, in bins.
double ShiftOf(const Histogram& a, const Histogram& b) {
  std::array<double, 9> shifts{};
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const double share = 0.1 * static_cast<double>(i + 1);
    shifts[i] = QuantileOf(b, share) - QuantileOf(a, share);
  }
  std::ranges::sort(shifts);
  return shifts[shifts.size() / 2];
}

}  // namespace

std::optional<IntensityFactor> IntensityFactorOf(const Histogram& a, const Histogram& b) {
  if (a.num() < kMinSamples || b.num() < kMinSamples) return std::nullopt;
  const double shift = ShiftOf(a, b);
  const std::int64_t bins = std::llround(shift);
  if (std::abs(bins) < kLeastShift) return std::nullopt;
  // The brighter one is made darker, so that both end in the bin of what is darkest.
  const Histogram scaled = bins > 0 ? Darkened(b, bins) : Darkened(a, -bins);
  const IntensityFactor factor = {std::exp2(shift / kIntensityBinsAnOctave),
                                  JensenShannonDivergence(a, b),
                                  JensenShannonDivergence(scaled, bins > 0 ? a : b)};
  const bool is_scale =
      factor.divergence_left_bit <= std::min(kMostLeft_bit, kMostShareLeft * factor.divergence_bit);
  return is_scale ? std::optional(factor) : std::nullopt;
}

std::string InWords(const IntensityFactor& factor) {
  const auto text = [](double value) { return TextOf(value).value; };
  return Joined({"The intensities of B are those of A times ", text(factor.b_over_a),
                 ": scaled by that, their divergence falls from ", text(factor.divergence_bit),
                 " to ", text(factor.divergence_left_bit),
                 " bit, so that their other differences here are mostly those of the scale."});
}

}  // namespace railcast
