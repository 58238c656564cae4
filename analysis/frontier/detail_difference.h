#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "core/fidelity/echoes_by_range.h"

namespace railcast {

/// Width of the range bins.
inline constexpr double kDetailBin_m = 50.0;
/// With fewer echoes in full detail an interval is wider than what it is for.
inline constexpr double kLeastDetailEchoes = 400.0;
/// With fewer frames the differences between them give no interval.
inline constexpr std::size_t kLeastDetailFrames = 10;

/// How the echoes of one label in one range bin differ from those of the same row in full detail:
/// relative changes, of which 0 is none. Intervals are of 95 %, from the differences between
/// frames; their numbers are those of the echoes in full detail.
struct DetailDifference {
  std::uint32_t label{};
  int bin{};           ///< In steps of kDetailBin_m.
  Estimate first;      ///< Of the number of the nearest echoes of their firings.
  Estimate further;    ///< Of the number of all others.
  Estimate intensity;  ///< Of the mean intensity of the first ones.
};

/// The differences wherever there are enough first echoes in full detail, by label and by range.
/// @pre Both hold the same frames, in bins of kDetailBin_m.
[[nodiscard]] std::vector<DetailDifference> DifferencesOfDetail(const EchoesByRange& full,
                                                                const EchoesByRange& coarser);

}  // namespace railcast
