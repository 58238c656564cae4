#include "analysis/frontier/detail_difference.h"

namespace railcast {
namespace {

using Sums = EchoesByRange::Sums;

Estimate EstimateOf(const RelativeChange& change, double num_echoes) {
  return {change.change, change.change - change.margin, change.change + change.margin,
          static_cast<std::uint64_t>(num_echoes)};
}

Estimate ChangeOfNumber(const std::vector<Sums>& full,
                        const std::vector<Sums>& coarser,
                        double Sums::*of) {
  const double num = TotalOf(full, of);
  const bool is_enough = num >= kLeastDetailEchoes && full.size() >= kLeastDetailFrames;
  if (!is_enough || TotalOf(coarser, of) == 0.0) return NotEnough(static_cast<std::uint64_t>(num));
  return EstimateOf(ChangeOfSum(full, coarser, of), num);
}

Estimate ChangeOfMean(const std::vector<Sums>& full, const std::vector<Sums>& coarser) {
  const double num = TotalOf(full, &Sums::first);
  const bool is_enough = num >= kLeastDetailEchoes && full.size() >= kLeastDetailFrames;
  if (!is_enough || TotalOf(coarser, &Sums::first) == 0.0) {
    return NotEnough(static_cast<std::uint64_t>(num));
  }
  return EstimateOf(ChangeOfIntensity(full, coarser), num);
}

}  // namespace

std::vector<DetailDifference> DifferencesOfDetail(const EchoesByRange& full,
                                                  const EchoesByRange& coarser) {
  std::vector<DetailDifference> differences;
  for (const auto& [label, bin] : full.Places()) {
    const std::vector<Sums>& of_full = full.Of(label, bin);
    // A coarser scene that has no echo there at all: as many frames without any.
    std::vector<Sums> of_coarser = coarser.Of(label, bin);
    of_coarser.resize(of_full.size());
    if (TotalOf(of_full, &Sums::first) < kLeastDetailEchoes) continue;
    differences.push_back({label, bin, ChangeOfNumber(of_full, of_coarser, &Sums::first),
                           ChangeOfNumber(of_full, of_coarser, &Sums::further),
                           ChangeOfMean(of_full, of_coarser)});
  }
  return differences;
}

}  // namespace railcast
