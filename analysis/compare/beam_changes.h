#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/estimate/log_histogram.h"
#include "core/frame/frame.h"

namespace railcast {

/// What an effect does to beams, one by one: sums over frames that were made without it and with
/// it, of the same scan with the same draws.
struct BeamChanges {
  static constexpr std::size_t kNumOutcomes = kOutcomeNames.size();
  struct RangeBin {
    std::uint64_t num_beams{};
    std::uint64_t num_changed{};  ///< Not identical.
    std::uint64_t num_outcome_changed{};
  };

  BeamChanges();
  /// @pre Both frames are of the same pattern with as many returns.
  void Add(const Frame& without, const Frame& with);

  std::uint64_t num_beams{};
  /// In every bit of position, range, outcome and, where both have one, intensity.
  std::uint64_t num_identical{};
  std::uint64_t num_outcome_changed{};

  // Returns: points of any slot.
  std::uint64_t num_removed{};  ///< Points without the effect, none with it.
  std::uint64_t num_added{};    ///< None without it, points with it.
  std::uint64_t num_both{};
  std::uint64_t num_moved{};              ///< Of both: not at the same place.
  LogHistogram moved_m;                   ///< How far, of those that moved.
  std::uint64_t num_intensity_changed{};  ///< Of both.
  LogHistogram intensity_change;          ///< Absolute, of those that changed.

  /// Beams by their outcome without the effect, then with it.
  std::array<std::array<std::uint64_t, kNumOutcomes>, kNumOutcomes> transitions{};
  /// By bin of RangeBins(): where the beam meets a surface.
  std::vector<RangeBin> range_bins;
};

}  // namespace railcast
